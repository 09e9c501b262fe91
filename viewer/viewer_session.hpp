#pragma once

#include <cstdint>
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
class ViewerSession {
 public:
  virtual ~ViewerSession() = default;

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

  virtual void handle(const Command& command) = 0;
  /// @param request of as many objects as the scene has
  virtual void handle(const SettingsRequest& request) = 0;
  virtual void handle(const StylusRequest& request) = 0;
  virtual void handle(const SceneRequest& request) = 0;
};

/// Who of the viewers has their one stylus: the first one to press, until it lets go or falls
/// silent. Pure but for what it asks of the run; viewer's thread.
class StylusHolder {
 public:
  StylusHolder(ViewerSession& run, std::int64_t timeout_ns) : run_(run), timeout_ns_(timeout_ns) {}

  bool free() const noexcept { return holder_ == nullptr; }
  bool held_by(const void* viewer) const noexcept {
    return holder_ != nullptr && holder_ == viewer;
  }

  /// True when the stylus has changed hands.
  bool take(const StylusRequest& request, const void* viewer, std::int64_t now_ns) {
    if (holder_ != nullptr && holder_ != viewer) return false;
    if (holder_ == nullptr && !request.present) return false;
    run_.handle(request);
    heard_ns_ = now_ns;
    const void* before = holder_;
    holder_ = request.present ? viewer : nullptr;
    return holder_ != before;
  }

  /// Takes it from a viewer that has fallen silent or is gone.
  /// @param there bool(const void* viewer): it is still connected
  template <typename There>
  void expire(std::int64_t now_ns, const There& there) {
    if (holder_ == nullptr) return;
    if (now_ns - heard_ns_ <= timeout_ns_ && there(holder_)) return;
    holder_ = nullptr;
    run_.handle(StylusRequest{});
  }

 private:
  ViewerSession& run_;
  std::int64_t timeout_ns_;
  const void* holder_ = nullptr;  ///< compared only
  std::int64_t heard_ns_ = 0;
};

}  // namespace irdm::viewer
