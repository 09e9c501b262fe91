#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/model/model.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

class StateArchive;

/// The point of the deformed surface nearest to a query point.
struct SurfaceHit {
  int triangle = 0;
  SurfacePoint point;
  Vector3 position = Vector3::Zero();  ///< [m], B
  /// From the surface to the query point, positive outside, negative inside [m].
  double signed_distance = 0.0;
};

/// Some of a surface's triangles: a flag each; empty: all.
using TriangleSet = std::span<const std::uint8_t>;

/// The surface as it would be at the end of the coming step if no force acted during it, in B. Only
/// the nodes that a query looks at are computed, each once a step, so that what a query costs does
/// not depend on the size of the object. Real-time safe after construction; one thread.
///
/// The rest surface's tree, asked at the query point less the displacement found there, gives a
/// triangle to start from; from it the search goes to whichever neighbour is nearer until none is.
class DeformedSurface {
 public:
  /// @param rest must outlive this object
  explicit DeformedSurface(const RestSurface& rest);

  /// Starts a step: no node was looked at in it.
  /// @param engine must outlive the step
  /// @param change what no component of any node's displacement has changed by since the last call
  /// [m]; 0: what is known stays; infinite: nothing is known any more
  void begin_step(const ResponseEngine& engine, double change = kUnknown) noexcept;
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  /// r_i = X_i + h_i of a surface node [m], B.
  const Vector3& node(int i) noexcept;

  /// Nodes that were looked at since begin_step().
  std::span<const int> seen() const noexcept { return seen_; }

  /// Whether any node was asked for in this state of the engine.
  bool queried() const noexcept { return queried_; }

  /// Whether the way from `from` to `to` stays outside of all that the surface can fill, which is
  /// known without looking at any node. False: it may not.
  bool is_far_from(const Vector3& from, const Vector3& to) noexcept;

  /// The point nearest to p.
  SurfaceHit closest(const Vector3& p) noexcept;

  /// Where the way from `from` to `to` first crosses the surface from outside, the triangles around
  /// `near` and those along the way being looked at: a thin part is not passed through.
  /// @param among only these triangles count
  std::optional<SurfaceHit> first_crossing(const Vector3& from, const Vector3& to,
                                           const SurfaceHit& near, TriangleSet among = {}) noexcept;

  /// Distance of p, which has no sign, as far as `limit` [m]: from the triangles around `near` and
  /// those about p. 0: too many are there.
  double distance_up_to(double limit, const Vector3& p, const SurfaceHit& near) noexcept;

  /// The point nearest to p that is reached from a triangle by going to whichever neighbour among
  /// these is nearer, until none is. Its distance has no sign.
  SurfaceHit closest_from(int triangle, const Vector3& p, TriangleSet among) noexcept;

  /// What no component of any node's displacement is larger than [m]; may be infinite.
  double bound() noexcept;

  /// A state of the surface that later ones are compared with.
  struct Mark {
    std::uint64_t bounded_since = 0;
    double change = 0.0;
  };
  Mark mark() const noexcept { return {bounded_since_, change_}; }
  /// By what no component of any node's displacement has changed since then [m]; may be infinite.
  double change_since(const Mark& then) const noexcept {
    return then.bounded_since == bounded_since_ ? change_ - then.change : kUnknown;
  }
  /// As if a node had been asked for: what is known in this state is wanted in the next one.
  void keep() noexcept { queried_ = true; }

  /// Outward unit normal of a deformed triangle.
  Vector3 normal(int triangle) noexcept;

  /// State, in or out (StateArchive).
  void archive(StateArchive& state, const ResponseEngine& engine);

 private:
  TriangleCorners corners(int triangle) noexcept;
  std::optional<double> known(int triangle, TriangleCorners& then) noexcept;
  bool is_beyond(double distance, int triangle, const Vector3& p) noexcept;
  bool is_outside(const Eigen::AlignedBox3d& box, int triangle) noexcept;
  void mark_seen(std::size_t node) noexcept;
  SurfaceHit hit_on(int triangle, const Vector3& p) noexcept;
  SurfaceHit descend(SurfaceHit best, const Vector3& p, TriangleSet among = {}) noexcept;
  Vector3 pseudonormal(const SurfaceHit& hit) noexcept;
  template <typename Visit>
  void visit_neighbours(int triangle, const Visit& visit) noexcept;
  template <typename Visit>
  bool visit_about(Eigen::AlignedBox3d box, const SurfaceHit& near, const Visit& visit) noexcept;

  const RestSurface& rest_;
  Eigen::AlignedBox3d rest_box_;
  const ResponseEngine* engine_ = nullptr;
  std::uint64_t state_ = 1;
  std::uint64_t step_ = 0;
  bool queried_ = false;
  std::uint64_t bounded_since_ = 1;      ///< state since which changes are bounded
  double change_ = 0.0;                  ///< the sum of all such bounds [m]
  std::vector<std::uint64_t> known_in_;  ///< state in which positions_ of a node was computed
  std::vector<double> change_then_;      ///< change_ in that state
  std::vector<std::uint64_t> seen_in_;   ///< step in which a node was looked at
  std::vector<Vector3> positions_;
  std::vector<int> seen_;
  std::uint64_t bound_known_in_ = 0;  ///< as known_in_
  double bound_ = 0.0;                ///< of each component of a displacement [m]
};

}  // namespace irdm
