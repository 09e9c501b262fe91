#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "common/realtime/no_denormals.hpp"
#include "common/realtime/real_time_scope.hpp"
#include "common/realtime/scheduling.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

// Not known to the compiler.
double half(double number) {
  const volatile double hidden = number;
  return hidden / 2.0;
}

bool keeps_denormals() {
  return half(std::numeric_limits<double>::min()) > 0.0;
}

// Of a thread of this process, as the kernel shows it.
std::string status_line(const std::string& name) {
  std::ifstream file("/proc/thread-self/status");
  std::string line;
  while (std::getline(file, line) && !line.starts_with(name)) {
  }
  return line;
}

}  // namespace

TEST_CASE("denormal numbers are zero while that is wanted, and in that thread alone") {
  REQUIRE(keeps_denormals());
  {
    const NoDenormals outer;
    CHECK_FALSE(keeps_denormals());
    const volatile double denormal = std::numeric_limits<double>::denorm_min();
    CHECK(denormal * 1e300 == 0.0);  // read as zero, too
    { const NoDenormals inner; }
    CHECK_FALSE(keeps_denormals());
    bool elsewhere = false;
    // A new thread inherits it: it says so itself when it does not want it.
    std::thread([&] { elsewhere = keeps_denormals(); }).join();
    CHECK_FALSE(elsewhere);
  }
  CHECK(keeps_denormals());
}

TEST_CASE(
    "a real-time thread has a name, computes without denormals and leaves them as they were") {
  std::string name;
  bool inside = true;
  bool after = false;
  std::thread([&] {
    {
      const RealTimeScope scope("some name", RealTimeScheduling::kPrefer);
      name = status_line("Name:");
      inside = keeps_denormals();
    }
    after = keeps_denormals();
  }).join();
  CHECK_THAT(name, Catch::Matchers::EndsWith("some name"));
  CHECK_FALSE(inside);
  CHECK(after);
}

TEST_CASE("memory is locked when it says so") {
  CHECK(lock_memory(RealTimeScheduling::kIgnore) == "not locked");
  const std::string came_of_it = lock_memory(RealTimeScheduling::kPrefer);
  const bool some = status_line("VmLck:").find(" 0 kB") == std::string::npos;
  INFO(came_of_it << "; " << status_line("VmLck:"));
  CHECK(some == (came_of_it == "locked"));
  if (!some) CHECK_THAT(came_of_it, Catch::Matchers::ContainsSubstring("not locked ("));
}

TEST_CASE("the last processor is spared where there are several") {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(3, &cpus);
  const cpu_set_t same = all_but_last(cpus);
  CHECK(CPU_EQUAL(&cpus, &same));
  CPU_SET(1, &cpus);
  CPU_SET(7, &cpus);
  const cpu_set_t rest = all_but_last(cpus);
  CHECK(CPU_COUNT(&rest) == 2);
  CHECK(CPU_ISSET(1, &rest));
  CHECK(CPU_ISSET(3, &rest));
  int before = 0;
  int after = 0;
  std::thread([&] {
    cpu_set_t mine;
    REQUIRE(::sched_getaffinity(0, sizeof mine, &mine) == 0);
    before = CPU_COUNT(&mine);
    spare_last_cpu();
    REQUIRE(::sched_getaffinity(0, sizeof mine, &mine) == 0);
    after = CPU_COUNT(&mine);
  }).join();
  CHECK(after == (before > 1 ? before - 1 : 1));
}
