#include "precompute/process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <optional>

namespace irdm::precompute {
namespace {

// Starts the child; nothing when there is no such program.
std::optional<pid_t> spawn(const std::string& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& folder,
                           const std::filesystem::path& log_file) {
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log_file.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, program.c_str(), &actions, nullptr, argv.data(), ::environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? std::optional(child) : std::nullopt;
}

// False when the time is over and the child still runs.
bool wait_until_ended(pid_t child, double time_limit_s) {
  // By number: glibc 2.36 declares pidfd_open for C only.
  const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  if (descriptor < 0) return true;  // an old kernel: waitpid will wait without limit
  pollfd entry{descriptor, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&entry, 1, static_cast<int>(time_limit_s * 1000.0));
  } while (ready < 0 && errno == EINTR);
  ::close(descriptor);
  return ready > 0;
}

}  // namespace

ChildEnd run_child(const std::string& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, const std::filesystem::path& log_file,
                   double time_limit_s) {
  const std::optional<pid_t> child = spawn(program, arguments, folder, log_file);
  if (!child) return ChildEnd::kNotFound;
  const bool ended = wait_until_ended(*child, time_limit_s);
  if (!ended) ::kill(*child, SIGKILL);
  int status = 0;
  while (::waitpid(*child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!ended) return ChildEnd::kTimeout;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? ChildEnd::kSuccess : ChildEnd::kFailure;
}

}  // namespace irdm::precompute
