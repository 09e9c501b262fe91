#pragma once

#include <fcntl.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "common/error.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

/// A file system in memory, seen by this process only: it is in no folder, and the kernel takes it
/// away with the last descriptor in it, however the process ends.
class SmallDisk {
 public:
  /// @param kind tmpfs, with a size ("size=1m"), or ramfs, which keeps no room free on request
  /// Throws Error where the kernel does not let this process make one.
  explicit SmallDisk(const std::string& kind, const std::string& options = "") {
    const TemporaryFolder folder;
    if (::mount("none", folder.path().c_str(), kind.c_str(), 0, options.c_str()) != 0) {
      throw Error("a small disk", std::string("cannot be mounted: ") + std::strerror(errno),
                  "needs root and a kernel that allows it");
    }
    descriptor_ = ::open(folder.path().c_str(), O_DIRECTORY | O_RDONLY | O_CLOEXEC);
    ::umount2(folder.path().c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() { ::close(descriptor_); }

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_ = -1;
};

/// None, and the test left out, where there can be none.
inline std::unique_ptr<SmallDisk> small_disk(const std::string& kind,
                                             const std::string& options = "") {
  try {
    return std::make_unique<SmallDisk>(kind, options);
  } catch (const Error& error) {
    leave_out(error.what());
    return nullptr;
  }
}

}  // namespace irdm::test
