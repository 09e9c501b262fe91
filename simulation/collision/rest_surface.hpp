#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/model/model.hpp"
#include "common/surface/surface_tree.hpp"

namespace irdm {

/// Which triangles meet at a node. Built once, read only.
class SurfaceTopology {
 public:
  explicit SurfaceTopology(const ModelMesh& mesh);

  std::span<const int> triangles_around(int node) const noexcept {
    const auto begin = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(node)]);
    const auto end = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(node) + 1]);
    return {triangles_.data() + begin, end - begin};
  }
  const std::array<int, 3>& corners(int triangle) const noexcept {
    return corners_[static_cast<std::size_t>(triangle)];
  }

 private:
  std::vector<std::array<int, 3>> corners_;
  std::vector<int> offsets_;
  std::vector<int> triangles_;
};

/// A point of the surface at rest.
struct SurfaceLocation {
  int triangle = 0;
  SurfacePoint point;
  Vector3 position = Vector3::Zero();  ///< [m], B
};

/// The object's surface at rest, in B: where on it a contact is, and how it moves along. Built
/// once, read only; queries are real-time safe, for any number of threads.
class RestSurface {
 public:
  explicit RestSurface(const ModelMesh& mesh);

  const SurfaceTree& tree() const noexcept { return tree_; }
  const SurfaceTopology& topology() const noexcept { return topology_; }
  const Vector3& node(int i) const noexcept { return positions_[static_cast<std::size_t>(i)]; }
  TriangleCorners corners(int triangle) const noexcept;

  /// The point nearest to p.  @param guess as of SurfaceTree::closest_triangle()
  SurfaceLocation closest(const Vector3& p, int guess = 0) const noexcept;
  /// The point nearest to p that is reached from a triangle by going to whichever neighbour is
  /// nearer until none is: across edges and round corners, but not through the object.
  SurfaceLocation walk(int triangle, const Vector3& p) const noexcept;

  /// The end of a GeodesicStep of a `length` [m].
  SurfaceLocation straight_on(const SurfaceLocation& from, const Vector3& direction,
                              double length) const noexcept;
  /// The triangle that a point belongs to, with its place.
  SurfaceLocation locate(const SurfacePoint& point) const noexcept;

  /// What a walk over a triangle needs of it.
  struct Plane {
    Vector3 normal = Vector3::Zero();  ///< outward, unit, B
    /// How the weight of each corner grows along the plane: rate . way [1/m].
    std::array<Vector3, 3> rates;
    /// The neighbours over the edges that lie opposite to the corners.
    std::array<int, 3> across{};
  };
  const Plane& plane(int triangle) const noexcept {
    return planes_[static_cast<std::size_t>(triangle)];
  }

  /// Outward unit normal that varies continuously over the surface: the nodes' normals (of the
  /// faces round them, weighted with their angles), interpolated.
  Vector3 smooth_normal(const SurfacePoint& point) const noexcept;
  int node_count() const noexcept { return static_cast<int>(positions_.size()); }
  int triangle_count() const noexcept { return static_cast<int>(planes_.size()); }
  /// Of the ball about the centre of mass that has all nodes in it [m].
  double bounding_radius() const noexcept { return bounding_radius_; }
  /// Mean length of the triangles' edges [m].
  double mean_edge() const noexcept { return mean_edge_; }
  /// Mean square of the same [m^2].
  double mean_square_edge() const noexcept { return mean_square_edge_; }

 private:
  SurfaceLocation on(int triangle, const Vector3& p) const noexcept;
  int neighbour(int triangle, std::size_t corner) const noexcept;

  SurfaceTree tree_;
  SurfaceTopology topology_;
  std::vector<Vector3> positions_;
  std::vector<Vector3> normals_;  ///< of the nodes
  std::vector<Plane> planes_;     ///< of the triangles
  double bounding_radius_ = 0.0;
  double mean_edge_ = 0.0;
  double mean_square_edge_ = 0.0;
};

/// A straight way along the surface at rest: within each triangle a straight line, over an edge as
/// if the two triangles were unfolded into a plane. Leg by leg, one triangle each. Real-time safe.
class GeodesicStep {
 public:
  /// @param direction of the first leg, as far as it lies in the plane of the triangle [m, B]
  /// @param surface must outlive this object
  GeodesicStep(const RestSurface& surface, const SurfaceLocation& from,
               const Vector3& direction) noexcept;

  /// False: the direction was normal to the triangle, and there is nowhere to go.
  bool moves() const noexcept { return moves_; }
  /// Goes on to the next edge, and over it, but not farther than `length`. Returns how far [m].
  double leg(double length) noexcept;

  const SurfaceLocation& here() const noexcept { return here_; }
  /// Where the last leg began, its direction and its triangle's outward normal (units, B).
  const Vector3& start() const noexcept { return start_; }
  const Vector3& heading() const noexcept { return heading_; }
  const Vector3& normal() const noexcept { return normal_; }

 private:
  void enter(int triangle) noexcept;
  void cross(std::size_t corner) noexcept;

  const RestSurface& surface_;
  SurfaceLocation here_;
  Vector3 start_, heading_, normal_;
  const RestSurface::Plane* plane_ = nullptr;  ///< of the leg to come ...
  Vector3 ahead_;                              ///< ... and its direction
  bool moves_ = true;
};

}  // namespace irdm
