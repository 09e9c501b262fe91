#include "replay/pictures/child_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <thread>

#include "common/error.hpp"

namespace irdm::replay {
namespace {

/// What posix_spawn needs besides the command.
class Surroundings {
 public:
  Surroundings(const std::map<int, int>& descriptors, bool quiet) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    if (quiet) {
      ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    }
    for (const auto& [there, here] : descriptors) {
      ::posix_spawn_file_actions_adddup2(&actions_, here, there);
    }
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
  }
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;
  ~Surroundings() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

}  // namespace

ChildProgram::ChildProgram(std::vector<std::string> command, const std::map<int, int>& descriptors,
                           bool quiet) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  const Surroundings surroundings(descriptors, quiet);
  const int error = ::posix_spawnp(&pid_, words[0], surroundings.actions(),
                                   surroundings.attributes(), words.data(), ::environ);
  if (error == 0) return;
  throw Error(command[0], "cannot be started: " + std::generic_category().message(error),
              "install Debian's package " + command[0]);
}

ChildProgram::~ChildProgram() {
  using namespace std::chrono_literals;
  constexpr int kPatience = 300;  // times 10 ms
  for (int i = 0; i < kPatience && !ended(WNOHANG); ++i) std::this_thread::sleep_for(10ms);
  if (pid_ == 0) return;
  ::kill(-pid_, SIGKILL);
  wait();
}

int ChildProgram::wait() noexcept {
  while (!ended(0)) {
  }
  return status_;
}

bool ChildProgram::ended(int options) noexcept {
  if (pid_ == 0) return true;
  int status = 0;
  const pid_t found = ::waitpid(pid_, &status, options);
  if (found == 0 || (found < 0 && errno == EINTR)) return false;
  status_ = found > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  pid_ = 0;
  return true;
}

bool program_exists(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

}  // namespace irdm::replay
