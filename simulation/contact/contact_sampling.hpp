#pragma once

#include <span>
#include <vector>

#include "simulation/collision/rest_surface.hpp"
#include "simulation/contact/ball_samples.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// A piece of an object's surface on which contact pressure is uniform: the weights of its nodes
/// sum to one. Its displacement is the same weighted mean, so that what a force does is what the
/// contact sees. A view into a ContactSampling.
struct SurfacePatch {
  std::span<const int> nodes;
  std::span<const double> weights;
};

/// The place of a contact on a surface: a weighted mean of rows of a ContactSampling.
struct SurfacePlace {
  std::array<int, 6> rows{};
  std::array<double, 6> weights{};
  int count = 0;         ///< number of rows: 1, 3 or 6
  int ball_sample = -1;  ///< index among the ball samples; -1 if it is none of them
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
/// sites of the point's triangle by barycentric weights.
///
/// Contacts with balls of the scenery use samples of another kind (BallSample), whose spacing suits
/// the ball's radius. add_ball() adds them for one radius, unless the triangles of the surface and
/// the samples above are fine enough. Immutable after the last add_ball().
class ContactSampling {
 public:
  /// @param most samples that are patches, > 0; there are at least as many as smooth parts
  /// @param surface must outlive this object
  ContactSampling(const RestSurface& surface, int most);
  /// Adds the samples for balls of a radius [m], unless those for other bodies are fine enough.
  /// @param mesh the mesh whose surface this is
  void add_ball(const ModelMesh& mesh, double radius);

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

  /// Returns the samples for balls of all radii. Their numbers follow those of samples().
  std::span<const BallSample> ball_samples() const noexcept { return ball_samples_; }
  int first_ball() const noexcept { return static_cast<int>(samples_.size()); }
  int sample_count() const noexcept {
    return first_ball() + static_cast<int>(ball_samples_.size());
  }
  struct BallRange {
    int first = 0;  ///< among ball_samples()
    int count = 0;
    double spacing = 0.0;  ///< [m]
  };
  std::span<const BallRange> ball_ranges() const noexcept { return ball_ranges_; }
  /// Returns the range of samples for balls of a radius [m]; it is empty if such a ball uses
  /// samples().
  BallRange ball(double radius) const noexcept;
  /// Returns the position of a sample of any kind on the surface at rest [m], B.
  const Vector3& rest_position(int sample) const noexcept {
    const auto i = static_cast<std::size_t>(sample);
    return sample < first_ball() ? samples_[i].place.position
                                 : ball_samples_[i - samples_.size()].place.position;
  }
  /// Return the place of a sample of any kind, and the nodes that its force loads.
  SurfacePlace place(int sample) const noexcept;
  SurfacePatch patch_of(int sample) const noexcept;
  /// Returns the place of a surface node.
  SurfacePlace node_place(int node) const noexcept;
  /// Returns the place of a point of the surface.
  SurfacePlace place(const SurfaceLocation& at) const noexcept;

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
  double ball_spacing(double radius) const noexcept;
  bool too_coarse_for(double radius) const noexcept;

  const RestSurface& surface_;
  std::vector<Site> sites_;
  std::vector<std::array<int, 3>> corner_sites_;  ///< of each triangle
  std::vector<int> crease_sites_;
  std::vector<Vector3> crease_normals_;  ///< of these
  std::vector<Sample> samples_;
  int first_edge_ = 0;
  double spacing_ = 0.0;
  double area_ = 0.0;  ///< of the surface [m^2]
  std::vector<BallSample> ball_samples_;
  std::vector<BallRange> ball_ranges_;
  std::vector<int> site_of_node_;  ///< one site of each node
  std::vector<int> first_;         ///< of each row, and one more
  std::vector<int> nodes_;
  std::vector<double> weights_;
};

}  // namespace irdm
