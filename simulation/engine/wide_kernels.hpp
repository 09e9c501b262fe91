#pragma once

#include "simulation/engine/kernels.hpp"

namespace irdm {

/// Those functions of kernels.hpp that have several sums at a time, for registers of one width.
struct WideKernels {
  Sums<3> (*dot_three)(const double*, const double*, std::size_t) noexcept;
  Sums<6> (*dot_six)(const double*, const double*, std::size_t) noexcept;
  Sums<9> (*moments)(const double*, const double*, const double*, std::size_t) noexcept;
  Sums<9> (*cross_moments)(const double*, const double*, const double*, std::size_t) noexcept;
  void (*add_ahead_single)(const NodeRows<float>&, std::span<const double>, double,
                           const std::array<double*, 3>&) noexcept;
  void (*add_ahead_double)(const NodeRows<double>&, std::span<const double>, double,
                           const std::array<double*, 3>&) noexcept;
  void (*add_effect_single)(const NodeColumns<float>&, const std::array<double, 3>&,
                            const std::array<double*, 3>&, std::size_t) noexcept;
  void (*add_effect_double)(const NodeColumns<double>&, const std::array<double, 3>&,
                            const std::array<double*, 3>&, std::size_t) noexcept;
};

/// All sets that this processor can run; kernels.hpp's functions are those of the first. They give
/// the same bits.
std::span<const WideKernels> wide_kernels() noexcept;

}  // namespace irdm
