#pragma once

namespace irdm {

/// Threads of OpenMP that have nothing to do are to sleep: by default they turn round and round for
/// about a millisecond after each loop, beside the real-time threads. The runtime reads how it is
/// to wait when the program is loaded, so this starts the program again (same process, same
/// arguments) with OMP_WAIT_POLICY=passive. Returns at once when the environment says how to wait.
/// First thing in main().
void wait_passively_in_openmp(char** argv);

}  // namespace irdm
