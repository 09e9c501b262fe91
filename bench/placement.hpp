#pragma once

#include <sched.h>

#include <string>
#include <vector>

namespace irdm::bench {

/// Where one who asks and those who answer run. Between processors a message costs what waking one
/// costs, so that answers can only be compared where they come from the same place.
struct Placement {
  std::string name;
  cpu_set_t asking;
  cpu_set_t answering;
};

/// All on one processor; those who answer on another one, where this process may use two; and as
/// the system chooses, which need not be the same for two who answer.
std::vector<Placement> placements();

/// Confines this thread, and the processes and threads that it starts from now on. Throws
/// std::runtime_error when the system does not let it.
void run_on(const cpu_set_t& processors);

}  // namespace irdm::bench
