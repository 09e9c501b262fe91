#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulation/step/body_contacts.hpp"
#include "simulation/step/contact_island.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/soft_object.hpp"
#include "simulation/step/stylus_ball.hpp"

namespace irdm {

/// Contacts of a scene's objects with each other, with scenery, with balls of styluses, and of
/// parts of one object. In each step objects that touch each other or the same ball form islands,
/// each of which is one contact problem. Real-time safe after construction; one thread.
class WorldContacts {
 public:
  /// Throws Error when an object is too large to touch others, when their masses are too far apart,
  /// when too many have a floor, or when bodies are inside one another at the start.
  /// @param objects, config must outlive this
  WorldContacts(const SimulationConfig& config,
                const std::vector<std::unique_ptr<SoftObject>>& objects);

  /// False: nothing of the scene can touch anything else of it.
  bool any() const noexcept { return !pairs_.empty(); }
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);
  /// Moves scenery and balls to their places at the end of the step. Call it before
  /// SoftObject::begin(). @param commands one for each stylus
  void begin_step(std::span<const StylusCommand> commands) noexcept;
  /// After SoftObject::begin() of all objects: solves their problems and writes the records, up to
  /// SoftObject::finish().
  void solve(StepRecord& record) noexcept;

  /// Returns the ball of stylus s; null if its tip is not a ball.
  const StylusBall* ball(std::size_t s) const noexcept { return balls_[s].get(); }
  /// Returns where and with which force the ball of stylus s touched in the last step, so that it
  /// can take hold there in this one; nothing if it touched no object. Call it before begin_step().
  std::optional<BallGrip> grip(std::size_t s) const noexcept;
  std::span<const std::unique_ptr<ContactPair>> pairs() const noexcept { return pairs_; }
  /// Contacts of this step on objects that are asleep now are in the records of those that follow.
  void hold(const StepRecord& record) noexcept;
  /// ... until the objects are awake.
  void release_awake() noexcept;

 private:
  /// What all objects of a model share.
  struct Shape {
    const Model* model;
    std::unique_ptr<ContactSampling> sampling;
    std::unique_ptr<PatchCompliance> compliance;
    std::unique_ptr<SelfReach> self;  ///< null: it does not touch itself
  };
  /// Returns the ball of a pair; null if its other body is not one.
  StylusBall* ball_of(const ContactPair& pair) const noexcept {
    const int s = -1 - pair.other() - static_cast<int>(scenery_.size());
    return s >= 0 ? balls_[static_cast<std::size_t>(s)].get() : nullptr;
  }
  const Shape& shape_of(const SimulationConfig& config, SoftObject& object);
  int capacity(const SimulationConfig& config) const;
  void add_pairs(const SimulationConfig& config);
  void add_scenery(const SimulationConfig& config, int object);
  void add_balls(const SimulationConfig& config, int object);
  ContactPair& add_pair(const SimulationConfig& config, int object, int other,
                        const SceneryStep& there, const std::string& name);
  void end_balls(const StepRecord& record) noexcept;
  bool suspended(std::size_t pair) noexcept;
  void check_masses(const SimulationConfig& config, int a, int b) const;
  void refuse_overlaps(const SimulationConfig& config);
  void find_islands() noexcept;
  void solve_island(int leader, StepRecord& record) noexcept;
  void apply(std::span<const IslandContact> contacts, StepRecord& record) noexcept;
  Friction friction(const ContactPair& pair) const noexcept;
  bool asleep(int object) const noexcept {
    return objects_[static_cast<std::size_t>(object)]->asleep();
  }
  bool rests(const ContactPair& pair) const noexcept {
    return asleep(pair.object()) && (pair.other() < 0 || asleep(pair.other()));
  }

  std::vector<SoftObject*> objects_;
  std::vector<SceneryStep> scenery_;
  std::vector<std::unique_ptr<StylusBall>> balls_;  ///< of each stylus; null if it has none
  double dt_;                                       ///< of a step [s]
  std::uint64_t steps_ = 0;                         ///< begun since the start or the last reset
  std::vector<Shape> shapes_;
  std::vector<ContactBody> bodies_;  ///< of each object
  std::vector<std::unique_ptr<ContactPair>> pairs_;
  std::vector<char> suspended_;  ///< of each pair: not 0 if it was suspended in the last step
  std::vector<int> leader_;      ///< of each object: the least number in its island
  std::unique_ptr<ContactIsland> island_;
  std::vector<int> members_;
  std::vector<IslandContact> contacts_;
  std::vector<IslandContact> solved_;    ///< of the step, all islands
  std::vector<BodyContactRecord> held_;  ///< of objects that are asleep
};

}  // namespace irdm
