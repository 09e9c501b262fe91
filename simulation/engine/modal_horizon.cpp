#include "simulation/engine/modal_horizon.hpp"

#include <algorithm>

namespace irdm {
namespace {

// Modes at a time: what their products are multiplied with stays in the first level of the cache.
constexpr std::size_t kPart = 512;

bool same(const ContactPatch& a, const ContactPatch& b) noexcept {
  return a.count == b.count &&
         std::equal(a.nodes.begin(), a.nodes.begin() + a.count, b.nodes.begin()) &&
         std::equal(a.weights.begin(), a.weights.begin() + a.count, b.weights.begin());
}

template <std::size_t K>
Sums<K> dots(const double* a, const double* b, std::size_t n) noexcept {
  static_assert(K == 3 || K == 6);
  if constexpr (K == 3) {
    return dot_three(a, b, n);
  } else {
    return dot_six(a, b, n);
  }
}

Vector3 vector(const Sums<3>& sums) noexcept {
  return {sums[0], sums[1], sums[2]};
}

}  // namespace

ModalHorizon::ModalHorizon(std::size_t modes)
    : modes_(modes),
      from_(2 * (kMaxHorizon + 1) * modes),
      compliance_(modes),
      products_(6 * kPart),
      factors_(kPart) {
  for (Contact& contact : contacts_) contact.shapes.assign(3 * modes, 0.0);
}

void ModalHorizon::set_transitions(const Transitions& A, const double* omega) noexcept {
  const auto row = [&](std::size_t n, std::size_t from) { return &from_[(2 * n + from) * modes_]; };
  // How fast modes move is not kept: it is in the shapes of a contact that nobody needs any more.
  forget();
  double* const velocity = contacts_[0].shapes.data();
  for (std::size_t from = 0; from < 2; ++from) {
    std::fill_n(row(0, from), modes_, from == 0 ? 1.0 : 0.0);
    std::fill_n(velocity, modes_, from == 0 ? 0.0 : 1.0);
    for (std::size_t n = 0; n < kMaxHorizon; ++n) {
      transit(A, row(n, from), velocity, row(n + 1, from), velocity, modes_);
    }
  }
  for (std::size_t i = 0; i < modes_; ++i) compliance_[i] = 1.0 / (omega[i] * omega[i]);
}

void ModalHorizon::forget() noexcept {
  for (Contact& contact : contacts_) contact.patch.count = 0;
}

ModalHorizon::Contact* ModalHorizon::find(const ContactPatch& patch) noexcept {
  const auto found = std::find_if(contacts_.begin(), contacts_.end(),
                                  [&](const Contact& c) { return same(c.patch, patch); });
  return found == contacts_.end() ? nullptr : &*found;
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
  contact.steps = 0;
  return contact;
}

void ModalHorizon::update(Contact& contact, const State& state, std::size_t steps) noexcept {
  contact.used = state.number;
  if (contact.steps != steps) {
    contact.steps = steps;
    respond(contact);
    compute_path(contact, state, 0);
  } else if (contact.state % 2 == 0 && contact.state + 2 == state.number) {
    shift_path(contact, state);
  } else if (contact.state != state.number) {
    compute_path(contact, state, 0);
  }
  contact.state = state.number;
}

// sums[m] = sum_i c_m[i] products[k][i] for m = first..last.
// @param products writes those of some modes, (K, count)
template <std::size_t K, typename Products>
void ModalHorizon::sum_free(std::size_t first, std::size_t last, const Products& products,
                            std::array<Sums<K>, kMaxHorizon + 1>& sums) noexcept {
  for (std::size_t m = first; m <= last; ++m) sums[m].fill(0.0);
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    products(i, count, products_.data());
    for (std::size_t m = first; m <= last; ++m) {
      const Sums<K> part = dots<K>(from_coordinate(m) + i, products_.data(), count);
      for (std::size_t k = 0; k < K; ++k) sums[m][k] += part[k];
    }
  }
}

void ModalHorizon::multiply_shapes(const Contact& contact, std::size_t first, std::size_t count,
                                   const double* factors, double* products) const noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    multiply(&contact.shapes[axis * modes_ + first], factors, products + axis * count, count);
  }
}

