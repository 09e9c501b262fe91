#include "bench/placement.hpp"

#include <stdexcept>

namespace irdm::bench {
namespace {

cpu_set_t only(int processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  return set;
}

}  // namespace

std::vector<Placement> placements() {
  cpu_set_t all;
  if (::sched_getaffinity(0, sizeof all, &all) != 0) {
    throw std::runtime_error("cannot tell which processors there are");
  }
  std::vector<int> numbers;
  for (int processor = 0; processor < CPU_SETSIZE; ++processor) {
    if (CPU_ISSET(processor, &all)) numbers.push_back(processor);
  }
  std::vector<Placement> found;
  found.push_back({"on one processor", only(numbers[0]), only(numbers[0])});
  if (numbers.size() > 1) found.push_back({"on two", only(numbers[0]), only(numbers[1])});
  found.push_back({"as the system chooses", all, all});
  return found;
}

void run_on(const cpu_set_t& processors) {
  if (::sched_setaffinity(0, sizeof processors, &processors) != 0) {
    throw std::runtime_error("cannot choose a processor");
  }
}

}  // namespace irdm::bench
