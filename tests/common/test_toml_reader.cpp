#include <cmath>

#include "common/config/toml_reader.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using irdm::Error;
using irdm::TomlTable;

namespace {
TomlTable parse(const std::string& text) {
  return TomlTable::parse_text(text, "test.toml");
}
}  // namespace

TEST_CASE("configuration reader returns values and fallbacks") {
  TomlTable table = parse("a = 1.5\nb = 3\nc = \"x\"\nd = true\ne = [1, 2.5, 3]\n");
  CHECK(table.number("a", irdm::above(0)) == 1.5);
  CHECK(table.integer("b", 0, 5) == 3);
  CHECK(table.number("missing", irdm::above(0), 9.0) == 9.0);
  CHECK(table.choice("c", {"x", "y"}, "y") == "x");
  CHECK(table.boolean("d", false));
  CHECK(table.numbers("e", 3, {}) == std::vector<double>{1, 2.5, 3});
  CHECK_NOTHROW(table.finish());
}

TEST_CASE("configuration reader names file, line and key of what is wrong") {
  CHECK_THROWS_WITH(parse("\n\na = -1").number("a", irdm::above(0)),
                    ContainsSubstring("test.toml:3: a is -1"));
  CHECK_THROWS_WITH(parse("a = nan").number("a", {}), ContainsSubstring("finite"));
  CHECK_THROWS_WITH(parse("a = inf").number("a", {}), ContainsSubstring("finite"));
  CHECK_THROWS_WITH(parse("a = \"1\"").number("a", {}), ContainsSubstring("not a number"));
  CHECK_THROWS_WITH(parse("").number("a", {}), ContainsSubstring("a is missing"));
  CHECK_THROWS_WITH(parse("a = 7").integer("a", 0, 5), ContainsSubstring("from 0 to 5"));
  CHECK_THROWS_WITH(parse("a = 1.5").integer("a", 0, 5), ContainsSubstring("whole number"));
  CHECK_THROWS_WITH(parse("a = 1").boolean("a", true), ContainsSubstring("true or false"));
  CHECK_THROWS_WITH(parse("a = \"z\"").choice("a", {"x", "y"}, "x"), ContainsSubstring("x | y"));
  CHECK_THROWS_WITH(parse("a = [1, 2]").numbers("a", 3, {}), ContainsSubstring("3 numbers"));
  CHECK_THROWS_WITH(parse("a = 1").table("a"), ContainsSubstring("not a table"));
  CHECK_THROWS_WITH(parse("a = [1]").tables("a"), ContainsSubstring("list of tables"));
  CHECK_THROWS_WITH(parse("a = "), ContainsSubstring("test.toml:1"));
}

TEST_CASE("configuration reader rejects keys that nobody reads, in nested tables too") {
  TomlTable table = parse("a = 1\n[b]\nc = 2\ntypo = 3\n");
  table.number("a", {});
  TomlTable nested = table.table("b");
  nested.number("c", {});
  CHECK_NOTHROW(table.finish());
  CHECK_THROWS_WITH(nested.finish(),
                    ContainsSubstring("test.toml:4: b.typo is not a known key; remove"));
}

TEST_CASE("messages quote the beginning of what is long, and say where it is") {
  const std::string long_word(1'000'000, 'w');
  const auto message = [](const auto& action) {
    try {
      action();
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto is_short = [](const std::string& text, const std::string& begin) {
    CAPTURE(text.substr(0, 400));
    CHECK(text.starts_with(begin));
    CHECK(text.size() < 400);
  };
  is_short(message([&] { parse("\na = \"" + long_word + "\"").path("a"); }),
           "test.toml:2: a has 1000000 bytes");
  const std::string word(4000, 'w');
  is_short(message([&] { parse("\na = \"" + word + "\"").path("a"); }),
           "test.toml:2: a has the file name 'www");
  is_short(message([&] { parse("\na = \"" + word + "\"").choice("a", {"b"}, "b"); }),
           "test.toml:2: a is 'www");
  is_short(message([&] { parse("\n" + long_word + " = 1").finish(); }), "test.toml:2: www");
  is_short(message([&] { parse("\n" + long_word); }), "test.toml:2: ");
  is_short(message([&] { parse("a = 1\n" + long_word + " = 1\n" + long_word + " = 2\n"); }),
           "test.toml:3: ");
}

TEST_CASE("a quotation ends between two characters") {
  CHECK(irdm::in_quotes("short") == "'short'");
  CHECK(irdm::shortened(std::string(80, 'w')) == std::string(80, 'w'));
  CHECK(irdm::shortened(std::string(81, 'w')) == std::string(80, 'w') + "...");
  // Of two bytes each, the first at an odd place.
  std::string umlauts = "x";
  for (int i = 0; i < 100; ++i) umlauts += "\u00fc";
  CHECK(irdm::shortened(umlauts) == umlauts.substr(0, 79) + "...");
}

TEST_CASE("what a message quotes of a file has no control characters") {
  const std::string word = "b\\u001B[31m\\nc";
  CHECK_THROWS_WITH(parse("a = \"" + word + "\"").choice("a", {"x"}, "x"),
                    ContainsSubstring("a is 'b?[31m?c'"));
  CHECK_THROWS_WITH(parse("\"" + word + "\" = 1").finish(),
                    ContainsSubstring("b?[31m?c is not a known key"));
}

TEST_CASE("configuration reader says when the file is missing") {
  CHECK_THROWS_AS(TomlTable::parse_file("no-such-file.toml"), Error);
}

TEST_CASE("a number that is barely outside is not printed as the bound that it is not") {
  const irdm::Range range = irdm::between(1e-15, 1.0);
  CHECK(irdm::outside_text(range, std::nextafter(1e-15, 0.0)) ==
        "is 9.9999999999999988e-16, not a finite number >= 1e-15 and <= 1");
  CHECK(irdm::outside_text(range, 2.0) == "is 2, not a finite number >= 1e-15 and <= 1");
}

TEST_CASE("an address of IPv6 has brackets before its port") {
  CHECK(irdm::address_text("::1", 48121) == "[::1]:48121");
  CHECK(irdm::address_text("127.0.0.1", 7) == "127.0.0.1:7");
}

TEST_CASE("a list of whole numbers takes no other numbers") {
  CHECK(parse("a = [1, 2, 3]").integers("a", 3, 1, 9) == std::vector<int>{1, 2, 3});
  CHECK_THROWS_WITH(parse("a = [2.0, 2, 2]").integers("a", 3, 1, 9),
                    ContainsSubstring("a is not a whole number"));
  CHECK_THROWS_WITH(parse("a = [0, 2, 2]").integers("a", 3, 1, 9), ContainsSubstring("a is 0"));
  CHECK_THROWS_WITH(parse("a = [2, 2]").integers("a", 3, 1, 9),
                    ContainsSubstring("a has 2 entries"));
}
