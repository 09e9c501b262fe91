#include "simulation/engine/modal_horizon.hpp"

#include <algorithm>

namespace irdm {
namespace {

// Modes at a time: their products stay in the first level of the cache.
constexpr std::size_t kPart = 256;

bool same(const ContactPatch& a, const ContactPatch& b) noexcept {
  return a.count == b.count &&
         std::equal(a.nodes.begin(), a.nodes.begin() + a.count, b.nodes.begin()) &&
         std::equal(a.weights.begin(), a.weights.begin() + a.count, b.weights.begin());
}

Vector3 vector(const CourseSums<3>& sums, std::size_t n) noexcept {
  return {sums[0][n], sums[1][n], sums[2][n]};
}

}  // namespace

ModalHorizon::ModalHorizon(std::size_t modes)
    : kernels_(course_kernels()[0]),
      modes_(modes),
      decrements_(kCourse * kBlocks * modes),
      increments_(kCourse * kBlocks * modes),
      first_decrement_(modes),
      ends_(2 * kMaxHorizon * modes),
      compliance_(modes),
      products_(12 * kPart),
      factors_(kPart) {
  for (Contact& contact : contacts_) contact.shapes.assign(3 * modes, 0.0);
}

void ModalHorizon::set_transitions(const Transitions& A, const double* omega) noexcept {
  forget();
  double* const before = products_.data();
  double* const coordinate = before + kPart;
  double* const velocity = coordinate + kPart;
  for (std::size_t first = 0; first < modes_; first += kPart) {
    const std::size_t count = std::min(kPart, modes_ - first);
    const Transitions of_part{A.a11 + first, A.a12 + first, A.a21 + first, A.a22 + first};
    for (const std::size_t from : {0, 1}) {  // a coordinate of 1, or a velocity
      std::fill_n(coordinate, count, from == 0 ? 1.0 : 0.0);
      std::fill_n(velocity, count, from == 0 ? 0.0 : 1.0);
      for (std::size_t n = 0; n < kBlocks * kCourse; ++n) {
        if (n < kMaxHorizon) {
          std::copy_n(coordinate, count, &ends_[(2 * n + from) * modes_ + first]);
        }
        std::copy_n(coordinate, count, before);
        transit(of_part, coordinate, velocity, coordinate, velocity, count);
        auto& changes = from == 0 ? decrements_ : increments_;
        float* const to = &changes[(n / kCourse * modes_ + first) * kCourse + n % kCourse];
        const double sign = from == 0 ? -1.0 : 1.0;
        for (std::size_t j = 0; j < count; ++j) {
          to[kCourse * j] = static_cast<float>(sign * (coordinate[j] - before[j]));
        }
        if (from != 0 || n != 0) continue;
        for (std::size_t j = 0; j < count; ++j) first_decrement_[first + j] = 1.0 - coordinate[j];
      }
    }
    for (std::size_t i = first; i < first + count; ++i) {
      compliance_[i] = 1.0 / (omega[i] * omega[i]);
    }
  }
}

void ModalHorizon::forget() noexcept {
  for (Contact& contact : contacts_) contact.patch.count = 0;
  for (Cross& cross : crosses_) cross.to = 0;
}

ModalHorizon::Contact* ModalHorizon::find(const ContactPatch& patch) noexcept {
  const auto found = std::find_if(contacts_.begin(), contacts_.end(),
                                  [&](const Contact& c) { return same(c.patch, patch); });
  return found == contacts_.end() ? nullptr : &*found;
}

bool ModalHorizon::keeps(const ContactPatch& patch, std::uint64_t number,
                         std::size_t steps) const noexcept {
  return std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) {
    return c.steps == steps && (c.state == number || goes_on(c, number)) && same(c.patch, patch);
  });
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
  return contact;
}

void ModalHorizon::update(Contact& contact, const State& state, std::size_t steps) noexcept {
  contact.used = state.number;
  if (contact.steps != steps) {
    contact.steps = steps;
    compute(contact, state, true);
  } else if (goes_on(contact, state.number)) {
    shift_path(contact, state);
  } else if (contact.state != state.number) {
    compute(contact, state, false);
  }
  contact.state = state.number;
}

void ModalHorizon::multiply_shapes(const Contact& contact, std::size_t first, std::size_t count,
                                   const double* factors, double* products) const noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    multiply(&contact.shapes[axis * modes_ + first], factors, products + axis * count, count);
  }
}

// Products of two shapes over omega^2: (0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2).
void ModalHorizon::square_shapes(const Contact& contact, std::size_t first, std::size_t count,
                                 double* products) noexcept {
  for (std::size_t j = 0; j < 3; ++j) {
    multiply(&contact.shapes[j * modes_ + first], &compliance_[first], factors_.data(), count);
    for (std::size_t k = 0; k <= j; ++k, products += count) {
      multiply(&contact.shapes[k * modes_ + first], factors_.data(), products, count);
    }
  }
}

// moves[n] = R[n] force of a modal force, n < steps.
void ModalHorizon::respond_to(const Contact& contact, const double* force, std::size_t steps,
                              Path& moves) noexcept {
  BlockSums<3> sums{};
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    multiply(force + i, &compliance_[i], factors_.data(), count);
    multiply_shapes(contact, i, count, factors_.data(), products_.data());
    for (std::size_t block = 0; kCourse * block < steps; ++block) {
      kernels_.add_three(decrements(block, i), products_.data(), count, sums[block]);
    }
  }
  for (std::size_t n = 0; n < steps; ++n) moves[n] = vector(sums[n / kCourse], n % kCourse);
}

