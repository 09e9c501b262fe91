#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/threads/recorder_thread.hpp"

namespace irdm {

/// Recordings that are begun and ended while the run goes on, in a folder of their own. One thread.
class Recordings {
 public:
  /// @param folder none: nothing can be recorded
  /// @param shape of the run's steps
  Recordings(std::optional<std::filesystem::path> folder, TraceHeader header,
             const StepShape& shape = {});

  bool possible() const noexcept { return folder_.has_value(); }
  bool recording() const noexcept { return recorder_ != nullptr; }
  /// Whether the one that is being made has ended early; end() says why.
  bool failed() const noexcept { return recorder_ != nullptr && recorder_->failed(); }
  /// Where the force thread puts its steps; closed while nothing is recorded.
  StepSink& sink() noexcept { return sink_; }

  /// Begins one with the next step before which everything is reset. Throws Error.
  void begin();
  /// Ends it; waits until it is written. Throws Error when it is not whole.
  void end();

  /// Those that are complete.
  const std::vector<std::filesystem::path>& complete() const noexcept { return complete_; }

 private:
  std::optional<std::filesystem::path> folder_;
  TraceHeader header_;
  StepSink sink_;
  std::filesystem::path path_;  ///< of the one that is being made
  std::unique_ptr<RecorderThread> recorder_;
  std::vector<std::filesystem::path> complete_;
};

}  // namespace irdm
