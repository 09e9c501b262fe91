#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace irdm::test {

/// A surface node of one object that is inside something else.
struct NodeInside {
  double depth = 0.0;  ///< to the nearest point of the other's surface [m]
  double time = 0.0;   ///< [s]
  std::string object;
  int node = 0;  ///< of its surface
  std::string other;
};

/// Distance of a point from a closed surface [m], negative inside: by the nearest of all triangles
/// and the solid angle that all of them span. Shares nothing with the simulation.
/// @param triangles their corners, outward
double signed_distance(const std::vector<std::array<Vector3, 3>>& triangles, const Vector3& x);

/// The deepest node of every frame of a run (docs/files.md), of all objects in each other, in
/// scenery and in the floor.
/// @param run made by irdm-replay --output
NodeInside deepest_inside(const std::filesystem::path& run, const SceneConfig& scene);

}  // namespace irdm::test
