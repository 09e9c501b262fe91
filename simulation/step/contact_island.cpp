#include "simulation/step/contact_island.hpp"

namespace irdm {
namespace {

// The iteration goes on from the forces of the last step. An error of 1 um in each step would
// excite the oscillation that kYielding is against, faster than it dies.
constexpr SolverLimits kLimits{200, 1e-8, 60, 1e-7, 1e-4, 0};

// Contacts between bodies yield by this share of the rigid mobility besides. Without it bodies that
// rest on each other keep an oscillation in which the velocity changes its sign each step and the
// position stays: the gap at the end of a step does not see it. With k = 2 M / (share dt^2) in
// series its amplitude falls by 0.57 a step (eigenvalues of the step of a mass M on a spring k).
// The gap that a force f leaves open is share dt^2 f / 2M: of second order in dt, 2 um under its
// own weight at 2 ms.
constexpr double kYielding = 0.1;

constexpr Friction kNoFriction{0.0, 0.0};

}  // namespace

ContactIsland::ContactIsland(int object_count, int capacity, int sides, int groups)
    : problem_(capacity), solver_(capacity), first_(static_cast<std::size_t>(object_count), 0) {
  // Each made in its place: a copy has no memory in reserve.
  compliances_.reserve(first_.size());
  for (int i = 0; i < object_count; ++i) compliances_.emplace_back(sides);
  groups_.reserve(static_cast<std::size_t>(groups));
  sides_.reserve(static_cast<std::size_t>(sides));
  places_.reserve(static_cast<std::size_t>(sides));
}

void ContactIsland::collect_sides(int object, std::span<const IslandContact> contacts,
                                  int first) noexcept {
  sides_.clear();
  places_.clear();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactPair::Contact& contact = contacts[c].pair->contact(contacts[c].i);
    const int row = first + static_cast<int>(c);
    const bool ours = contacts[c].pair->object() == object;
    if (ours) {
      sides_.push_back({row, 1.0, &contact.place, contact.arm});
      places_.push_back({2 * contacts[c].key, contact.place});
    }
    if (contacts[c].pair->other() == object) {
      // Of an object with itself both forces act at one point of the body.
      sides_.push_back({row, -1.0, &contact.other_place, ours ? contact.arm : contact.other_arm});
      places_.push_back({2 * contacts[c].key + 1, contact.other_place});
    }
  }
}

// What one object adds to the compliance: that of its own contacts, and between them and its sides.
void ContactIsland::add_own(SoftObject& object, int first) noexcept {
  const Matrix3 Q = object.motion().halfway.toRotationMatrix();
  const ContactProblem& own = object.problem();
  const RigidMobility mobility = object.rigid().mobility();
  for (int a = 0; a < own.count(); ++a) {
    for (int b = 0; b < own.count(); ++b) {
      problem_.elastic(first + a, first + b) = Q * own.compliance(a, b) * Q.transpose();
    }
    for (const Side& side : sides_) {
      const Matrix3 shared =
          side.sign * Q *
          (object.compliance_at(a, *side.place) + mobility.between(own.contact(a).arm, side.arm)) *
          Q.transpose();
      problem_.elastic(first + a, side.row) += shared;
      problem_.elastic(side.row, first + a) += shared.transpose();
    }
  }
}

// The same between its sides.
void ContactIsland::add_sides(const SoftObject& object, SideCompliance& compliance) noexcept {
  compliance.update(places_, object.contact_compliance());
  const Matrix3 Q = object.motion().halfway.toRotationMatrix();
  RigidMobility mobility = object.rigid().mobility();
  mobility.translation *= 1.0 + kYielding;
  mobility.rotation *= 1.0 + kYielding;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const Side& to = sides_[i];
    const Matrix3 turn = skew(to.arm) * mobility.rotation;
    const Matrix3 Q_to = to.sign * Q;
    for (std::size_t j = 0; j <= i; ++j) {
      const Side& from = sides_[j];
      Matrix3 within = compliance.between(i, j) - turn * skew(from.arm);
      within.diagonal().array() += mobility.translation;
      const Matrix3 shared = from.sign * (Q_to * within * Q.transpose());
      problem_.elastic(to.row, from.row) += shared;
      if (i != j) problem_.elastic(from.row, to.row) += shared.transpose();
    }
  }
}

