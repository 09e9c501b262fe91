#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simulation/step/body_contacts.hpp"
#include "simulation/step/contact_island.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/soft_object.hpp"

namespace irdm {

/// Contacts of a scene's objects with each other, with scenery, and of parts of one object. In each
/// step objects that touch form islands, each of which is one contact problem. Real-time safe after
/// construction; one thread.
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
  /// Before SoftObject::begin(): scenery goes where it is at the end of the step.
  void move_scenery() noexcept;
  /// After SoftObject::begin() of all objects: solves their problems and writes the records, up to
  /// SoftObject::finish().
  void solve(StepRecord& record) noexcept;

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
  const Shape& shape_of(const SimulationConfig& config, SoftObject& object);
  int capacity(const SimulationConfig& config) const;
  void add_pairs(const SimulationConfig& config);
  void add_scenery(const SimulationConfig& config, int object, int scenery);
  void check_ball(const SimulationConfig& config, int object, int scenery) const;
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
  double dt_;                ///< of a step [s]
  std::uint64_t steps_ = 0;  ///< begun since the start or the last reset
  std::vector<Shape> shapes_;
  std::vector<ContactBody> bodies_;  ///< of each object
  std::vector<std::unique_ptr<ContactPair>> pairs_;
  std::vector<int> leader_;  ///< of each object: the least number in its island
  std::unique_ptr<ContactIsland> island_;
  std::vector<int> members_;
  std::vector<IslandContact> contacts_;
  std::vector<IslandContact> solved_;    ///< of the step, all islands
  std::vector<BodyContactRecord> held_;  ///< of objects that are asleep
};

}  // namespace irdm
