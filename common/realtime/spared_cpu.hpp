#pragma once

#include <sched.h>

namespace irdm {

/// All of these but the last; the same set when there are less than two.
cpu_set_t all_but_last(const cpu_set_t& cpus) noexcept;

/// Keeps the calling thread, and threads that it makes from here on, off the last of the processors
/// that it may run on: there is always one that a real-time thread finds free of them. Does nothing
/// where there is only one.
void spare_last_cpu() noexcept;

}  // namespace irdm
