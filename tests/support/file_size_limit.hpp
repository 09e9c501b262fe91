#pragma once

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <vector>

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

/// The command of a program none of whose files can grow beyond so many bytes.
inline std::vector<std::string> on_full_disk(rlim_t bytes,
                                             const std::vector<std::string>& command) {
  std::vector<std::string> words{"/bin/sh", "-c",
                                 "trap '' XFSZ; prlimit --pid $$ --fsize=\"$0\"; exec \"$@\"",
                                 std::to_string(bytes)};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

}  // namespace irdm::test
