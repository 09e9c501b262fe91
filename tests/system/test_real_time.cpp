#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/scheduling.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

namespace fs = std::filesystem;

std::string line_of(const fs::path& path, const std::string& begin = "") {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line) && !line.starts_with(begin)) {
  }
  return line;
}

/// The thread of a process that has this name; 0: there is none.
pid_t thread_of(const ChildProcess& process, const std::string& name) {
  std::error_code ignored;
  const fs::path tasks = "/proc/" + std::to_string(process.pid()) + "/task";
  for (const auto& task : fs::directory_iterator(tasks, ignored)) {
    if (line_of(task.path() / "comm") == name) return std::stoi(task.path().filename());
  }
  return 0;
}

pid_t await_thread(const ChildProcess& process, const std::string& name) {
  pid_t found = 0;
  REQUIRE(eventually([&] { return (found = thread_of(process, name)) != 0; }));
  return found;
}

/// Whether threads may be put under SCHED_FIFO here, by this process and those that it starts.
bool real_time_permitted() {
  EventFd over;
  std::thread thread([&] { over.wait(-1); });
  const std::string outcome = apply_scheduling(RealTimeScheduling::kPrefer, thread, kServoPriority);
  over.signal();
  thread.join();
  return outcome.starts_with("SCHED_FIFO");
}

/// A server and a bridge whose hand holds the cube all the time.
struct Play {
  Play() {
    stage.write("script.csv", hold_and_circle());
    server.emplace(stage.start_server());
    bridge.emplace(stage.start_bridge(*server));
    bridge->line_with("session ", true);
  }
  void end() {
    bridge->signal(SIGTERM);
    CHECK(bridge->wait() == 0);
    server->process.signal(SIGTERM);
    CHECK(server->process.wait() == 0);
  }
  Stage stage;
  std::optional<Server> server;
  std::optional<ChildProcess> bridge;
};

#ifndef IRDM_SANITIZED
/// Follows the system calls of one thread.
class SystemCalls {
 public:
  SystemCalls(const fs::path& folder, pid_t thread)
      : output_(folder / ("calls-" + std::to_string(thread))),
        strace_({"/usr/bin/strace", "-o", output_.string(), "-p", std::to_string(thread)}) {}

  /// How often it made each call, after many of them; nothing: it must not be watched here.
  std::optional<std::map<std::string, int>> calls() {
    const bool seen = eventually([&] { return calls_so_far() > 500 || !strace_.running(); });
    if (!seen || calls_so_far() <= 500) return std::nullopt;
    strace_.signal(SIGTERM);
    strace_.wait();
    std::map<std::string, int> counts;
    std::istringstream text(file_content(output_));
    std::string line;
    while (std::getline(text, line)) {
      // The last one may be that which it let go of the thread in.
      const bool whole = line.find("<detached") == std::string::npos;
      if (whole && !line.starts_with("strace: ")) ++counts[what(line)];
    }
    return counts;
  }
  std::string why() const { return strace_.err(); }

 private:
  long calls_so_far() const {
    const std::string text = file_content(output_);
    return std::count(text.begin(), text.end(), '\n');
  }
  // The call, and for a write how many bytes: an event's are eight.
  static std::string what(const std::string& line) {
    const std::string name = line.substr(0, line.find('('));
    const bool event = line.find("\\0\", 8) ") != std::string::npos && line.ends_with("= 8");
    return name == "write" && event ? "signal" : name;
  }
  fs::path output_;
  ChildProcess strace_;
};

void check_calls(const Play& play, pid_t thread) {
  SystemCalls trace(play.stage.path(""), thread);
  auto calls = trace.calls();
  if (!calls) return leave_out("strace cannot watch a thread here: " + trace.why());
  CHECK(calls->at("clock_nanosleep") > 100);
  CHECK(calls->at("signal") > 100);
  calls->erase("clock_nanosleep");
  calls->erase("restart_syscall");  // strace came in the middle of a sleep
  calls->erase("signal");
  for (const auto& [call, count] : *calls) FAIL_CHECK(count << " times " << call);
}
#endif

}  // namespace

