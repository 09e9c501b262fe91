#include "simulation/engine/resident_columns.hpp"

#include <omp.h>

#include <algorithm>

#include "simulation/engine/nonzero_intervals.hpp"

namespace irdm {

std::size_t row_block(std::size_t dof) {
  const auto pieces = 4 * static_cast<std::size_t>(omp_get_max_threads());
  return std::clamp<std::size_t>(dof / pieces / 4 * 4, 64, 256);
}

template <typename Number>
void ResidentColumns<Number>::convolve(const ForceHistory& history, int node, int shift,
                                       Vector3& u) const noexcept {
  for (const int source : history.active()) {
    for (int b = 3 * source; b < 3 * source + 3; ++b) {
      add_convolution(*this, history, b, 1.0, node, shift, u);
    }
  }
}

// Column after column, as R stands in memory: a thread reads its part of each of them from one end
// to the other. Each degree of freedom gets its sums in the same order, whichever thread adds them.
template <typename Number>
void ResidentColumns<Number>::add_all(const ForceHistory& history, Points& u) const {
  const std::vector<NonzeroInterval> stretches = nonzero_intervals(history);
  const std::size_t rows_at_once = row_block(dof);
  const auto blocks = static_cast<int>((dof + rows_at_once - 1) / rows_at_once);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t first = static_cast<std::size_t>(block) * rows_at_once;
    const std::size_t count = std::min(rows_at_once, dof - first);
    for (const NonzeroInterval& push : stretches) {
      const Number* rows = values + (push.column * dof + first) * steps + push.first_age;
      add_products({rows, steps, count}, push.force, push.count, 1.0, u.data() + first);
    }
  }
}

template struct ResidentColumns<float>;
template struct ResidentColumns<double>;

}  // namespace irdm
