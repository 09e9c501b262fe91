#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "simulation/step/simulation_config.hpp"
#include "simulation/step/soft_object.hpp"
#include "simulation/step/step_record.hpp"
#include "simulation/step/world_contacts.hpp"

namespace irdm {

/// Objects at rest sleep: their steps are left out. A group, objects so near to each other that
/// they may touch, falls asleep when all of it has been at rest for SimulationConfig::sleep_time.
/// Then its rigid motion is stopped and its state is held; its steps are recorded with the contact
/// forces of the last one that was made, and no velocity. The whole group wakes before a step in
/// which a stylus comes near or exerts a force on it, something awake comes near, or settings
/// change; it goes on from the state that it had. A pure function of the commands, like the step
/// itself. Real-time safe after construction; one thread.
class Sleep {
 public:
  /// No point of an object's surface is faster where it is at rest [m/s], ...
  static constexpr double kStill = 2e-4;
  /// ... it has moved by no more since then [m], ...
  static constexpr double kMoved = 5e-6;
  /// ... and what acts on it in the end accelerates it by no more [m/s^2].
  static constexpr double kUnbalanced = 5e-3;

  /// @param objects, world must outlive this  @param world null: objects touch nothing
  Sleep(const SimulationConfig& config, const std::vector<std::unique_ptr<SoftObject>>& objects,
        WorldContacts* world);

  /// Wakes what the coming step needs, begins the step of all that is awake, and writes the records
  /// of what is not. @param commands one a stylus; of one that leads a tool: nobody
  void begin(std::span<const StylusCommand> commands, StepRecord& record) noexcept;
  /// After SoftObject::finish() of all that is awake: what is at rest may fall asleep.
  void end(const StepRecord& record) noexcept;

  /// Between steps.
  void wake(int object) noexcept;
  void wake_all() noexcept;
  /// State, in or out (StateArchive); after that of the objects.
  void archive(StateArchive& state);

 private:
  static constexpr std::size_t kProbes = 4;

  struct Body {
    SoftObject* object = nullptr;
    bool led = false;     ///< by a stylus, as its tool
    double radius = 0.0;  ///< of a ball about the centre of mass that has the surface at rest [m]
    std::array<int, kProbes> probes{};      ///< nodes far apart on the surface
    std::array<Vector3, kProbes> places{};  ///< of these when it came to rest [m], W
    int rested = 0;                         ///< steps at rest so far
    bool begun = false;                     ///< its part of the step under way
    int group = 0;                          ///< where it is asleep: the least number in its group
    ObjectRecord held;                      ///< of its steps asleep
  };

  Body& body(int i) noexcept { return bodies_[static_cast<std::size_t>(i)]; }
  bool asleep(int i) const noexcept {
    return bodies_[static_cast<std::size_t>(i)].object->asleep();
  }
  bool reached(int i, std::span<const StylusCommand> commands) const noexcept;
  void begin_awake(std::span<const StylusCommand> commands, StepRecord& record) noexcept;
  bool wake_neighbours() noexcept;
  bool still(const Body& body) const noexcept;
  void follow(Body& body) noexcept;
  void find_groups() noexcept;
  bool balanced(const ObjectRecord& record) const noexcept;

  WorldContacts* world_;
  double dt_;                    ///< of a step [s]
  int steps_;                    ///< at rest, after which objects sleep
  std::vector<double> reaches_;  ///< of each stylus: how far from an object it may touch it [m]
  std::vector<Body> bodies_;
  std::vector<int> leader_;  ///< of each object: the least number in its group
  std::array<std::optional<Vector3>, kMaxStyluses> tips_;  ///< in the last step [m], W
  int asleep_ = 0;                                         ///< how many
};

}  // namespace irdm
