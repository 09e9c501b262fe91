#pragma once

#include <vector>

#include "common/realtime/event_fd.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "viewer/message.hpp"

namespace irdm::viewer {

/// Where new surfaces come from. The viewer's thread is the reader of both.
struct SurfaceSource {
  TripleBuffer<SurfaceFrame>& surfaces;
  EventFd& ready;  ///< signalled whenever there is a new one
};

/// What viewers see of a run and may ask of it. All of it is called by the viewer's thread, and
/// none of it may wait for another one.
class ViewedRun {
 public:
  virtual ~ViewedRun() = default;

  /// What does not change.
  virtual const Scene& scene() const = 0;
  /// Always the same ones; at least one.
  virtual std::vector<SurfaceSource> sources() = 0;
  /// Which of them is shown now.
  virtual std::size_t shown_source() const = 0;
  /// All but the number of viewers.
  virtual Health health() = 0;
  /// All but what is particular to one viewer.
  virtual State state() = 0;

  virtual void carry_out(const Command& command) = 0;
  /// @param request of as many objects as the scene has
  virtual void carry_out(const SettingsRequest& request) = 0;
  virtual void carry_out(const StylusRequest& request) = 0;
};

}  // namespace irdm::viewer
