#pragma once

#include <string>
#include <variant>
#include <vector>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Everything behind a plane, the plane included: on the side that the normal points away from,
/// like the ground below its upward normal.
struct HalfSpace {
  Vector3 point = Vector3::Zero();    ///< of the plane [m]
  Vector3 normal = Vector3::UnitZ();  ///< of any length, not zero
};

/// An axis-parallel box, its faces included.
struct BoxRegion {
  Vector3 lowest = Vector3::Zero();   ///< [m]
  Vector3 highest = Vector3::Zero();  ///< [m]
};

/// A ball, its surface included.
struct BallRegion {
  Vector3 centre = Vector3::Zero();  ///< [m]
  double radius = 0.0;               ///< [m], > 0
};

/// A group of the mesh.
struct GroupRegion {
  std::string group;
};

/// A part of the mesh, in its coordinates.
using Region = std::variant<HalfSpace, BoxRegion, BallRegion, GroupRegion>;

/// The nodes in a region, increasing. Faces and planes are thick by 1e-9 of the mesh's size, for
/// rounding. Throws Error (about `name`) for a group that the mesh does not have.
std::vector<int> nodes_in(const TetMesh& mesh, const Region& region, const std::string& name);

/// The tetrahedra of a region, increasing: those whose centroid lies in it, so that its volume
/// comes out right on average; of a group those that it names. Throws Error (about `name`) for a
/// group that the mesh does not have.
std::vector<int> elements_in(const TetMesh& mesh, const Region& region, const std::string& name);

/// How many tetrahedra have corners on both sides of the region's boundary; none where it is a
/// group.
int count_cut_elements(const TetMesh& mesh, const Region& region);

/// Throws Error (about `name`) unless clamping the nodes leaves the body no rigid motion, but
/// something to move at the surface.
/// @param clamped into the mesh's nodes, increasing
/// @param surface_nodes into the mesh's nodes
void check_clamped(const TetMesh& mesh, const std::vector<int>& clamped,
                   const std::vector<int>& surface_nodes, const std::string& name);

}  // namespace irdm::precompute