// Adds the compliance of the springs of balls: a force at one contact of a ball moves all of them.
void ContactIsland::add_springs(std::span<const IslandContact> contacts,
                                int first_between) noexcept {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactPair& pair = *contacts[c].pair;
    if (pair.spring_compliance() <= 0.0) continue;
    for (std::size_t d = 0; d < contacts.size(); ++d) {
      if (contacts[d].pair->other() != pair.other()) continue;
      problem_.elastic(first_between + static_cast<int>(c), first_between + static_cast<int>(d))
          .diagonal()
          .array() += pair.spring_compliance();
    }
  }
}

// Contacts of a pair follow one another in the list. Those that were not pressed in the last step
// share no friction yet.
void ContactIsland::find_groups(std::span<const IslandContact> contacts) noexcept {
  groups_.clear();
  for (std::size_t c = 0; c < contacts.size();) {
    const ContactPair* const pair = contacts[c].pair;
    Group group{static_cast<int>(c), 0, 0, 0.0};
    for (; c < contacts.size() && contacts[c].pair == pair; ++c) {
      ++group.count;
      group.weight += pair->friction_weight(contacts[c].i);
    }
    const Friction& friction = contacts[static_cast<std::size_t>(group.first)].friction;
    if (pair->shares_friction() && group.weight > 0.0 && friction.static_ > 0.0) {
      groups_.push_back(group);
    }
  }
}

double ContactIsland::share(const Group& group, std::span<const IslandContact> contacts,
                            int i) noexcept {
  const IslandContact& contact = contacts[static_cast<std::size_t>(group.first + i)];
  return contact.pair->friction_weight(contact.i) / group.weight;
}

// The friction of a group acts on each of its contacts with their shares, so its row of the problem
// is the mean of theirs.
void ContactIsland::pose_friction(std::span<const IslandContact> contacts,
                                  int first_between) noexcept {
  for (const Group& group : groups_) {
    const IslandContact& first = contacts[static_cast<std::size_t>(group.first)];
    ContactConstraint& posed = problem_.contact(group.row);
    first.pair->pose_friction(first.friction, posed);
    posed.law = ContactLaw::kGroupFriction;
    posed.group_first = first_between + group.first;
    posed.group_count = group.count;
    posed.gap.setZero();
    for (int i = 0; i < group.count; ++i) {
      const int member = posed.group_first + i;
      const double part = share(group, contacts, i);
      if (part == 0.0) continue;
      posed.gap += part * problem_.contact(member).gap;
      for (int row = 0; row < group.row; ++row) {
        problem_.elastic(group.row, row) += part * problem_.elastic(member, row);
      }
    }
    for (int row = 0; row < group.row; ++row) {
      problem_.elastic(row, group.row) = problem_.elastic(group.row, row).transpose();
    }
    for (int i = 0; i < group.count; ++i) {
      problem_.elastic(group.row, group.row) +=
          share(group, contacts, i) * problem_.elastic(posed.group_first + i, group.row);
    }
  }
}

// Gives each contact its share of the friction that was found.
void ContactIsland::spread_friction(std::span<const IslandContact> contacts, int first_between,
                                    bool solved) noexcept {
  for (const Group& group : groups_) {
    const ContactConstraint& friction = problem_.contact(group.row);
    for (int i = 0; i < group.count; ++i) {
      ContactConstraint& member = problem_.contact(first_between + group.first + i);
      member.shared = share(group, contacts, i) * friction.force;
      member.force += member.shared;
      member.slip = friction.slip;
      member.mode = member.force.isZero(0.0) ? ContactMode::kOpen : friction.mode;
    }
    if (solved) contacts[static_cast<std::size_t>(group.first)].pair->take_friction(friction);
  }
  for (const Group& group : groups_) find_apart(group, contacts, first_between);
}

