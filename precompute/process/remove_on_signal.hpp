#pragma once

#include <filesystem>

namespace irdm::precompute {

/// While it lives, SIGINT, SIGTERM, SIGHUP and SIGPIPE remove one file before they end the process
/// as they always do; a signal that is ignored (nohup) stays ignored. A handler and not a waiting
/// thread: the threads of the BLAS start before main and may be the ones that a signal is delivered
/// to. One at a time.
class RemoveOnSignal {
 public:
  explicit RemoveOnSignal(const std::filesystem::path& file);
  RemoveOnSignal(const RemoveOnSignal&) = delete;
  RemoveOnSignal& operator=(const RemoveOnSignal&) = delete;
  ~RemoveOnSignal();
};

}  // namespace irdm::precompute
