#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "common/model/model.hpp"

/// What a CompressedResponse says. Pure.
namespace irdm {

/// Entries that all pairs of n surface nodes have for one step.
constexpr std::size_t fir_entries(std::size_t nodes) {
  return nodes * (nodes + 1) / 2 * 9;
}

/// use(numbers, scale) for R[0..m-1](3 i + a, 3 j + b) = scale * numbers[0..m-1], the numbers being
/// float or std::int16_t. Real-time safe.
template <typename Use>
auto with_fir(const CompressedResponse& response, int i, int a, int j, int b,
              const Use& use) noexcept {
  const bool stored = i >= j;
  const auto row = static_cast<std::size_t>(stored ? i : j);
  const auto column = static_cast<std::size_t>(stored ? j : i);
  const std::size_t entry =
      (row * (row + 1) / 2 + column) * 9 + static_cast<std::size_t>(stored ? 3 * a + b : 3 * b + a);
  const std::size_t first = entry * static_cast<std::size_t>(response.fir_steps);
  const auto* const integers = std::get_if<std::vector<std::int16_t>>(&response.fir);
  if (integers != nullptr) {
    return use(integers->data() + first, static_cast<double>(response.fir_scale[entry]));
  }
  return use(std::get_if<std::vector<float>>(&response.fir)->data() + first, 1.0);
}

/// R[s](3 i + a, 3 j + b), s < m [m/N]. Real-time safe.
inline double fir_response(const CompressedResponse& response, int i, int a, int j, int b,
                           int s) noexcept {
  return with_fir(response, i, a, j, b, [s](const auto* numbers, double scale) {
    return scale * static_cast<double>(numbers[s]);
  });
}

/// h_i[s] for s = m .. m + steps - 1, (steps, r) [m/N].
RowMatrix<double> tail_responses(const CompressedResponse& response, int steps);

/// sum over all s >= m of h_i[s], (r) [m/N].
Eigen::VectorXd settled_tail_responses(const CompressedResponse& response);

}  // namespace irdm
