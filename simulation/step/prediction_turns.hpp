#pragma once

#include <algorithm>
#include <cstddef>

namespace irdm {

/// Which styluses get a contact model after a step: all whose model goes on from the last one, and
/// of the others, in turns, what the step has time for. A bridge goes on with its last model
/// meanwhile. Pure, real-time safe.
class PredictionTurns {
 public:
  /// Step that has time for a computation that takes long (Simulation::predict_horizon()) [s].
  static constexpr double kTime = 1e-3;

  /// @param dt of a step [s]
  explicit PredictionTurns(double dt) noexcept
      : budget_(std::max(1, static_cast<int>(dt / kTime + 1e-6))) {}

  /// @param predict bool(std::size_t s, int& budget), for each stylus s: whether there is a model
  template <typename Predict>
  void step(std::size_t styluses, const Predict& predict) noexcept {
    int budget = budget_;
    const std::size_t first = next_;
    for (std::size_t i = 0; i < styluses; ++i) {
      const std::size_t s = (first + i) % styluses;
      const int left = budget;
      if (predict(s, budget) && budget < left) next_ = (s + 1) % styluses;
    }
  }

 private:
  int budget_;
  std::size_t next_ = 0;
};

}  // namespace irdm
