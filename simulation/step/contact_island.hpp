#pragma once

#include <span>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "simulation/step/body_contacts.hpp"
#include "simulation/step/soft_object.hpp"

namespace irdm {

/// A contact between bodies, as one of an island.
struct IslandContact {
  BodyContacts* pair = nullptr;
  int i = 0;  ///< number in the pair
  Friction friction;
  ContactConstraint solved = {};  ///< written, W
};

/// The contact problem of objects that touch each other, or scenery, in one step: one for the
/// contacts of all of them with styluses, floor, scenery and each other, in W. Its compliance is
/// that of every object: R[0] and rigid mobility, turned as the object stands half-way through the
/// step; between two contacts it is the sum over the objects that both are on. Real-time safe after
/// construction.
class ContactIsland {
 public:
  /// @param capacity contacts at most, those of the objects' own problems included
  ContactIsland(int object_count, int capacity);

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
  void add_object(SoftObject& object, const PatchCompliance& compliance, int first,
                  std::span<const Side> sides) noexcept;
  void take_back(SoftObject& object, int first, std::span<const Side> sides) noexcept;
  void collect_sides(int object, std::span<const IslandContact> contacts, int first) noexcept;

  ContactProblem problem_;
  ContactSolver solver_;
  std::vector<int> first_;   ///< row of the first own contact of each object
  std::vector<Side> sides_;  ///< of the object under way
};

}  // namespace irdm