// Only the mean of a group is held: what single contacts leave open beside it is not to become a
// gap of the mean when the shares change.
void ContactIsland::find_apart(const Group& group, std::span<const IslandContact> contacts,
                               int first_between) noexcept {
  const int rows = first_between + static_cast<int>(contacts.size());
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < group.count; ++i) {
    ContactConstraint& member = problem_.contact(first_between + group.first + i);
    member.apart = member.gap;
    for (int row = 0; row < rows; ++row) {
      const Vector3& force = problem_.contact(row).force;
      if (force.isZero(0.0)) continue;
      member.apart -= problem_.elastic(first_between + group.first + i, row) * force;
    }
    mean += share(group, contacts, i) * member.apart;
  }
  for (int i = 0; i < group.count; ++i) {
    ContactConstraint& member = problem_.contact(first_between + group.first + i);
    member.apart -= mean;
    member.apart -= member.apart.dot(member.normal) * member.normal;
  }
}

// The own contacts' solution, and what the contacts between bodies do to them.
void ContactIsland::take_back(SoftObject& object, int first, std::span<IslandContact> contacts,
                              int first_between) noexcept {
  const Matrix3 to_body = object.motion().halfway.toRotationMatrix().transpose();
  const RigidMobility mobility = object.rigid().mobility();
  Vector3 push = Vector3::Zero();
  Vector3 turn = Vector3::Zero();
  for (const Side& side : sides_) {
    const Vector3 force = side.sign * (to_body * problem_.contact(side.row).force);
    push += force;
    turn += side.arm.cross(force);
  }
  for (const Side& side : sides_) {
    const Vector3 moved = mobility.translation * push - side.arm.cross(mobility.rotation * turn);
    contacts[static_cast<std::size_t>(side.row - first_between)].yielded +=
        kYielding * side.sign * (to_body.transpose() * moved);
  }
  ContactProblem& own = object.problem();
  for (int a = 0; a < own.count(); ++a) {
    const ContactConstraint& solved = problem_.contact(first + a);
    ContactConstraint& contact = own.contact(a);
    contact.force = to_body * solved.force;
    contact.slip = to_body * solved.slip;
    contact.mode = solved.mode;
    contact.friction = solved.friction;
    Vector3 moved = Vector3::Zero();
    for (const Side& side : sides_) {
      moved += problem_.elastic(first + a, side.row) * problem_.contact(side.row).force;
    }
    moved = to_body * moved;
    contact.gap -= moved;
    contact.elsewhere =
        moved - (mobility.translation * push - contact.arm.cross(mobility.rotation * turn));
  }
}

ContactSolution ContactIsland::solve(std::span<SoftObject* const> objects,
                                     std::span<const int> members,
                                     std::span<IslandContact> contacts) noexcept {
  int rows = 0;
  for (const int member : members) {
    first_[static_cast<std::size_t>(member)] = rows;
    rows += objects[static_cast<std::size_t>(member)]->problem().count();
  }
  const int first_between = rows;
  rows += static_cast<int>(contacts.size());
  find_groups(contacts);
  for (Group& group : groups_) group.row = rows++;
  problem_.begin(rows);
  problem_.rigid = {};
  problem_.clear_elastic();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const bool shared = contacts[c].pair->shares_friction();
    contacts[c].pair->pose(contacts[c].i, shared ? kNoFriction : contacts[c].friction,
                           problem_.contact(first_between + static_cast<int>(c)));
  }
  for (const int member : members) {
    SoftObject& object = *objects[static_cast<std::size_t>(member)];
    const int first = first_[static_cast<std::size_t>(member)];
    const Matrix3 Q = object.motion().halfway.toRotationMatrix();
    for (int a = 0; a < object.problem().count(); ++a) {
      ContactConstraint& posed = problem_.contact(first + a);
      posed = object.problem().contact(a);
      posed.normal = Q * posed.normal;
      posed.gap = Q * posed.gap;
      posed.force = Q * posed.force;
      posed.arm.setZero();
    }
    collect_sides(member, contacts, first_between);
    add_own(object, first);
    add_sides(object, compliances_[static_cast<std::size_t>(member)]);
  }
  add_springs(contacts, first_between);
  pose_friction(contacts, first_between);
  const ContactSolution solution = solver_.solve(problem_, kLimits);
  spread_friction(contacts, first_between, solution.solved);
  for (const int member : members) {
    collect_sides(member, contacts, first_between);
    take_back(*objects[static_cast<std::size_t>(member)], first_[static_cast<std::size_t>(member)],
              contacts, first_between);
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    contacts[c].solved = problem_.contact(first_between + static_cast<int>(c));
    contacts[c].found = solution.solved;
  }
  return solution;
}

}  // namespace irdm
