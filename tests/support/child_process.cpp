#include "tests/support/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

namespace irdm::test {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

/// What posix_spawn needs besides the command, freed again.
class SpawnSettings {
 public:
  SpawnSettings(const std::filesystem::path& output, const std::filesystem::path& folder) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    add_output(STDOUT_FILENO, output / "out");
    add_output(STDERR_FILENO, output / "err");
    if (!folder.empty()) posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    // Whatever this process blocks or ignores, the program starts with its signals as a shell
    // would give them.
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigemptyset(&none);
    sigset_t usual;
    sigfillset(&usual);
    sigdelset(&usual, SIGKILL);
    sigdelset(&usual, SIGSTOP);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  void add_output(int descriptor, const std::filesystem::path& path) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, path.c_str(), O_WRONLY | O_CREAT, 0600);
  }
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

}  // namespace

std::string file_content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, const ChildOptions& options)
    : name_(std::filesystem::path(command.at(0)).filename().string()),
      output_(std::make_unique<TemporaryFolder>()) {
  std::vector<std::string> words = command;
  std::vector<std::string> environment = options.environment;  // the first of a name counts
  for (char** entry = ::environ; *entry != nullptr; ++entry) environment.emplace_back(*entry);
  const SpawnSettings settings(output_->path(), options.folder);
  const int error =
      ::posix_spawn(&pid_, command[0].c_str(), settings.actions(), settings.attributes(),
                    pointers(words).data(), pointers(environment).data());
  if (error != 0) throw std::runtime_error(command[0] + ": " + std::strerror(error));
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : name_(std::move(other.name_)),
      output_(std::move(other.output_)),
      pid_(std::exchange(other.pid_, -1)),
      status_(std::exchange(other.status_, std::nullopt)) {}

ChildProcess::~ChildProcess() {
  if (pid_ > 0 && !ended()) end(SIGKILL);
}

void ChildProcess::end(int number) noexcept {
  ::kill(pid_, number);
  int ignored = 0;
  ::waitpid(pid_, &ignored, 0);
  status_ = -number;
}

bool ChildProcess::ended() {
  if (status_) return true;
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return true;
}

bool ChildProcess::running() {
  return !ended();
}

std::string ChildProcess::told() const {
  return "\nits output:\n" + out() + "its errors:\n" + err();
}

std::string ChildProcess::line_with(const std::string& text, bool errors) {
  const auto deadline = Clock::now() + std::chrono::milliseconds(kDeadlineMs);
  for (;;) {
    const bool last = ended() || Clock::now() > deadline;  // asked before the output is read
    const std::string output = errors ? err() : out();
    for (std::size_t begin = 0, end = 0; (end = output.find('\n', begin)) != std::string::npos;
         begin = end + 1) {
      const std::string line = output.substr(begin, end - begin);
      if (line.find(text) != std::string::npos) return line;
    }
    if (last) throw std::runtime_error(name_ + " does not say '" + text + "'" + told());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void ChildProcess::signal(int number) {
  if (!ended()) ::kill(pid_, number);
}

int ChildProcess::wait() {
  const auto deadline = Clock::now() + std::chrono::milliseconds(kDeadlineMs);
  while (!ended()) {
    if (Clock::now() > deadline) {
      end(SIGKILL);
      throw std::runtime_error(name_ + " does not end" + told());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return *status_;
}

std::string ChildProcess::out() const {
  return file_content(output_->path() / "out");
}

std::string ChildProcess::err() const {
  return file_content(output_->path() / "err");
}

FinishedProgram run_to_end(const std::vector<std::string>& command, const ChildOptions& options) {
  ChildProcess child(command, options);
  const int status = child.wait();
  return {status, child.out(), child.err()};
}

}  // namespace irdm::test
