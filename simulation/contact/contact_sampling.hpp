#pragma once

#include <span>
#include <vector>

#include "simulation/collision/rest_surface.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// A piece of an object's surface on which contact pressure is uniform: the weights of its nodes
/// sum to one. Its displacement is the same weighted mean, so that what a force does is what the
/// contact sees. A view into a ContactSampling.
struct SurfacePatch {
  std::span<const int> nodes;
  std::span<const double> weights;
};

/// The weighted mean over a patch of a quantity that is known at nodes.
template <typename NodeValue>
Vector3 mean(const SurfacePatch& patch, const NodeValue& value) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    sum += patch.weights[i] * value(patch.nodes[i]);
  }
  return sum;
}

/// Where objects touch each other: an object's surface divided into patches.
///
/// The surface falls into smooth parts that creases separate. A *site* is a node with one of the
/// parts that it lies on; its area is the node's share of that part (a third of each triangle). A
/// *sample* is a set of neighbouring sites: so many sites of a part as farthest-point sampling
/// chooses are its middles, each site belongs to the nearest of them. The order of the samples is
/// that of the choice, so fewer samples are the first of more (nested). A patch weights its nodes
/// with their areas, as finite elements load them: patches cover the surface once, and the same
/// pressure on all of them is a uniform one. A wider patch would make the pressures of neighbours
/// ill-determined: they then differ by a factor of two under a smooth contact.
/// Besides, each node of a convex crease is an *edge sample*: where an edge or a corner meets a
/// face, it touches there, and not where the areas beside it have their centroids.
/// A contact lies between a sample of one object and a point of another, whose force goes to the
/// sites of the point's triangle by barycentric weights. Built once, read only.
class ContactSampling {
 public:
  /// @param most samples that are patches, > 0; there are at least as many as smooth parts
  /// @param surface must outlive this object
  ContactSampling(const RestSurface& surface, int most);

  struct Sample {
    SurfaceLocation place;             ///< the centroid of its area, on the surface at rest
    Vector3 normal = Vector3::Zero();  ///< outward, unit, B
    double area = 0.0;                 ///< [m^2]
    int row = 0;                       ///< of its patch
    int site = -1;                     ///< its only one; -1: there are several
  };
  /// Those that are patches of the surface come first, then edge samples.
  std::span<const Sample> samples() const noexcept { return samples_; }
  int first_edge() const noexcept { return first_edge_; }
  /// Outward unit normals of the smooth parts that meet at a sample's node, B; none: it has several
  /// nodes, or one that is on no convex crease.
  std::span<const Vector3> faces(const Sample& sample) const noexcept {
    return sample.site < 0 ? std::span<const Vector3>() : faces_at(sample.site);
  }
  /// Square root of the mean area of a sample [m].
  double spacing() const noexcept { return spacing_; }

  /// All patches, those of sites and of samples of several sites, have a number: the row.
  int row_count() const noexcept { return static_cast<int>(first_.size()) - 1; }
  SurfacePatch patch(int row) const noexcept {
    const auto begin = static_cast<std::size_t>(first_[static_cast<std::size_t>(row)]);
    const auto end = static_cast<std::size_t>(first_[static_cast<std::size_t>(row) + 1]);
    return {{nodes_.data() + begin, end - begin}, {weights_.data() + begin, end - begin}};
  }

  /// The rows of the sites of a triangle's corners.
  const std::array<int, 3>& sites(int triangle) const noexcept {
    return corner_sites_[static_cast<std::size_t>(triangle)];
  }
  /// Outward unit normal that varies continuously over a smooth part, B.
  Vector3 normal(const SurfaceLocation& at) const noexcept;
  /// The same, but nearer to a convex crease than `reach` [m] that of those between the faces which
  /// is nearest to a direction: where something flat lies on an edge, its own normal counts.
  Vector3 normal(const SurfaceLocation& at, const Vector3& direction, double reach) const noexcept;
  /// Of a crease's node on the same triangle and nearer than `reach` [m]; none: there is none.
  std::span<const Vector3> faces_near(const SurfaceLocation& at, double reach) const noexcept;

 private:
  struct Site {
    int node = 0;
    int part = 0;
    double area = 0.0;
    Vector3 normal = Vector3::Zero();
    Vector3 moment = Vector3::Zero();  ///< area times centroid
    /// Those of its node, in the order of their parts: from here on in crease_sites_; of no crease,
    /// or of one that is not convex, count 0.
    int first_at_node = 0;
    int count_at_node = 0;
  };
  std::span<const Vector3> faces_at(int site) const noexcept {
    const Site& at = sites_[static_cast<std::size_t>(site)];
    return {crease_normals_.data() + at.first_at_node, static_cast<std::size_t>(at.count_at_node)};
  }
  void find_creases();
  void add_edge_samples();
  Vector3 across_edge(const SurfaceLocation& at, std::size_t opposite) const noexcept;
  std::vector<int> smooth_parts() const;
  void make_sites(const std::vector<int>& parts);
  std::vector<int> choose(int most) const;
  void make_samples(const std::vector<int>& chosen);
  void add_row(const std::vector<int>& sites);

  const RestSurface& surface_;
  std::vector<Site> sites_;
  std::vector<std::array<int, 3>> corner_sites_;  ///< of each triangle
  std::vector<int> crease_sites_;
  std::vector<Vector3> crease_normals_;  ///< of these
  std::vector<Sample> samples_;
  int first_edge_ = 0;
  double spacing_ = 0.0;
  std::vector<int> first_;  ///< of each row, and one more
  std::vector<int> nodes_;
  std::vector<double> weights_;
};

}  // namespace irdm
