#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace irdm {

/// Modes that follow one another.
struct ModeRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Modes are kept or left out by so many at a time.
inline constexpr std::size_t kModeBlock = 64;

/// The modes that matter now: all but the weakest blocks, as many of them as together move no node
/// by more than the tolerance, since |u_a - sum over the kept q_i Phi_ai| is at most the sum of
/// |q_i| max_a |Phi_ai| over those left out. With tolerance 0 only what does not move is left out.
/// @param coordinate q (r) [kg^1/2 m]
/// @param largest_shape max_a |Phi_ai| (r) [kg^-1/2]
/// @param tolerance of each displacement component [m], >= 0
std::vector<ModeRange> active_modes(std::span<const double> coordinate,
                                    std::span<const double> largest_shape, double tolerance);

}  // namespace irdm
