#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <csignal>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"

namespace irdm::test {

/// As long as it lives, no file of this process can grow beyond `bytes`: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

/// The command of a program that sees a write beyond a limit of file sizes as an error.
inline std::vector<std::string> told_of_full_disk(const std::vector<std::string>& command) {
  std::vector<std::string> words{"/bin/sh", "-c", "trap '' XFSZ; exec \"$0\" \"$@\""};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

/// The same, and none of its files can grow beyond so many bytes from its start on. A program with
/// ThreadSanitizer may die of that: at its start it makes a file of 512 KiB, for its own use.
inline std::vector<std::string> on_full_disk(rlim_t bytes,
                                             const std::vector<std::string>& command) {
  std::vector<std::string> words{"/bin/sh", "-c", "prlimit --pid $$ --fsize=\"$0\"; exec \"$@\"",
                                 std::to_string(bytes)};
  const std::vector<std::string> told = told_of_full_disk(command);
  words.insert(words.end(), told.begin(), told.end());
  return words;
}

/// From now on, no file of that process can grow beyond `bytes`.
inline void limit_file_size(pid_t process, rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  REQUIRE(::prlimit(process, RLIMIT_FSIZE, &limit, nullptr) == 0);
}

}  // namespace irdm::test
