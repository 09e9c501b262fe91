#pragma once

#include "common/model/compressed_file.hpp"
#include "precompute/compress/dense_input.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// Largest error of the force that holds a node on a prescribed path of 0.6 s (pressed in, swung
/// along two axes), as a share of the force's peak: what a force step solves, W f = p - r with the
/// rigid body's own motion in it. 0 for a node that does not move.
/// @param expected, actual R_ii[s] row by row, (T, 9) [m/N]
/// @param rigid dt^2/2 G of the node, its rigid motion in the first step per force [m/N]
double held_force_error(const RowMatrix<double>& expected, const RowMatrix<double>& actual,
                        const Matrix3& rigid, double dt);

/// Compares a compressed response with R itself, on all columns or those of some 200 nodes, always
/// the same ones.
CompressionError measure_error(const CompressedResponse& response, const DenseInput& input,
                               const Console& console);

}  // namespace irdm::precompute
