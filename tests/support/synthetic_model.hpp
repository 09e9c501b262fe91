#pragma once

#include <memory>

#include "common/model/model.hpp"

namespace irdm::test {

/// A cube of `cells` cells an edge and `edge` m, its surface alone, with `modes` random modes from
/// 10 to 400 Hz: every formula of the online part that holds for any linear response can be tried
/// on it without finite elements. dt = 2 ms.
Model synthetic_cube(int cells, int modes, int steps, double edge = 0.12, unsigned seed = 1);

/// Gives its modes made-up centrifugal forces.
void add_centrifugal(Model& modal, unsigned seed = 2);

/// Gives its modes made-up forces of gravity, and with `rest` something that other modes add.
void add_gravity(Model& modal, bool rest = false, unsigned seed = 4);

/// Gives it a made-up residual compliance between the corners of each triangle, as large as its
/// R[0]: symmetric and positive definite.
void add_residual(Model& modal, unsigned seed = 3);

/// The same body, rigid: its response is gone.
Model made_rigid(Model model);

/// A made-up compressed response of its nodes, in 16 bits: two poles, each of a shape of its own.
CompressedResponse compressed_response(const Model& model);

/// The same object with R itself, and the responses to spin and gravity if there are, computed from
/// its modes and residual compliance by the closed form, as a DenseResponse.
template <typename Scalar>
Model with_dense_response(const Model& modal);

}  // namespace irdm::test
