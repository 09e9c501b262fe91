#include "common/secret/secret_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "common/error.hpp"

namespace irdm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongest = 4096;  // bytes of a secret and white space
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
constexpr mode_t kOthersBeyondGroupRead = kOthers & ~static_cast<mode_t>(S_IRGRP);

/// A file descriptor that is closed at the end.
class OpenFile {
 public:
  // Without O_NONBLOCK the opening of a FIFO would wait for its writer.
  explicit OpenFile(const fs::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

bool owned_by_us_or_root(const struct stat& file) {
  return file.st_uid == ::geteuid() || file.st_uid == 0;
}

// Whether the file lies in the folder of credentials, and that folder is closed to others.
bool is_credential(const fs::path& path) {
  const char* named = std::getenv("CREDENTIALS_DIRECTORY");
  if (named == nullptr || !fs::path(named).is_absolute()) return false;
  const fs::path folder = path.lexically_normal().parent_path();
  if (folder != (fs::path(named) / "").lexically_normal().parent_path()) return false;
  constexpr mode_t kRefused = S_IWGRP | S_IRWXO;
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 && owned_by_us_or_root(status) &&
         (status.st_mode & kRefused) == 0;
}

void check_access(const fs::path& path, const SecretKind& kind, const struct stat& status) {
  const std::string name = path.string();
  if (!S_ISREG(status.st_mode)) {
    throw Error(name, "is not a file", std::string("name a ") + kind.name + " file");
  }
  if (!owned_by_us_or_root(status)) {
    throw Error(name, std::string("is a ") + kind.name + " that belongs to another user",
                "chown it to the user of this program");
  }
  const mode_t refused = is_credential(path) ? kOthersBeyondGroupRead : kOthers;
  if ((status.st_mode & refused) != 0) {
    throw Error(name, std::string("is a ") + kind.name + " that others may read or write",
                "chmod 600 " + name);
  }
}

std::string made_with(const SecretKind& kind, const std::string& name) {
  return "make one with: (umask 077; openssl rand -hex " + std::to_string(kind.bytes) + " > " +
         name + ")";
}

// One byte more than a secret may have, so that a longer file is seen to be longer.
std::string read_all(int descriptor, const fs::path& path, const SecretKind& kind) {
  std::array<char, kLongest + 1> buffer{};
  std::size_t size = 0;
  while (size < buffer.size()) {
    const ssize_t count = ::read(descriptor, buffer.data() + size, buffer.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw Error(path.string(),
                  std::string("cannot read the ") + kind.name + ": " +
                      std::generic_category().message(errno),
                  "check the disk");
    }
    if (count == 0) return {buffer.data(), size};
    size += static_cast<std::size_t>(count);
  }
  throw Error(path.string(), std::string("is too long for a ") + kind.name,
              made_with(kind, path.string()));
}

std::string trimmed(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

}  // namespace

std::string read_secret_file(const fs::path& path, const SecretKind& kind) {
  const std::string name = path.string();
  const OpenFile file(path);
  if (file.get() < 0) {
    const int cause = errno;
    const std::string what = std::string("cannot read the ") + kind.name + ": ";
    if (cause == ENOENT) throw Error(name, what + "there is no such file", made_with(kind, name));
    throw Error(name, what + std::generic_category().message(cause), "check who owns the file");
  }
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) {
    throw Error(name, std::generic_category().message(errno), "check the disk");
  }
  check_access(path, kind, status);
  return trimmed(read_all(file.get(), path, kind));
}

bool is_token(std::string_view text) {
  constexpr std::size_t kShortest = 16;
  constexpr std::size_t kLongestToken = 128;
  return text.size() >= kShortest && text.size() <= kLongestToken &&
         std::all_of(text.begin(), text.end(),
                     [](char letter) { return letter > 0x20 && letter < 0x7F; });
}

std::string read_token_file(const fs::path& path) {
  constexpr SecretKind kToken{"token", 16};
  std::string token = read_secret_file(path, kToken);
  if (is_token(token)) return token;
  throw Error(path.string(),
              "is not a token of 16 to 128 printable ASCII characters without blanks",
              made_with(kToken, path.string()));
}

}  // namespace irdm