// A force that goes on moves the place where a mode is at rest; it swings freely about that.
const double* ModalHorizon::relative_coordinate(const State& state, std::size_t first,
                                                std::size_t count) noexcept {
  const double* const coordinate = state.coordinate + first;
  if (state.force == nullptr) return coordinate;
  multiply(state.force + first, &compliance_[first], factors_.data(), count);
  for (std::size_t j = 0; j < count; ++j) factors_[j] = coordinate[j] - factors_[j];
  return factors_.data();
}

// The path, each place from the one before, and the response,
// R[n] = Phi diag((c_n - c_{n+1}) / omega^2) Phi^T.
void ModalHorizon::compute(Contact& contact, const State& state, bool respond) noexcept {
  const std::size_t steps = contact.steps;
  BlockSums<3> decrease{};
  BlockSums<3> increase{};
  BlockSums<6> compliances{};
  Sums<6> first{};
  contact.path[0].setZero();
  double* const coordinates = products_.data() + 6 * kPart;
  double* const velocities = products_.data() + 9 * kPart;
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      contact.path[0][axis] += dot(&contact.shapes[static_cast<std::size_t>(axis) * modes_ + i],
                                   state.coordinate + i, count);
    }
    multiply_shapes(contact, i, count, relative_coordinate(state, i, count), coordinates);
    multiply_shapes(contact, i, count, state.velocity + i, velocities);
    for (std::size_t block = 0; kCourse * block + 1 < steps; ++block) {
      kernels_.add_three(decrements(block, i), coordinates, count, decrease[block]);
      kernels_.add_three(increments(block, i), velocities, count, increase[block]);
    }
    if (!respond) continue;
    square_shapes(contact, i, count, products_.data());
    const Sums<6> part = dot_six(&first_decrement_[i], products_.data(), count);
    for (std::size_t k = 0; k < 6; ++k) first[k] += part[k];
    for (std::size_t block = 0; kCourse * block < steps; ++block) {
      kernels_.add_six(decrements(block, i), products_.data(), count, compliances[block]);
    }
  }
  for (std::size_t n = 0; n + 1 < steps; ++n) {
    const std::size_t block = n / kCourse;
    contact.path[n + 1] = contact.path[n] + vector(increase[block], n % kCourse) -
                          vector(decrease[block], n % kCourse);
  }
  for (std::size_t n = 0; respond && n < steps; ++n) {
    const auto r = [&](std::size_t k) {
      return n == 0 ? first[k] : compliances[n / kCourse][k][n % kCourse];
    };
    contact.response[n] << r(0), r(1), r(3), r(1), r(2), r(4), r(3), r(4), r(5);
  }
}

// Not from the place before: rounding would add up from step to step.
Vector3 ModalHorizon::end_of_path(const Contact& contact, const State& state) noexcept {
  const double* const c = &ends_[2 * (contact.steps - 1) * modes_];
  const double* const s = c + modes_;
  Vector3 end = Vector3::Zero();
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    const double* const about = relative_coordinate(state, i, count);
    double* const moved = products_.data();
    for (std::size_t j = 0; j < count; ++j) {
      const double rest = state.coordinate[i + j] - about[j];
      moved[j] = rest + c[i + j] * about[j] + s[i + j] * state.velocity[i + j];
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      end[axis] += dot(&contact.shapes[static_cast<std::size_t>(axis) * modes_ + i], moved, count);
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

// R_ab[n] is R_ba[n] transposed.
void ModalHorizon::cross_response(const Contact& to, const Contact& from,
                                  std::span<Matrix3> response) noexcept {
  Cross* kept = &crosses_[0];
  for (Cross& cross : crosses_) {
    const bool same = cross.to == to.made && cross.from == from.made;
    const bool turned = cross.to == from.made && cross.from == to.made;
    if ((same || turned) && cross.steps >= response.size()) {
      cross.used = ++asked_;
      for (std::size_t n = 0; n < response.size(); ++n) {
        response[n] = cross.response[n];
        if (turned) response[n].transposeInPlace();
      }
      return;
    }
    if (cross.used < kept->used) kept = &cross;
  }
  kept->to = to.made;
  kept->from = from.made;
  kept->used = ++asked_;
  kept->steps = response.size();
  compute(to, from, response);
  std::copy(response.begin(), response.end(), kept->response.begin());
}

void ModalHorizon::compute(const Contact& to, const Contact& from,
                           std::span<Matrix3> response) noexcept {
  std::array<BlockSums<3>, 3> sums{};
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      multiply(&from.shapes[axis * modes_ + i], &compliance_[i], factors_.data(), count);
      multiply_shapes(to, i, count, factors_.data(), products_.data());
      for (std::size_t block = 0; kCourse * block < response.size(); ++block) {
        kernels_.add_three(decrements(block, i), products_.data(), count, sums[axis][block]);
      }
    }
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      response[n].col(static_cast<Eigen::Index>(axis)) =
          vector(sums[axis][n / kCourse], n % kCourse);
    }
  }
}

void ModalHorizon::add_held(const Contact& contact, const double* force,
                            std::span<Vector3> path) noexcept {
  Path moves;
  respond_to(contact, force, path.size(), moves);
  Vector3 moved = Vector3::Zero();
  for (std::size_t n = 0; n < path.size(); ++n) path[n] += moved += moves[n];
}

}  // namespace irdm
