#include "precompute/mesh/format/vtk_cells.hpp"

#include <cmath>
#include <map>

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

constexpr int kVertex = 1;     // the first of the cells without volume,
constexpr int kQuad = 9;       // the last of them,
constexpr int kQuadLine = 21;  // and those of second order
constexpr int kQuadQuad = 23;
constexpr int kTetrahedron = 10;

const std::map<int, std::string> volume_names{{11, "voxels"},
                                              {12, "hexahedra"},
                                              {13, "prisms"},
                                              {14, "pyramids"},
                                              {24, "second-order tetrahedra"},
                                              {42, "polyhedra"}};

bool has_no_volume(int type) {
  return (type >= kVertex && type <= kQuad) || (type >= kQuadLine && type <= kQuadQuad);
}

[[noreturn]] void damaged(const std::string& name, const std::string& what) {
  throw Error(name, what, "the file is damaged: write the mesh again");
}

// A whole number from 0 up to `end`, not included.
std::size_t whole(double value, std::size_t end, const std::string& meaning,
                  const std::string& name) {
  if (!(value >= 0.0 && value < static_cast<double>(end) && value == std::floor(value))) {
    damaged(name, meaning + " is " + std::to_string(value) +
                      " and should be a whole number below " + std::to_string(end));
  }
  return static_cast<std::size_t>(value);
}

void refuse_other_volumes(const std::map<int, int>& counts, const std::string& name) {
  for (const auto& [type, count] : counts) {
    const auto known = volume_names.find(type);
    throw Error(name,
                "there are " + std::to_string(count) + " " +
                    (known == volume_names.end() ? "cells of VTK type " + std::to_string(type)
                                                 : known->second),
                "write linear tetrahedra only; mesh.order = 2 makes them quadratic here");
  }
}

}  // namespace

TetMesh mesh_of_cells(const VtkCells& cells, const std::string& name) {
  if (cells.coordinates.size() % 3 != 0) damaged(name, "a point lacks a coordinate");
  if (cells.ends.size() != cells.types.size()) {
    damaged(name, "there are " + std::to_string(cells.ends.size()) + " cells but types of " +
                      std::to_string(cells.types.size()));
  }
  TetMesh mesh;
  const std::size_t points = cells.coordinates.size() / 3;
  mesh.nodes =
      Eigen::Map<const Points>(cells.coordinates.data(), static_cast<Eigen::Index>(points), 3);
  std::vector<int> corners;
  std::map<int, int> others;
  std::size_t begin = 0;
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    const std::size_t end =
        whole(cells.ends[c], cells.connectivity.size() + 1, "the end of a cell", name);
    if (end < begin) damaged(name, "the cells are out of order");
    const auto type = static_cast<int>(whole(cells.types[c], 256, "a cell's type", name));
    if (type == kTetrahedron) {
      if (end - begin != 4) damaged(name, "a tetrahedron has not four points");
      for (std::size_t i = begin; i < end; ++i) {
        corners.push_back(
            static_cast<int>(whole(cells.connectivity[i], points, "a point of a cell", name)));
      }
    } else if (!has_no_volume(type)) {
      ++others[type];
    }
    begin = end;
  }
  refuse_other_volumes(others, name);
  mesh.tets = Eigen::Map<const RowMatrix<int>>(corners.data(),
                                               static_cast<Eigen::Index>(corners.size()) / 4, 4);
  return mesh;
}

}  // namespace irdm::precompute
