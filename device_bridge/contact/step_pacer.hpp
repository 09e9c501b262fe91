#pragma once

#include <cstdint>
#include <optional>

namespace irdm {

/// Which of the server's steps it is at the bridge. The bridge is ahead of the server by as much as
/// its forces need on their way, so that each is there for its own step: when one comes late, it
/// hurries on, and when all of them come early for a while, it waits for a step. A hand in contact
/// would feel that as a blow, so there it is put off: what comes a little late is entered at its
/// own step afterwards. A server whose steps take longer than real time is waited for at once.
/// Clocks are never compared: what the server had when it made a step says it all. Pure, real-time
/// safe.
class StepPacer {
 public:
  /// @param dt of a step [s], > 0  @param tick_ns between two calls of due()
  StepPacer(double dt, std::int64_t tick_ns) noexcept;

  /// The server has made `step`, and had the forces up to `newest` of ours by then, if any.
  void hear(std::uint64_t step, std::optional<std::uint64_t> newest, bool in_contact,
            std::int64_t now_ns) noexcept;

  /// How many steps end now, 0 to kMost; each is one more than the step before.
  int due(std::int64_t now_ns) noexcept;

  /// Until it hears of a step again.
  void stop() noexcept { running_ = false; }

  /// Whether it has heard anything, and not been asleep since.
  bool running() const noexcept { return running_; }
  /// The last step that has ended here; while running.
  std::uint64_t step() const noexcept { return step_; }
  /// When it ended, by the clock of due() [ns]; the present when it has not.
  std::int64_t end_of(std::uint64_t step, std::int64_t now_ns) const noexcept;

  static constexpr int kMost = 50;

 private:
  void begin(std::uint64_t step, std::int64_t now_ns) noexcept;
  std::uint64_t due_count(std::int64_t now_ns) const noexcept;
  void keep_pace(std::uint64_t step, std::int64_t lead, bool in_contact) noexcept;

  std::int64_t dt_ns_;
  std::int64_t tick_ns_;
  std::int64_t longest_lead_;  ///< [steps]
  bool running_ = false;
  std::uint64_t step_ = 0;
  std::int64_t next_end_ns_ = 0;    ///< of step_ + 1
  std::uint64_t settled_from_ = 0;  ///< forces of earlier steps know nothing of the last change
  std::optional<std::uint64_t> first_heard_;  ///< step, since then
  std::int64_t least_lead_ = 0;               ///< since then
};

}  // namespace irdm
