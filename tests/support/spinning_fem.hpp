#pragma once

#include <vector>

#include "common/model/model.hpp"

/// Spinning bodies computed by finite elements on the whole mesh, without modes and without R.
namespace irdm::test {

/// Whether the load follows the deformed shape: K u = f, or (K + M W^2) u = f with W = w x.
enum class SpinSoftening { kNone, kIncluded };

/// Displacement of the surface nodes (n, 3) [m], B, of a free body that has always turned with w
/// [rad/s], B: linear elasticity, rigid motion removed with the nodes' masses.
Points static_bulge(const Model& model, const Vector3& w, SpinSoftening softening);

/// One moment of a free body that spins.
struct SpinningState {
  Points displacement;  ///< of the surface nodes (n, 3) [m], B
  Vector3 w;            ///< of the body as a whole, I(deformed)^-1 L [rad/s], B
};

/// The corotational body, let go undeformed, turning with w [rad/s], W: after steps 1, 2, ... of
/// the model's dt, each taken in `parts`. The model must be of linear tetrahedra; its material is
/// taken, damping included.
std::vector<SpinningState> corotational_spin(const Model& model, const Vector3& w, int steps,
                                             int parts = 1);

/// The largest distance between the nodes of two displacement fields, as a share of the largest
/// displacement in `reference`.
double largest_error(const Points& u, const Points& reference);

}  // namespace irdm::test
