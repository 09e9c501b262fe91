#include "common/utf8.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("UTF-8 is told from what only resembles it") {
  for (const char* good : {"", "plain", "W\xC3\xBCrfel", "\xE2\x82\xAC", "\xED\x9F\xBF",
                           "\xF0\x9F\x98\x80", "\xF4\x8F\xBF\xBF"}) {
    CAPTURE(good);
    CHECK(is_utf8(good));
  }
  // Bytes alone, a character cut short, overlong forms, a surrogate, a number above 0x10FFFF.
  for (const char* bad :
       {"\xFF", "\x80", "a\xC3", "\xE2\x82", "\xC0\xAF", "\xE0\x80\xAF", "\xF0\x80\x80\xAF",
        "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80"}) {
    CAPTURE(bad);
    CHECK_FALSE(is_utf8(bad));
    CHECK(is_utf8(as_utf8(bad, 100)));
  }
}

TEST_CASE("text becomes UTF-8 by question marks, and is cut behind a whole character") {
  CHECK(as_utf8("a\xFF"
                "b",
                100) == "a?b");
  CHECK(as_utf8("W\xC3\xBC", 100) == "W\xC3\xBC");
  CHECK(as_utf8("W\xC3\xBC", 2) == "W");
  CHECK(as_utf8("\xE2\x82\xAC", 2).empty());
  CHECK(as_utf8("abc", 2) == "ab");
}
