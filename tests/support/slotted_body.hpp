#pragma once

#include <array>
#include <memory>

#include "common/model/model.hpp"
#include "common/model/model_file.hpp"

namespace irdm::test {

/// A body of cubes of 1 cm with a slot of one cube's width between two arms, x across the slot.
struct SlottedBody {
  bool closed = false;  ///< a frame, whose arms meet at both ends; else a horseshoe, open at +y
  double youngs_modulus = 2e4;
  double dt = 0.002;
  double rayleigh_alpha = 8.0;
  double rayleigh_beta = 2e-4;

  bool operator<(const SlottedBody& other) const;
};

inline constexpr double kVoxel = 0.01;  ///< edge of a cube, width of the slot [m]

/// Its model as irdm-precompute makes it; each is made once a process. Its slot's faces are x = -
/// and + kVoxel / 2 in the input's coordinates, its arms are 2 cubes wide and deep.
std::shared_ptr<const Model> slotted_body(const SlottedBody& body,
                                          ResponseKind kind = ResponseKind::kModal);

/// The surface node at a point of the input's coordinates [m]; -1: there is none.
int corner_node(const Model& model, const Vector3& point);

}  // namespace irdm::test
