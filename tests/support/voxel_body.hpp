#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>

#include "common/model/model.hpp"

namespace irdm::test {

/// A tetrahedral mesh of some cells of a grid. Each cell is divided into six tetrahedra about its
/// diagonal.
struct VoxelMesh {
  std::array<int, 3> cells{1, 1, 1};  ///< of the grid, along each axis
  /// Returns whether a cell is part of the body; unset: all are.
  std::function<bool(const std::array<int, 3>&)> solid = {};
  /// Returns the position [m] of a corner of the grid. It must keep the orientation of the cells.
  std::function<Vector3(const std::array<int, 3>&)> place;
};

/// Writes the mesh as a file of Gmsh 2.2.
void write_voxel_mesh(const VoxelMesh& mesh, const std::filesystem::path& path);

struct VoxelMaterial {
  double youngs_modulus = 5e3;  ///< [Pa]
  double poisson_ratio = 0.45;
  double density = 1000.0;  ///< [kg/m^3]
  double rayleigh_alpha = 8.0;
  double rayleigh_beta = 2e-4;
  double dt = 0.002;    ///< [s]
  int order = 2;        ///< of the tetrahedra
  int modes = 400;      ///< the lowest so many; 0: all
  bool clamped = true;  ///< in the lowest twentieth of its height, along y; else it floats
};

/// Returns the model of such a body as irdm-precompute makes it, with a modal response.
std::shared_ptr<const Model> voxel_body(const VoxelMesh& mesh, const VoxelMaterial& material = {});

}  // namespace irdm::test
