#include "simulation/engine/recursive_tail.hpp"

#include <algorithm>
#include <cmath>

#include "common/response/compressed_response.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

// A decaying state would end in denormal numbers, which cost a hundred times as much.
double at_rest_below(double value) {
  return std::abs(value) < 1e-100 ? 0.0 : value;
}

}  // namespace

RecursiveTail::RecursiveTail(const CompressedResponse& response)
    : response_(&response),
      shapes_(static_cast<std::size_t>(response.shape_count())),
      delay_(response.fir_steps) {
  const auto poles = static_cast<std::size_t>(response.pole_count());
  for (auto* values : {&pole_real_, &pole_imaginary_, &weight_real_, &weight_imaginary_, &real_,
                       &imaginary_, &path_real_, &path_imaginary_}) {
    values->assign(poles, 0.0);
  }
  first_pole_.assign(shapes_ + 1, 0);
  for (std::size_t j = 0; j < poles; ++j) {
    const auto index = static_cast<Eigen::Index>(j);
    pole_real_[j] = response.pole(index).real();
    pole_imaginary_[j] = response.pole(index).imag();
    weight_real_[j] = response.amplitude(index).real();
    weight_imaginary_[j] = response.amplitude(index).imag();
    ++first_pole_[static_cast<std::size_t>(response.pole_shape[j]) + 1];
  }
  for (std::size_t i = 0; i < shapes_; ++i) first_pole_[i + 1] += first_pole_[i];
  for (auto* values : {&coordinate_, &coming_, &path_, &shape_force_}) {
    values->assign(shapes_, 0.0);
  }
  ring_.assign(static_cast<std::size_t>(delay_) * shapes_, 0.0);
  after_.assign((kMaxHorizon + 1) * shapes_, 0.0);
  const int tail = kMaxHorizon + 1 - response.fir_steps;
  if (tail <= 0) return;
  const RowMatrix<double> h = tail_responses(response, tail);
  std::copy_n(h.data(), h.size(), after_.end() - h.size());
}

void RecursiveTail::step(std::vector<double>& real, std::vector<double>& imaginary,
                         const double* force, double* coordinate) const noexcept {
  for (std::size_t i = 0; i < shapes_; ++i) {
    double sum = 0.0;
    for (std::size_t j = first_pole_[i]; j < first_pole_[i + 1]; ++j) {
      const double x = real[j];
      const double y = imaginary[j];
      real[j] = at_rest_below(pole_real_[j] * x - pole_imaginary_[j] * y + force[i]);
      imaginary[j] = at_rest_below(pole_real_[j] * y + pole_imaginary_[j] * x);
      sum += weight_real_[j] * real[j] - weight_imaginary_[j] * imaginary[j];
    }
    coordinate[i] = sum;
  }
}

void RecursiveTail::collect(std::span<const NodalForce> forces,
                            double* shape_force) const noexcept {
  std::fill_n(shape_force, shapes_, 0.0);
  for (const NodalForce& nodal : forces) {
    const int dof = 3 * nodal.node;
    accumulate({nodal.force.x(), nodal.force.y(), nodal.force.z()}, shape_row(dof),
               shape_row(dof + 1), shape_row(dof + 2), shape_force, shapes_);
  }
}

void RecursiveTail::advance(std::span<const NodalForce> forces) noexcept {
  coordinate_.swap(coming_);
  collect(forces, waiting(clock_));
  ++clock_;
  step(real_, imaginary_, waiting(clock_), coming_.data());
}

void RecursiveTail::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  const std::int64_t then = clock_ - 1 - age;
  if (age < 0 || age >= kMaxHorizon || then < 0) return;
  collect(forces, shape_force_.data());
  const std::int64_t past = age + 1 - delay_;  // steps for which it has acted at the coming one
  if (past < 0) {
    double* force = waiting(then);
    for (std::size_t i = 0; i < shapes_; ++i) force[i] += shape_force_[i];
    return;
  }
  const double* now = after(static_cast<std::size_t>(age));
  const double* next = after(static_cast<std::size_t>(age) + 1);
  for (std::size_t i = 0; i < shapes_; ++i) {
    coordinate_[i] += now[i] * shape_force_[i];
    coming_[i] += next[i] * shape_force_[i];
    for (std::size_t j = first_pole_[i]; j < first_pole_[i + 1]; ++j) {
      double x = shape_force_[i];
      double y = 0.0;
      for (std::int64_t s = 0; s < past; ++s) {
        const double turned = pole_real_[j] * x - pole_imaginary_[j] * y;
        y = pole_real_[j] * y + pole_imaginary_[j] * x;
        x = turned;
      }
      real_[j] += x;
      imaginary_[j] += y;
    }
  }
}

void RecursiveTail::begin_path() noexcept {
  std::copy(real_.begin(), real_.end(), path_real_.begin());
  std::copy(imaginary_.begin(), imaginary_.end(), path_imaginary_.begin());
  std::copy(coming_.begin(), coming_.end(), path_.begin());
  path_clock_ = clock_;
}

void RecursiveTail::continue_path(const double* held) noexcept {
  ++path_clock_;
  // What began to act after the last step is not in the ring: it is held.
  const bool begun = path_clock_ - delay_ >= clock_;
  step(path_real_, path_imaginary_, begun ? held : waiting(path_clock_), path_.data());
}

void RecursiveTail::archive(StateArchive& state) {
  for (auto* values : {&real_, &imaginary_, &coordinate_, &coming_, &ring_}) state.values(*values);
  state.value(clock_);
}

void RecursiveTail::reset() noexcept {
  for (auto* values : {&real_, &imaginary_, &coordinate_, &coming_, &ring_}) {
    std::fill(values->begin(), values->end(), 0.0);
  }
  clock_ = 0;
}

}  // namespace irdm
