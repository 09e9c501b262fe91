// Files of keys and tokens: who may have them, and what stands in them.
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "common/secret/secret_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using Catch::Matchers::ContainsSubstring;
namespace fs = std::filesystem;

namespace {

const std::string kSecret = "0123456789abcdef";

/// $CREDENTIALS_DIRECTORY as long as it lives.
class CredentialsFolder {
 public:
  explicit CredentialsFolder(const fs::path& folder) {
    ::setenv("CREDENTIALS_DIRECTORY", folder.c_str(), 1);
  }
  CredentialsFolder(const CredentialsFolder&) = delete;
  CredentialsFolder& operator=(const CredentialsFolder&) = delete;
  ~CredentialsFolder() { ::unsetenv("CREDENTIALS_DIRECTORY"); }
};

/// A token's file in a folder, with permissions as systemd 254 and later show them.
struct Credential {
  explicit Credential(mode_t folder_mode = 0550, mode_t file_mode = 0440) {
    fs::create_directory(folder);
    std::ofstream(file) << kSecret << '\n';
    REQUIRE(::chmod(file.c_str(), file_mode) == 0);
    REQUIRE(::chmod(folder.c_str(), folder_mode) == 0);
  }
  Credential(const Credential&) = delete;
  Credential& operator=(const Credential&) = delete;
  ~Credential() { ::chmod(folder.c_str(), 0700); }

  test::TemporaryFolder outside;
  fs::path folder = outside.path() / "irdm-server.service";
  fs::path file = folder / "irdm.token";
};

std::string rejection_of(const fs::path& path) {
  try {
    return read_token_file(path) == kSecret ? "" : "another token";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("a credential of systemd with an access list, 0440, is a secret") {
  const Credential credential;
  CHECK_THAT(rejection_of(credential.file), ContainsSubstring("that others may read or write"));
  const CredentialsFolder folder(credential.folder);
  CHECK(rejection_of(credential.file).empty());
}

TEST_CASE("in the folder of credentials, too, others get nothing") {
  for (const mode_t mode : {0444, 0460, 0450, 0441, 0442}) {
    const Credential credential(0550, mode);
    const CredentialsFolder folder(credential.folder);
    CAPTURE(mode);
    CHECK_THAT(rejection_of(credential.file), ContainsSubstring("that others may read or write"));
  }
  for (const mode_t mode : {0555, 0570, 0551}) {
    const Credential credential(mode);
    const CredentialsFolder folder(credential.folder);
    CAPTURE(mode);
    CHECK_THAT(rejection_of(credential.file), ContainsSubstring("that others may read or write"));
  }
}

TEST_CASE("what lies elsewhere is no credential, whatever is named") {
  const Credential credential;
  for (const fs::path& other : {credential.outside.path(), fs::path("."), fs::path("")}) {
    const CredentialsFolder folder(other);
    CHECK_THAT(rejection_of(credential.file), ContainsSubstring("that others may read or write"));
  }
  const CredentialsFolder folder(credential.folder / "");
  CHECK(rejection_of(credential.file).empty());
  CHECK(rejection_of(credential.folder / "." / "irdm.token").empty());
}

TEST_CASE("a secret of another user is refused") {
  if (::geteuid() != 0) return test::leave_out("only root can give a file away");
  const Credential credential(0700, 0600);
  CHECK(rejection_of(credential.file).empty());
  constexpr uid_t kNobody = 65534;
  REQUIRE(::chown(credential.file.c_str(), kNobody, kNobody) == 0);
  CHECK_THAT(rejection_of(credential.file), ContainsSubstring("belongs to another user"));
}

TEST_CASE("a FIFO is no secret, and nobody waits for its writer") {
  const test::TemporaryFolder folder;
  REQUIRE(::mkfifo((folder.path() / "fifo").c_str(), 0600) == 0);
  CHECK_THAT(rejection_of(folder.path() / "fifo"), ContainsSubstring("is not a file"));
}

TEST_CASE("a token's file holds a token and nothing else, and is not quoted") {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "token";
  const auto with = [&](const std::string& content) {
    std::ofstream(path) << content;
    REQUIRE(::chmod(path.c_str(), 0600) == 0);
    return rejection_of(path);
  };
  CHECK(with("\n " + kSecret + " \r\n").empty());
  for (const std::string& content :
       {std::string(), kSecret.substr(1), kSecret + " " + kSecret, std::string(129, 'x')}) {
    CHECK_THAT(with(content), ContainsSubstring("is not a token of 16 to 128 printable ASCII") &&
                                  ContainsSubstring("openssl rand -hex 16") &&
                                  !ContainsSubstring("123456789"));
  }
  CHECK_THAT(with(std::string(5000, 'x')), ContainsSubstring("is too long for a token"));
  CHECK_THAT(rejection_of(folder.path() / "none"), ContainsSubstring("there is no such file"));
}
