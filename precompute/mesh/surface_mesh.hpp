#pragma once

#include <string>

#include "common/geometry.hpp"

namespace irdm::precompute {

/// A surface of triangles that is to be filled with tetrahedra. n nodes, t triangles.
struct SurfaceMesh {
  Points nodes;         ///< (n, 3) [m], or the unit of a file
  Triangles triangles;  ///< (t, 3) into nodes
};

/// "(0.1, 0.2, 0.3)", for messages.
std::string place_text(const Vector3& place);

/// A node's coordinates in this form.
std::string place(const SurfaceMesh& surface, int node);

/// Length of the diagonal of the bounding box.
double diagonal(const SurfaceMesh& surface);

/// Mean length of the sides of the triangles.
double mean_edge(const SurfaceMesh& surface);

/// Volume that a closed surface encloses. Its triangles must all be turned the same way round,
/// either way.
double enclosed_volume(const SurfaceMesh& surface);

/// The same surface with every place there once: nodes closer than a millionth of its size become
/// one, as in STL, which repeats the corners of every triangle. Triangles that have two equal
/// corners then are left out, and so are nodes that belong to no triangle.
SurfaceMesh weld(const SurfaceMesh& surface);

}  // namespace irdm::precompute
