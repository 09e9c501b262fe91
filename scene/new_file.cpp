#include "scene/new_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "common/error.hpp"

namespace irdm {
namespace {

constexpr int kMostNumbers = 9999;

[[noreturn]] void fail(const std::filesystem::path& folder, int cause) {
  throw Error(folder.string(), "takes no new file: " + std::generic_category().message(cause),
              "check the folder, its permissions and the disk");
}

/// A file without a name that anybody looks for, with the permissions that the umask leaves; gone
/// at the end unless it got a name.
class Unnamed {
 public:
  explicit Unnamed(const std::filesystem::path& folder) {
    do {
      path_ = (folder / (".irdm-" + std::to_string(::getpid()) + "-" + std::to_string(next())))
                  .string();
      descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);  // left by a process that was killed
    if (descriptor_ < 0) fail(folder, errno);
  }
  Unnamed(const Unnamed&) = delete;
  Unnamed& operator=(const Unnamed&) = delete;
  ~Unnamed() {
    ::close(descriptor_);
    ::unlink(path_.c_str());
  }

  /// False: errno says why.
  bool write(const std::string& text) {
    std::size_t written = 0;
    while (written < text.size()) {
      const ssize_t count = ::write(descriptor_, text.data() + written, text.size() - written);
      if (count < 0 && errno != EINTR) return false;
      if (count > 0) written += static_cast<std::size_t>(count);
    }
    return ::fsync(descriptor_) == 0;
  }
  /// 0, or the cause: EEXIST where somebody has that name.
  int take_name(const std::filesystem::path& name) {
    if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE) == 0) {
      return 0;
    }
    // Some network file systems do not know it.
    if (errno == EINVAL && ::link(path_.c_str(), name.c_str()) == 0) return 0;
    return errno;
  }

 private:
  static unsigned next() {
    static std::atomic<unsigned> count{0};
    return ++count;
  }

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace

std::string write_new_file(const std::filesystem::path& folder, const std::string& stem,
                           const std::string& ending, const std::string& text) {
  Unnamed file(folder);
  if (!file.write(text)) fail(folder, errno);
  for (int number = 1; number <= kMostNumbers; ++number) {
    const std::string name = stem + "-" + std::to_string(number) + ending;
    const int cause = file.take_name(folder / name);
    if (cause == 0) return name;
    if (cause != EEXIST) fail(folder, cause);
  }
  fail(folder, EEXIST);
}

}  // namespace irdm
