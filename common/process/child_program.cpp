#include "common/process/child_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "common/error.hpp"

namespace irdm {
namespace {

/// What posix_spawn needs besides the command.
class SpawnOptions {
 public:
  explicit SpawnOptions(const ChildSettings& settings) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, settings.log.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    for (const auto& [its, ours] : settings.descriptors) {
      ::posix_spawn_file_actions_adddup2(&actions_, ours, its);
    }
    if (!settings.folder.empty()) {
      ::posix_spawn_file_actions_addchdir_np(&actions_, settings.folder.c_str());
    }
    ::posix_spawnattr_init(&attributes_);
    if (settings.own_group) ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
  }
  SpawnOptions(const SpawnOptions&) = delete;
  SpawnOptions& operator=(const SpawnOptions&) = delete;
  ~SpawnOptions() {
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

ChildProgram::ChildProgram(const std::vector<std::string>& command, const ChildSettings& settings)
    : own_group_(settings.own_group) {
  const auto failed = [&command](const std::string& why) {
    return Error(command.front(), "cannot be started: " + why,
                 "install it, or see whether it works by itself");
  };
  if (!program_exists(command.front())) throw failed("there is no such program in PATH");
  std::vector<std::string> words;
  // The kernel ends the program where this process has no time to. The words are of util-linux,
  // which Debian always has.
  if (program_exists("setpriv")) words = {"setpriv", "--pdeathsig", "KILL", "--"};
  words.insert(words.end(), command.begin(), command.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const SpawnOptions options(settings);
  const int error = ::posix_spawnp(&pid_, argv.front(), options.actions(), options.attributes(),
                                   argv.data(), ::environ);
  if (error != 0) {
    pid_ = 0;
    throw failed(std::generic_category().message(error));
  }
  cleanup_.emplace(CleanupAction{.kill = own_group_ ? -pid_ : pid_});
}

ChildProgram::~ChildProgram() {
  constexpr double kPatience = 3.0;
  if (ends_within(kPatience)) return;
  kill();
}

bool ChildProgram::ends_within(double seconds) noexcept {
  if (pid_ == 0) return true;
  // By number: glibc 2.36 declares pidfd_open for C only. Without it, on an old kernel, there is no
  // limit.
  const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  if (descriptor >= 0) {
    pollfd entry{descriptor, POLLIN, 0};
    int ready = 0;
    do {
      ready = ::poll(&entry, 1, static_cast<int>(seconds * 1000.0));
    } while (ready < 0 && errno == EINTR);
    ::close(descriptor);
    if (ready <= 0) return false;
  }
  collect();
  return true;
}

void ChildProgram::kill() noexcept {
  if (pid_ == 0) return;
  ::kill(own_group_ ? -pid_ : pid_, SIGKILL);
  collect();
}

void ChildProgram::collect() noexcept {
  int status = 0;
  pid_t found = 0;
  do {
    found = ::waitpid(pid_, &status, 0);
  } while (found < 0 && errno == EINTR);
  status_ = found > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (own_group_) ::kill(-pid_, SIGKILL);  // programs that it has started itself
  cleanup_.reset();
  pid_ = 0;
}

bool program_exists(const std::string& name) {
  if (name.find('/') != std::string::npos) return ::access(name.c_str(), X_OK) == 0;
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

ChildEnd run_child(const std::string& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, const std::filesystem::path& log_file,
                   double time_limit_s) {
  if (!program_exists(program)) return ChildEnd::kNotFound;
  std::vector<std::string> command{program};
  command.insert(command.end(), arguments.begin(), arguments.end());
  ChildProgram child(command, {.folder = folder, .log = log_file});
  if (!child.ends_within(time_limit_s)) {
    child.kill();
    return ChildEnd::kTimeout;
  }
  return child.status() == 0 ? ChildEnd::kSuccess : ChildEnd::kFailure;
}

}  // namespace irdm
