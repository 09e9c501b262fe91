#include "simulation/engine/modal_horizon.hpp"

#include <algorithm>

namespace irdm {
namespace {

template <typename Contacts>
auto find_patch(Contacts& contacts, const ContactPatch& patch) noexcept
    -> decltype(contacts.data()) {
  const auto found = std::find_if(contacts.begin(), contacts.end(),
                                  [&](const auto& c) { return c.patch == patch; });
  return found == contacts.end() ? nullptr : &*found;
}

Vector3 vector(const std::array<double, 3>& sums) noexcept {
  return {sums[0], sums[1], sums[2]};
}

}  // namespace

ModalHorizon::ModalHorizon(std::size_t modes)
    : add_three_(course_kernels()[0]),
      modes_(modes),
      stride_((modes + kCourseLanes - 1) / kCourseLanes * kCourseLanes),
      ends_(2 * kMaxHorizon * modes),
      compliance_(modes),
      trace_(kPart),
      determinant_(kPart),
      now_(kPart),
      next_(kPart),
      factors_(kPart),
      products_(3 * kPart) {
  static_assert(kPart % kCourseLanes == 0);
  for (Contact& contact : contacts_) contact.shapes.assign(3 * stride_, 0.0);
}

void ModalHorizon::set_transitions(const Transitions& A, const double* b1, const double* b2,
                                   const double* omega) noexcept {
  forget();
  A_ = A;
  b1_ = b1;
  b2_ = b2;
  for (const std::size_t from : {0, 1}) {  // a coordinate of 1, or a velocity
    const auto end = [&](std::size_t n) { return &ends_[(2 * n + from) * modes_]; };
    std::fill_n(end(0), modes_, from == 0 ? 1.0 : 0.0);
    for (std::size_t first = 0; first < modes_; first += kPart) {
      const std::size_t count = std::min(kPart, modes_ - first);
      const Transitions of_part{A.a11 + first, A.a12 + first, A.a21 + first, A.a22 + first};
      double* const velocity = next_.data();
      std::fill_n(velocity, count, from == 0 ? 0.0 : 1.0);
      for (std::size_t n = 0; n + 1 < kMaxHorizon; ++n) {
        transit(of_part, end(n) + first, velocity, end(n + 1) + first, velocity, count);
      }
    }
  }
  for (std::size_t i = 0; i < modes_; ++i) compliance_[i] = 1.0 / (omega[i] * omega[i]);
}

void ModalHorizon::forget() noexcept {
  for (Contact& contact : contacts_) contact.patch.count = 0;
  for (Cross& cross : crosses_) cross.to = 0;
}

const ModalHorizon::Contact* ModalHorizon::find(const ContactPatch& patch) const noexcept {
  return find_patch(contacts_, patch);
}

ModalHorizon::Contact* ModalHorizon::find(const ContactPatch& patch) noexcept {
  return find_patch(contacts_, patch);
}

bool ModalHorizon::keeps(const ContactPatch& patch, std::uint64_t number,
                         std::size_t steps) const noexcept {
  const Contact* const contact = find(patch);
  return contact != nullptr && contact->steps == steps &&
         (contact->state == number || goes_on(*contact, number));
}

bool ModalHorizon::keeps_response(const ContactPatch& patch, std::size_t steps) const noexcept {
  const Contact* const contact = find(patch);
  return contact != nullptr && contact->steps == steps;
}

const ModalHorizon::Contact* ModalHorizon::find_only(std::span<const NodalForce> forces,
                                                     Vector3& force) const noexcept {
  constexpr double kRounding = 1e-13;
  force.setZero();
  for (const NodalForce& nodal : forces) force += nodal.force;
  const double largest = kRounding * force.cwiseAbs().maxCoeff();
  for (const Contact& contact : contacts_) {
    const ContactPatch& patch = contact.patch;
    if (static_cast<std::size_t>(patch.count) != forces.size()) continue;
    bool all = true;
    for (std::size_t i = 0; i < forces.size() && all; ++i) {
      all = forces[i].node == patch.nodes[i] &&
            (forces[i].force - patch.weights[i] * force).cwiseAbs().maxCoeff() <= largest;
    }
    if (all) return &contact;
  }
  return nullptr;
}

ModalHorizon::Contact& ModalHorizon::begin(const ContactPatch& patch) noexcept {
  Contact& contact =
      *std::min_element(contacts_.begin(), contacts_.end(),
                        [](const Contact& a, const Contact& b) { return a.used < b.used; });
  contact.patch = patch;
  contact.made = ++made_;
  contact.steps = 0;
  contact.state = kNoPath;
  return contact;
}

void ModalHorizon::update(Contact& contact, const State& state, std::size_t steps) noexcept {
  contact.used = state.number;
  if (contact.steps != steps) find_response(contact, steps);
  if (goes_on(contact, state.number)) {
    shift_path(contact, state);
  } else if (contact.state != state.number) {
    find_path(contact, state, nullptr, std::span(contact.path).first(steps));
  }
  contact.state = state.number;
}

// Calls it with each part of the modes, whose traces and determinants are at hand then.
template <typename Function>
void ModalHorizon::for_parts(Function&& function) noexcept {
  for (std::size_t first = 0; first < modes_; first += kPart) {
    const Part part{first, std::min(kPart, modes_ - first)};
    for (std::size_t j = 0; j < part.count; ++j) {
      const std::size_t i = first + j;
      trace_[j] = A_.a11[i] + A_.a22[i];
      determinant_[j] = A_.a11[i] * A_.a22[i] - A_.a12[i] * A_.a21[i];
    }
    for (AlignedNumbers* of_part : {&trace_, &determinant_, &now_, &next_}) {
      std::fill(of_part->begin() + static_cast<std::ptrdiff_t>(part.count), of_part->end(), 0.0);
    }
    function(part);
  }
}

// Courses without a force, from where the modes are. @param coordinate (part.count)
void ModalHorizon::begin_free(const Part& part, const double* coordinate,
                              const double* velocity) noexcept {
  const double* const a11 = A_.a11 + part.first;
  const double* const a12 = A_.a12 + part.first;
  for (std::size_t j = 0; j < part.count; ++j) {
    now_[j] = coordinate[j];
    next_[j] = a11[j] * coordinate[j] + a12[j] * velocity[j];
  }
}

// Courses that a force during one step leaves; the end of that step comes first.
// @param force on the modes (part.count)
void ModalHorizon::begin_impulse(const Part& part, const double* force) noexcept {
  const double* const a11 = A_.a11 + part.first;
  const double* const a12 = A_.a12 + part.first;
  const double* const b1 = b1_ + part.first;
  const double* const b2 = b2_ + part.first;
  for (std::size_t j = 0; j < part.count; ++j) {
    now_[j] = b1[j] * force[j];
    next_[j] = (a11[j] * b1[j] + a12[j] * b2[j]) * force[j];
  }
}

// The same with a force that is held from now on, about where it takes the modes. It changes the
// end of the coming step by (b_1 - 1 / omega^2) f, and the velocity there by b_2 f.
void ModalHorizon::add_held(const Part& part, const double* force) noexcept {
  for (std::size_t j = 0; j < part.count; ++j) {
    const std::size_t i = part.first + j;
    const double moved = b1_[i] - compliance_[i];
    now_[j] += moved * force[j];
    next_[j] += (A_.a11[i] * moved + A_.a12[i] * b2_[i]) * force[j];
  }
}

// Of those that begin in now_ and next_.
void ModalHorizon::add_courses(const Part& part, const double* weights, std::size_t stride,
                               std::size_t steps, Sums& sums) noexcept {
  const std::size_t width = (part.count + kCourseLanes - 1) / kCourseLanes * kCourseLanes;
  add_three_({trace_.data(), determinant_.data(), now_.data(), next_.data()}, weights, stride,
             width, std::span(sums).first((steps + kCourse - 1) / kCourse * kCourse));
}

// moves[n] = R[n] force of a modal force, n < steps.
void ModalHorizon::respond_to(const Contact& contact, const double* force, std::size_t steps,
                              Path& moves) noexcept {
  Sums sums{};
  for_parts([&](const Part& part) {
    begin_impulse(part, force + part.first);
    add_courses(part, shape(contact, 0, part), stride_, steps, sums);
  });
  std::transform(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(steps), moves.begin(),
                 vector);
}

// A force that goes on moves the place where a mode is at rest; it swings freely about that.
const double* ModalHorizon::relative_coordinate(const State& state, const Part& part) noexcept {
  const double* const coordinate = state.coordinate + part.first;
  if (state.force == nullptr) return coordinate;
  for (std::size_t j = 0; j < part.count; ++j) {
    const std::size_t i = part.first + j;
    factors_[j] = coordinate[j] - compliance_[i] * state.force[i];
  }
  return factors_.data();
}

// With the rest q_0 of all that is held, the end of the coming step lies at q + b_1 f - q_0 from
// it.
void ModalHorizon::find_path(const Contact& contact, const State& state, const double* held,
                             std::span<Vector3> path) noexcept {
  Sums sums{};
  Vector3 rest = Vector3::Zero();
  for_parts([&](const Part& part) {
    begin_free(part, relative_coordinate(state, part), state.velocity + part.first);
    if (held != nullptr) add_held(part, held + part.first);
    add_courses(part, shape(contact, 0, part), stride_, path.size(), sums);
    if (state.force == nullptr && held == nullptr) return;
    for (std::size_t j = 0; j < part.count; ++j) {
      const std::size_t i = part.first + j;
      factors_[j] = compliance_[i] * ((state.force == nullptr ? 0.0 : state.force[i]) +
                                      (held == nullptr ? 0.0 : held[i]));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rest[static_cast<Eigen::Index>(axis)] +=
          dot(shape(contact, axis, part), factors_.data(), part.count);
    }
  });
  for (std::size_t n = 0; n < path.size(); ++n) path[n] = rest + vector(sums[n]);
}

// R[n] = Phi diag(x[n]) Phi^T, with the courses x that a force of 1 leaves.
void ModalHorizon::find_response(Contact& contact, std::size_t steps) noexcept {
  contact.steps = steps;
  contact.state = kNoPath;
  Sums first{};  // R_00, R_10, R_20
  Sums rest{};   // R_11, R_12, R_22
  for_parts([&](const Part& part) {
    begin_impulse(part, shape(contact, 0, part));
    add_courses(part, shape(contact, 0, part), stride_, contact.steps, first);
    std::fill_n(factors_.data(), part.count, 1.0);
    begin_impulse(part, factors_.data());
    const double* const y = shape(contact, 1, part);
    const double* const z = shape(contact, 2, part);
    multiply(y, y, products_.data(), part.count);
    multiply(y, z, products_.data() + kPart, part.count);
    multiply(z, z, products_.data() + 2 * kPart, part.count);
    add_courses(part, products_.data(), kPart, contact.steps, rest);
  });
  for (std::size_t n = 0; n < contact.steps; ++n) {
    const auto& [xx, xy, xz] = first[n];
    const auto& [yy, yz, zz] = rest[n];
    contact.response[n] << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
}

// Not from the place before: rounding would add up from step to step.
Vector3 ModalHorizon::end_of_path(const Contact& contact, const State& state) noexcept {
  const double* const c = &ends_[2 * (contact.steps - 1) * modes_];
  const double* const s = c + modes_;
  Vector3 end = Vector3::Zero();
  for (std::size_t first = 0; first < modes_; first += kPart) {
    const Part part{first, std::min(kPart, modes_ - first)};
    const double* const about = relative_coordinate(state, part);
    double* const moved = products_.data();
    for (std::size_t j = 0; j < part.count; ++j) {
      const std::size_t i = first + j;
      const double rest = state.coordinate[i] - about[j];
      moved[j] = rest + c[i] * about[j] + s[i] * state.velocity[i];
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      end[static_cast<Eigen::Index>(axis)] += dot(shape(contact, axis, part), moved, part.count);
    }
  }
  return end;
}

// The last step's force f adds R[n + 1] f to where the place is n + 1 steps on.
void ModalHorizon::shift_path(Contact& contact, const State& state) noexcept {
  auto& path = contact.path;
  const std::size_t steps = contact.steps;
  std::shift_left(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(steps), 1);
  if (state.only == &contact) {
    for (std::size_t n = 0; n + 1 < steps; ++n) {
      path[n] += contact.response[n + 1] * state.only_force;
    }
  } else if (state.last != nullptr) {
    Path moves;
    respond_to(contact, state.last, steps, moves);
    for (std::size_t n = 0; n + 1 < steps; ++n) path[n] += moves[n + 1];
  }
  path[steps - 1] = end_of_path(contact, state);
}

bool ModalHorizon::Cross::is_of(const Contact& a, const Contact& b,
                                std::size_t count) const noexcept {
  const bool same = to == a.made && from == b.made;
  const bool turned = to == b.made && from == a.made;
  return (same || turned) && steps >= count;
}

bool ModalHorizon::keeps_cross_response(const ContactPatch& to, const ContactPatch& from,
                                        std::size_t steps) const noexcept {
  const Contact* const one = find(to);
  const Contact* const other = find(from);
  return one != nullptr && other != nullptr &&
         std::any_of(crosses_.begin(), crosses_.end(),
                     [&](const Cross& cross) { return cross.is_of(*one, *other, steps); });
}

// R_ab[n] is R_ba[n] transposed.
void ModalHorizon::cross_response(const Contact& to, const Contact& from,
                                  std::span<Matrix3> response) noexcept {
  auto kept = std::find_if(crosses_.begin(), crosses_.end(), [&](const Cross& cross) {
    return cross.is_of(to, from, response.size());
  });
  if (kept == crosses_.end()) {
    kept = std::min_element(crosses_.begin(), crosses_.end(),
                            [](const Cross& a, const Cross& b) { return a.used < b.used; });
    kept->to = to.made;
    kept->from = from.made;
    kept->steps = response.size();
    find_cross_response(to, from, {kept->response.data(), kept->steps});
  }
  kept->used = ++asked_;
  const bool turned = kept->to != to.made;
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = kept->response[n];
    if (turned) response[n].transposeInPlace();
  }
}

void ModalHorizon::find_cross_response(const Contact& to, const Contact& from,
                                       std::span<Matrix3> response) noexcept {
  std::array<Sums, 3> sums{};
  for_parts([&](const Part& part) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      begin_impulse(part, shape(from, axis, part));
      add_courses(part, shape(to, 0, part), stride_, response.size(), sums[axis]);
    }
  });
  for (std::size_t n = 0; n < response.size(); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      response[n].col(static_cast<Eigen::Index>(axis)) = vector(sums[axis][n]);
    }
  }
}

}  // namespace irdm
