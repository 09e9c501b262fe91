#pragma once

#include <array>
#include <memory>

#include "common/model/model.hpp"
#include "common/model/model_file.hpp"

namespace irdm::test {

/// A box whose face in the lowest plane along an axis is clamped.
struct FixedBox {
  Vector3 size = Vector3::Constant(0.12);  ///< [m]
  std::array<int, 3> cells = {3, 3, 3};    ///< along each edge
  int clamped_axis = 1;
  double youngs_modulus = 2000.0;
  double poisson_ratio = 0.49;
  double rayleigh_alpha = 60.0;
  int order = 1;  ///< of the tetrahedra
  int modes = 0;  ///< the lowest so many, and what the others add; 0: all
};

/// Its model as irdm-precompute makes it, in double precision, 110 kg/m^3, 300 steps of 2 ms.
std::shared_ptr<const Model> fixed_box(const FixedBox& box,
                                       ResponseKind kind = ResponseKind::kModal);

}  // namespace irdm::test
