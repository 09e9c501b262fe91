#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/model/model.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/mesh_check.hpp"

namespace irdm::precompute {

/// What was computed and what it cost: the table at the end of a run, like the paper's Table 1.
struct Summary {
  int free_nodes = 0;  ///< n, at the surface
  int triangles = 0;   ///< at the surface
  int nodes = 0;       ///< N, all
  int clamped_nodes = 0;
  int tetrahedra = 0;
  int order = 1;  ///< of the tetrahedra
  MeshReport mesh;
  std::vector<RegionReport> regions{};  ///< none: one material
  double mass = 0.0;                    ///< of the body [kg]
  int modes = 0;                        ///< 0: R was obtained without modes
  double seconds = 0.0;                 ///< of the whole run
  std::uint64_t file_bytes = 0;
  double lowest_frequency = 0.0;           ///< of the elastic modes [Hz]
  std::optional<double> decay_left;        ///< see decay_left(), 0..; unknown of a slice
  int columns = 0;                         ///< of R that were computed in this run
  std::optional<ModeReduction> reduction;  ///< where not all modes were computed
  bool slice = false;                      ///< the file holds a slice of R
  double inertia_excess = 0.0;  ///< largest moment of inertia of the nodes over the solid's, - 1
  std::string blas_kernel;

  int degrees_of_freedom() const { return 3 * free_nodes; }
};

/// One "name value" a line, aligned.
std::string format_summary(const Summary& summary);

}  // namespace irdm::precompute