// R[n] = Phi diag((c_n - c_{n+1}) / omega^2) Phi^T.
void ModalHorizon::respond(Contact& contact) noexcept {
  const auto products = [&](std::size_t first, std::size_t count, double* to) {
    for (std::size_t j = 0; j < 3; ++j) {
      multiply(&contact.shapes[j * modes_ + first], &compliance_[first], factors_.data(), count);
      for (std::size_t k = 0; k <= j; ++k, to += count) {
        multiply(&contact.shapes[k * modes_ + first], factors_.data(), to, count);
      }
    }
  };
  std::array<Sums<6>, kMaxHorizon + 1> free;
  sum_free<6>(0, contact.steps, products, free);
  for (std::size_t n = 0; n < contact.steps; ++n) {
    Sums<6> r;
    for (std::size_t k = 0; k < 6; ++k) r[k] = free[n][k] - free[n + 1][k];
    contact.response[n] << r[0], r[1], r[3], r[1], r[2], r[4], r[3], r[4], r[5];
  }
}

// A force that goes on moves the place where a mode is at rest; about that it swings freely.
void ModalHorizon::compute_path(Contact& contact, const State& state, std::size_t first) noexcept {
  Vector3 rest = Vector3::Zero();
  std::fill(contact.path.begin() + static_cast<std::ptrdiff_t>(first),
            contact.path.begin() + static_cast<std::ptrdiff_t>(contact.steps), Vector3::Zero());
  double* const velocities = products_.data() + 3 * kPart;
  for (std::size_t i = 0; i < modes_; i += kPart) {
    const std::size_t count = std::min(kPart, modes_ - i);
    const double* swing = state.coordinate + i;
    if (state.force != nullptr) {
      multiply(state.force + i, &compliance_[i], factors_.data(), count);
      multiply_shapes(contact, i, count, factors_.data(), products_.data());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t j = 0; j < count; ++j) {
          rest[static_cast<Eigen::Index>(axis)] += products_[axis * count + j];
        }
      }
      for (std::size_t j = 0; j < count; ++j) factors_[j] = state.coordinate[i + j] - factors_[j];
      swing = factors_.data();
    }
    multiply_shapes(contact, i, count, swing, products_.data());
    multiply_shapes(contact, i, count, state.velocity + i, velocities);
    for (std::size_t n = first; n < contact.steps; ++n) {
      contact.path[n] += vector(dot_three(from_coordinate(n) + i, products_.data(), count)) +
                         vector(dot_three(from_velocity(n) + i, velocities, count));
    }
  }
  for (std::size_t n = first; n < contact.steps; ++n) contact.path[n] += rest;
}

// The last step's force f adds R[n + 1] f to where the place is n + 1 steps on.
void ModalHorizon::shift_path(Contact& contact, const State& state) noexcept {
  auto& path = contact.path;
  std::shift_left(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(contact.steps), 1);
  if (state.only == &contact) {
    for (std::size_t n = 0; n + 1 < contact.steps; ++n) {
      path[n] += contact.response[n + 1] * state.only_force;
    }
  } else if (state.last != nullptr) {
    const auto products = [&](std::size_t first, std::size_t count, double* to) {
      multiply(state.last + first, &compliance_[first], factors_.data(), count);
      multiply_shapes(contact, first, count, factors_.data(), to);
    };
    std::array<Sums<3>, kMaxHorizon + 1> free;
    sum_free<3>(1, contact.steps, products, free);
    for (std::size_t n = 0; n + 1 < contact.steps; ++n) {
      path[n] += vector(free[n + 1]) - vector(free[n + 2]);
    }
  }
  compute_path(contact, state, contact.steps - 1);
}

void ModalHorizon::add_held(const Contact& contact, const double* force,
                            std::span<Vector3> path) noexcept {
  const auto products = [&](std::size_t first, std::size_t count, double* to) {
    multiply(force + first, &compliance_[first], factors_.data(), count);
    multiply_shapes(contact, first, count, factors_.data(), to);
  };
  std::array<Sums<3>, kMaxHorizon + 1> free;
  sum_free<3>(0, path.size(), products, free);
  for (std::size_t n = 0; n < path.size(); ++n) path[n] += vector(free[0]) - vector(free[n + 1]);
}

}  // namespace irdm
