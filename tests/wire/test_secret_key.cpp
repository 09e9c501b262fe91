#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "common/wire/secret_key.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace {

constexpr fs::perms kOwner = fs::perms::owner_read | fs::perms::owner_write;
const std::string kDigits = "000102030405060708090a0b0c0d0e0f101112131415161718191A1B1C1D1E1F";

/// A key file with this content.
class KeyFile {
 public:
  explicit KeyFile(const std::string& content, fs::perms permissions = kOwner) {
    std::ofstream(path()) << content;
    fs::permissions(path(), permissions);
  }
  fs::path path() const { return folder_.path() / "irdm.key"; }
  /// Why it is refused; empty: it is not.
  std::string rejection() const {
    try {
      wire::read_key_file(path());
      return {};
    } catch (const Error& error) {
      return error.what();
    }
  }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("a key file is 64 hexadecimal digits, as openssl rand -hex 32 writes them") {
  const wire::SecretKey key = wire::read_key_file(KeyFile(kDigits + "\n").path());
  for (std::size_t i = 0; i < key.size(); ++i) CHECK(key[i] == i);
}

TEST_CASE("a key file with anything else in it is refused, and not quoted") {
  for (const std::string& content :
       {std::string(), kDigits.substr(2), kDigits + "20", kDigits + "\n" + kDigits,
        kDigits.substr(1) + "g", kDigits.substr(1) + "-"}) {
    const std::string rejection = KeyFile(content).rejection();
    CHECK_THAT(rejection, ContainsSubstring("is not a key of 64 hexadecimal digits"));
    CHECK_THAT(rejection, !ContainsSubstring("0203"));
  }
}

TEST_CASE("a key file that others may read or write is refused") {
  for (const fs::perms more : {fs::perms::group_read, fs::perms::others_read,
                               fs::perms::group_write, fs::perms::others_exec}) {
    CHECK_THAT(KeyFile(kDigits, kOwner | more).rejection(),
               ContainsSubstring("others may read or write") && ContainsSubstring("chmod 600 "));
  }
  CHECK(KeyFile(kDigits, fs::perms::owner_read).rejection().empty());
}

TEST_CASE("a key file that is none is refused, with the way to make one") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(wire::read_key_file(folder.path() / "none"),
                    ContainsSubstring("no such file") && ContainsSubstring("openssl rand -hex 32"));
  CHECK_THROWS_WITH(wire::read_key_file(folder.path()), ContainsSubstring("is not a file"));
}
