#pragma once

#include <memory>

#include "common/model/model.hpp"
#include "common/model/model_file.hpp"

namespace irdm::test {

/// The paper's cube (12 cm, 110 kg/m^3, nu = 0.49) with another mesh, stiffness or timing.
struct FemCube {
  int cells = 4;  ///< an edge
  double youngs_modulus = 2000.0;
  double rayleigh_alpha = 8.0;
  double dt = 0.002;
  int steps = 500;
  double poisson_ratio = 0.49;
  int order = 1;  ///< of the tetrahedra
  int modes = 0;  ///< the lowest so many, and what the others add; 0: all

  bool operator<(const FemCube& other) const;
};

/// Its model as irdm-precompute makes it, with the response that is asked for (compressed: from
/// dense, to 5 %); each is made once a process.
std::shared_ptr<const Model> fem_cube(const FemCube& cube,
                                      ResponseKind kind = ResponseKind::kModal);

}  // namespace irdm::test
