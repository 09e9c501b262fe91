#pragma once

#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <vector>

#include "common/model/model.hpp"

namespace irdm::test {

/// The surface of the cells of a grid that are solid, two triangles a cell's face, centred at the
/// origin. @param edge of a cell [m]
inline ModelMesh voxel_surface(const std::array<int, 3>& cells, double edge,
                               const std::function<bool(const std::array<int, 3>&)>& solid) {
  std::map<std::array<int, 3>, int> numbers;
  std::vector<std::array<int, 3>> triangles;
  const auto number = [&](const std::array<int, 3>& at) {
    return numbers.emplace(at, static_cast<int>(numbers.size())).first->second;
  };
  const auto is_solid = [&](const std::array<int, 3>& cell) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (cell[i] < 0 || cell[i] >= cells[i]) return false;
    }
    return solid(cell);
  };
  const auto add_face = [&](const std::array<int, 3>& cell, std::size_t axis, int side) {
    const auto corner = [&](int b, int c) {
      std::array<int, 3> at = cell;
      at[axis] += side;
      at[(axis + 1) % 3] += b;
      at[(axis + 2) % 3] += c;
      return number(at);
    };
    const std::array<int, 4> quad{corner(0, 0), corner(side, 1 - side), corner(1, 1),
                                  corner(1 - side, side)};
    triangles.push_back({quad[0], quad[1], quad[2]});
    triangles.push_back({quad[0], quad[2], quad[3]});
  };
  for (int x = 0; x < cells[0]; ++x) {
    for (int y = 0; y < cells[1]; ++y) {
      for (int z = 0; z < cells[2]; ++z) {
        const std::array<int, 3> cell{x, y, z};
        if (!is_solid(cell)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const int side : {0, 1}) {
            std::array<int, 3> beyond = cell;
            beyond[axis] += 2 * side - 1;
            if (!is_solid(beyond)) add_face(cell, axis, side);
          }
        }
      }
    }
  }
  ModelMesh mesh;
  mesh.nodes.resize(static_cast<Eigen::Index>(numbers.size()), 3);
  for (const auto& [at, node] : numbers) {
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.nodes(node, static_cast<Eigen::Index>(i)) = edge * (at[i] - 0.5 * cells[i]);
    }
  }
  mesh.surface_nodes.resize(numbers.size());
  std::iota(mesh.surface_nodes.begin(), mesh.surface_nodes.end(), 0);
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.triangles(static_cast<Eigen::Index>(t), static_cast<Eigen::Index>(i)) = triangles[t][i];
    }
  }
  return mesh;
}

}  // namespace irdm::test
