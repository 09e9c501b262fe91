#pragma once

#include <cstddef>

#include "common/model/model.hpp"

/// What a CompressedResponse says. Pure.
namespace irdm {

/// Entries that all pairs of n surface nodes have for one step.
constexpr std::size_t early_entries(std::size_t nodes) {
  return nodes * (nodes + 1) / 2 * 9;
}

/// R[0..m-1](3 i + a, 3 j + b), consecutive numbers. Real-time safe.
inline const float* early_response(const CompressedResponse& response, int i, int a, int j,
                                   int b) noexcept {
  const bool stored = i >= j;
  const auto row = static_cast<std::size_t>(stored ? i : j);
  const auto column = static_cast<std::size_t>(stored ? j : i);
  const std::size_t entry =
      (row * (row + 1) / 2 + column) * 9 + static_cast<std::size_t>(stored ? 3 * a + b : 3 * b + a);
  return response.early.data() + entry * static_cast<std::size_t>(response.early_steps);
}

/// h_i[s] for s = m .. m + steps - 1, (steps, r) [m/N].
RowMatrix<double> late_responses(const CompressedResponse& response, int steps);

/// sum over all s >= m of h_i[s], (r) [m/N].
Eigen::VectorXd settled_late_responses(const CompressedResponse& response);

/// R[0..steps-1](:, b), (steps, 3n) [m/N].
/// @param late at least steps - m rows of late_responses()
RowMatrix<double> compressed_column(const CompressedResponse& response,
                                    const RowMatrix<double>& late, int b, int steps);

}  // namespace irdm