#ifndef IRDM_SANITIZED
TEST_CASE("real time: servo and force thread make no system calls but to sleep and to signal") {
  if (!fs::exists("/usr/bin/strace")) return leave_out("there is no strace");
  Play play;
  check_calls(play, await_thread(play.server->process, "force"));
  check_calls(play, await_thread(*play.bridge, "servo"));
  play.end();
}
#endif

TEST_CASE("real time: threads have the priorities and the memory that the programs report") {
  Play play;
  const auto priority = [](pid_t thread) {
    sched_param parameters{};
    ::sched_getparam(thread, &parameters);
    return ::sched_getscheduler(thread) == SCHED_FIFO ? parameters.sched_priority : 0;
  };
  const pid_t force = await_thread(play.server->process, "force");
  const pid_t servo = await_thread(*play.bridge, "servo");
  const pid_t deformation = await_thread(play.server->process, "deformation");
  await_thread(play.server->process, "network");
  await_thread(*play.bridge, "black box");
  cpu_set_t of_force;
  cpu_set_t of_deformation;
  REQUIRE(::sched_getaffinity(force, sizeof of_force, &of_force) == 0);
  const int cpus = CPU_COUNT(&of_force);
  CHECK(eventually([&] {
    ::sched_getaffinity(deformation, sizeof of_deformation, &of_deformation);
    return CPU_COUNT(&of_deformation) == std::max(1, cpus - 1);
  }));
  // A thread runs already, and has its name, while its starter gives it its priority.
  const bool permitted = real_time_permitted();
  if (!permitted) leave_out("real-time priority is not permitted here");
  CHECK(eventually([&] { return priority(force) == (permitted ? kForcePriority : 0); }));
  CHECK(eventually([&] { return priority(servo) == (permitted ? kServoPriority : 0); }));
  const std::string locked =
      line_of("/proc/" + std::to_string(play.server->process.pid()) + "/status", "VmLck:");
  play.end();
  CHECK_THAT(play.server->process.out(),
             ContainsSubstring(permitted ? "real-time scheduling: SCHED_FIFO 60, memory "
                                         : "real-time scheduling: none ("));
  CHECK_THAT(play.bridge->out(), ContainsSubstring(permitted ? "scheduling SCHED_FIFO 70, memory "
                                                             : "scheduling none ("));
  const bool some = locked.find(" 0 kB") == std::string::npos;
  INFO(locked);
  CHECK(some == (play.server->process.out().find(", memory locked\n") != std::string::npos));
}

TEST_CASE("real time: a program that requires what it may not have says what to do") {
  const Stage stage;
  std::string scene = scene_text();
  scene.replace(scene.find("port = 0"), 8, "port = 0\nrealtime = \"require\"");
  stage.write("scene.toml", scene);
  stage.write("bridge.toml",
              "[bridge]\nrealtime = \"require\"\n[[device]]\nscript = \"script.csv\"\n");
  // Without the rights of root, if this is root, and without those of a limit.
  const auto refused = [](std::vector<std::string> command) {
    std::vector<std::string> words{"/usr/bin/setpriv", "--bounding-set=-all", "/usr/bin/prlimit",
                                   "--memlock=65536", "--rtprio=0"};
    if (::geteuid() != 0) words.erase(words.begin(), words.begin() + 2);
    words.insert(words.end(), command.begin(), command.end());
    return run_to_end(words);
  };
  const FinishedProgram server = refused({IRDM_SERVER, stage.path("scene.toml").string()});
  const FinishedProgram bridge =
      refused({IRDM_BRIDGE, stage.path("bridge.toml").string(), "--server", "127.0.0.1:1"});
  for (const FinishedProgram& program : {server, bridge}) {
    CHECK(program.status == 1);
    CHECK(program.out.empty());
    CHECK_THAT(program.err,
               ContainsSubstring(": error: ") && ContainsSubstring("memlock unlimited") &&
                   ContainsSubstring("rtprio 90") && ContainsSubstring("realtime = \"prefer\""));
#ifndef IRDM_SANITIZED  // whose runtime has lines of its own
    CHECK(std::count(program.err.begin(), program.err.end(), '\n') == 1);
#endif
  }
}
