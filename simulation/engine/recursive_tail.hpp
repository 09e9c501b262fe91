#pragma once

#include <span>
#include <vector>

#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The steps s >= m of a compressed response: r shapes, the coordinate of each the sum of its
/// poles' states, which are advanced by one multiplication a step. What a force does here begins m
/// steps after it: the shapes' forces wait that long in a ring. Real-time safe after construction.
class RecursiveTail {
 public:
  /// @param response must outlive this
  explicit RecursiveTail(const CompressedResponse& response);

  std::size_t shape_count() const noexcept { return shapes_; }
  const float* shape_row(int dof) const noexcept {
    return response_->shapes.data() + static_cast<std::size_t>(dof) * shapes_;
  }
  /// Coordinates at the end of the last step, and of the coming one, on which the force of the
  /// coming step has no part. (r)
  const double* coordinate() const noexcept { return coordinate_.data(); }
  const double* coming() const noexcept { return coming_.data(); }

  /// Forces on the shapes: B^T f, (r).
  void collect(std::span<const NodalForce> forces, double* shape_force) const noexcept;
  void advance(std::span<const NodalForce> forces) noexcept;
  /// @param age 0 .. kMaxHorizon - 1
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept;
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

  /// Coordinates at the ends of the next steps one after the other, the first of them coming():
  /// @param held shape forces that act in all of them, (r)
  void begin_path() noexcept;
  void continue_path(const double* held) noexcept;
  const double* path() const noexcept { return path_.data(); }

  /// h_i[s], (r), for s <= kMaxHorizon; zero for s < m.
  const double* after(std::size_t s) const noexcept { return after_.data() + s * shapes_; }

 private:
  /// One step of the poles' states under shape forces that are m steps old; their coordinates.
  void step(std::vector<double>& real, std::vector<double>& imaginary, const double* force,
            double* coordinate) const noexcept;
  /// Shape forces of step k, in a ring of m.
  double* waiting(std::int64_t k) noexcept {
    return ring_.data() + static_cast<std::size_t>(k % delay_) * shapes_;
  }

  const CompressedResponse* response_;
  std::size_t shapes_;                   ///< r
  std::int64_t delay_;                   ///< m
  std::vector<std::size_t> first_pole_;  ///< (r + 1): poles of shape i are first_pole_[i] ..
  std::vector<double> pole_real_, pole_imaginary_, weight_real_, weight_imaginary_;  ///< (p)
  std::vector<double> real_, imaginary_;  ///< states of the poles at the end of the coming step
  std::vector<double> path_real_, path_imaginary_;
  std::vector<double> coordinate_, coming_, path_, shape_force_;
  std::vector<double> ring_;   ///< (m, r)
  std::vector<double> after_;  ///< (kMaxHorizon + 1, r)
  std::int64_t clock_ = 0;     ///< number of the coming step
  std::int64_t path_clock_ = 0;
};

}  // namespace irdm
