#include "common/realtime/spared_cpu.hpp"

namespace irdm {

cpu_set_t all_but_last(const cpu_set_t& cpus) noexcept {
  cpu_set_t rest = cpus;
  if (CPU_COUNT(&cpus) < 2) return rest;
  int last = CPU_SETSIZE - 1;
  while (!CPU_ISSET(last, &rest)) --last;
  CPU_CLR(last, &rest);
  return rest;
}

void spare_last_cpu() noexcept {
  cpu_set_t cpus;
  if (::sched_getaffinity(0, sizeof cpus, &cpus) != 0) return;
  const cpu_set_t rest = all_but_last(cpus);
  ::sched_setaffinity(0, sizeof rest, &rest);
}

}  // namespace irdm
