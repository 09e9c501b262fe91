#include "common/config/near_word.hpp"
#include "common/config/toml_reader.hpp"
#include "common/error.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::EndsWith;
using namespace irdm;

TEST_CASE("the nearest word is at most one letter in three away") {
  const std::vector<std::string> keys{"youngs_modulus", "density", "file", "unit"};
  CHECK(nearest_word("young_modulus", keys) == "youngs_modulus");
  CHECK(nearest_word("youngs-modulsu", keys) == "youngs_modulus");
  CHECK(nearest_word("Density", keys) == "density");
  CHECK(nearest_word("fiel", keys) == "file");  // neighbours swapped
  CHECK(nearest_word("fil", keys) == "file");
  CHECK_FALSE(nearest_word("fi", keys));
  CHECK_FALSE(nearest_word("colour", keys));
  CHECK_FALSE(nearest_word("", keys));
  CHECK_FALSE(nearest_word(std::string(1'000'000, 'u'), keys));
}

TEST_CASE("a key that is written wrongly is named, whether it is missing or too much") {
  const auto message = [](const std::string& text) -> std::string {
    try {
      TomlTable table = TomlTable::parse_text(text, "a.toml");
      table.number("density", above(0.0));
      table.text("unit", "m");
      table.finish();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message("densty = 1") == "a.toml:1: density is missing; add it, or is it 'densty'?");
  CHECK(message("mass = 1") == "a.toml:1: density is missing; add it");
  CHECK_THAT(message("density = 1\nunits = 'mm'"),
             EndsWith("units is not a known key; did you mean 'unit'?"));
  CHECK_THAT(message("density = 1\ncolour = 'red'"),
             EndsWith("is not a known key; remove it or correct its name"));
  CHECK(message("density = 1") == "");
}
