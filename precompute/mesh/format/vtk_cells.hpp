#pragma once

#include <string>
#include <vector>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// An unstructured grid as VTK's files hold it, whole numbers included.
struct VtkCells {
  std::vector<double> coordinates;   ///< (3 N)
  std::vector<double> connectivity;  ///< point numbers of all cells, one cell after the other
  std::vector<double> ends;          ///< (cells) where each cell ends in `connectivity`
  std::vector<double> types;         ///< (cells) VTK's cell types
};

/// The linear tetrahedra among the cells; vertices, lines and surface cells are passed over. Throws
/// Error (about `name`) for other volume cells and for numbers that do not fit together.
TetMesh mesh_of_cells(const VtkCells& cells, const std::string& name);

}  // namespace irdm::precompute
