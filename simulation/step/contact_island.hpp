#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "simulation/step/body_contacts.hpp"
#include "simulation/step/side_compliance.hpp"
#include "simulation/step/soft_object.hpp"

namespace irdm {

/// A contact between bodies, as one of an island.
struct IslandContact {
  ContactPair* pair = nullptr;
  int i = 0;              ///< number in the pair
  std::uint64_t key = 0;  ///< of pair and sample: the same in the next step, increasing in a list
  Friction friction;
  ContactConstraint solved = {};      ///< written, W
  bool found = true;                  ///< written: false if the problem had no solution
  Vector3 yielded = Vector3::Zero();  ///< written: what of the gap it leaves [m], W
};

/// The contact problem of objects that touch each other, or scenery, in one step: one for the
/// contacts of all of them with styluses, floor, scenery and each other, in W. Its compliance is
/// that of every object: R[0] and rigid mobility, turned as the object stands half-way through the
/// step; between two contacts it is the sum over the objects that both are on. Real-time safe after
/// construction.
class ContactIsland {
 public:
  /// @param capacity contacts at most, those of the objects' own problems and one for the friction
  /// of each group included
  /// @param sides of contacts between bodies that one object can have
  /// @param groups pairs that share their friction, at most
  ContactIsland(int object_count, int capacity, int sides, int groups);

  int capacity() const noexcept { return problem_.capacity(); }
  /// Solves it; the objects' own problems and `contacts` have the solution then.
  /// @param objects of the scene  @param members which of them are in the island
  ContactSolution solve(std::span<SoftObject* const> objects, std::span<const int> members,
                        std::span<IslandContact> contacts) noexcept;

 private:
  /// One side of a contact between bodies, on a certain object.
  struct Side {
    int row = 0;
    double sign = 1.0;  ///< of the constraint's force there
    const PatchCompliance::Place* place = nullptr;
    Vector3 arm = Vector3::Zero();  ///< [m], B
  };
  /// Contacts of a pair that share their friction.
  struct Group {
    int first = 0;  ///< number in the list of contacts
    int count = 0;
    int row = 0;          ///< of their friction
    double weight = 0.0;  ///< sum of ContactPair::friction_weight() [N]
  };
  /// Part of the friction of a group that acts on its contact i; the parts add up to 1.
  static double share(const Group& group, std::span<const IslandContact> contacts, int i) noexcept;
  void add_own(SoftObject& object, int first) noexcept;
  void add_sides(const SoftObject& object, SideCompliance& compliance) noexcept;
  void add_springs(std::span<const IslandContact> contacts, int first_between) noexcept;
  void find_groups(std::span<const IslandContact> contacts) noexcept;
  void find_apart(const Group& group, std::span<const IslandContact> contacts,
                  int first_between) noexcept;
  void pose_friction(std::span<const IslandContact> contacts, int first_between) noexcept;
  void spread_friction(std::span<const IslandContact> contacts, int first_between,
                       bool solved) noexcept;
  void take_back(SoftObject& object, int first, std::span<IslandContact> contacts,
                 int first_between) noexcept;
  void collect_sides(int object, std::span<const IslandContact> contacts, int first) noexcept;

  ContactProblem problem_;
  ContactSolver solver_;
  std::vector<int> first_;                   ///< row of the first own contact of each object
  std::vector<SideCompliance> compliances_;  ///< of each object
  std::vector<Group> groups_;
  // Of the object under way.
  std::vector<Side> sides_;
  std::vector<SideCompliance::Side> places_;
};

}  // namespace irdm
