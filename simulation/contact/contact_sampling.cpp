#include "simulation/contact/contact_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "simulation/contact/normal_cone.hpp"

namespace irdm {
namespace {

// Faces whose normals are nearer than 40 degrees belong to one smooth part.
constexpr double kSmooth = 0.766;

// Centroid of the third of a triangle that is nearest to a corner (cut off by its medians), in
// barycentric weights of that corner and of each other one.
constexpr double kOwn = 11.0 / 18.0;
constexpr double kOther = 7.0 / 36.0;

// Largest mean area of a triangle on which a ball uses the samples for other bodies, as a multiple
// of the square of the spacing that its own samples would have.
constexpr double kMaxFineTriangle = 0.7;
// Largest spacing of the samples for other bodies that a ball uses, as a multiple of the spacing
// that its own samples would have.
constexpr double kMaxFineSpacing = 1.3;

int root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    i = parent[static_cast<std::size_t>(i)] =
        parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
  }
  return i;
}

}  // namespace

ContactSampling::ContactSampling(const RestSurface& surface, int most) : surface_(surface) {
  make_sites(smooth_parts());
  first_.push_back(0);
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) add_row({s});
  make_samples(choose(most));
  find_creases();
  add_edge_samples();
}

// Of each triangle.
std::vector<int> ContactSampling::smooth_parts() const {
  std::vector<int> parent(static_cast<std::size_t>(surface_.triangle_count()));
  std::iota(parent.begin(), parent.end(), 0);
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    const RestSurface::Plane& plane = surface_.plane(t);
    for (const int across : plane.across) {
      if (across < 0 || surface_.plane(across).normal.dot(plane.normal) < kSmooth) continue;
      const int a = root(parent, t);
      const int b = root(parent, across);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    parent[static_cast<std::size_t>(t)] = root(parent, t);
  }
  return parent;
}

void ContactSampling::make_sites(const std::vector<int>& parts) {
  std::map<std::pair<int, int>, int> number;
  corner_sites_.resize(parts.size());
  for (int t = 0; t < static_cast<int>(parts.size()); ++t) {
    const auto index = static_cast<std::size_t>(t);
    const Vector3 twice = area_normal(surface_.corners(t));
    for (std::size_t i = 0; i < 3; ++i) {
      const int node = surface_.topology().corners(t)[i];
      const auto [found, fresh] =
          number.try_emplace({node, parts[index]}, static_cast<int>(sites_.size()));
      if (fresh) sites_.push_back({node, parts[index]});
      corner_sites_[index][i] = found->second;
      Site& site = sites_[static_cast<std::size_t>(found->second)];
      const double share = twice.norm() / 6.0;
      const TriangleCorners corners = surface_.corners(t);
      site.area += share;
      site.normal += twice;
      site.moment += share * (kOwn * corners[i] + kOther * corners[(i + 1) % 3] +
                              kOther * corners[(i + 2) % 3]);
    }
  }
  site_of_node_.resize(static_cast<std::size_t>(surface_.node_count()));
  for (std::size_t s = 0; s < sites_.size(); ++s) {
    sites_[s].normal.normalize();
    area_ += sites_[s].area;
    site_of_node_[static_cast<std::size_t>(sites_[s].node)] = static_cast<int>(s);
  }
}

// Each node with the share of the area that is its own: the load of a uniform pressure on linear
// triangles.
void ContactSampling::add_row(const std::vector<int>& sites) {
  double sum = 0.0;
  for (const int s : sites) sum += sites_[static_cast<std::size_t>(s)].area;
  for (const int s : sites) {
    const Site& site = sites_[static_cast<std::size_t>(s)];
    nodes_.push_back(site.node);
    weights_.push_back(site.area / sum);
  }
  first_.push_back(static_cast<int>(nodes_.size()));
}

// Middles of samples, in their order: always the site that is farthest from those of its part that
// were chosen before.
std::vector<int> ContactSampling::choose(int most) const {
  std::vector<double> distance(sites_.size(), std::numeric_limits<double>::infinity());
  std::vector<int> chosen;
  while (chosen.size() < sites_.size()) {
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (static_cast<int>(chosen.size()) >= most && std::isfinite(*farthest)) break;
    const auto next = static_cast<int>(farthest - distance.begin());
    const Site& site = sites_[static_cast<std::size_t>(next)];
    chosen.push_back(next);
    for (std::size_t s = 0; s < sites_.size(); ++s) {
      if (sites_[s].part != site.part) continue;
      const Vector3 way = surface_.node(sites_[s].node) - surface_.node(site.node);
      distance[s] = std::min(distance[s], way.squaredNorm());
    }
    distance[static_cast<std::size_t>(next)] = -1.0;
  }
  return chosen;
}

void ContactSampling::make_samples(const std::vector<int>& chosen) {
  std::vector<std::vector<int>> members(chosen.size());
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
    const Site& site = sites_[static_cast<std::size_t>(s)];
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      const Site& middle = sites_[static_cast<std::size_t>(chosen[c])];
      if (middle.part != site.part) continue;
      const double here = (surface_.node(middle.node) - surface_.node(site.node)).squaredNorm();
      if (here < least) nearest = c;
      least = std::min(least, here);
    }
    members[nearest].push_back(s);
  }
  double total = 0.0;
  for (const std::vector<int>& sites : members) {
    Sample sample;
    Vector3 moment = Vector3::Zero();
    for (const int s : sites) {
      const Site& site = sites_[static_cast<std::size_t>(s)];
      sample.area += site.area;
      sample.normal += site.area * site.normal;
      moment += site.moment;
    }
    sample.normal.normalize();
    sample.row = sample.site = sites.front();
    if (sites.size() > 1) {
      sample.site = -1;
      sample.row = row_count();
      add_row(sites);
    }
    sample.place = surface_.closest(moment / sample.area);
    total += sample.area;
    samples_.push_back(sample);
  }
  spacing_ = std::sqrt(total / static_cast<double>(samples_.size()));
}

double ContactSampling::ball_spacing(double radius) const noexcept {
  return ball_sample_spacing(radius, area_);
}

// Returns whether balls of a radius need samples of their own: because the triangles are larger
// than the parts of these samples, or because the spacing of the other samples is too wide.
bool ContactSampling::too_coarse_for(double radius) const noexcept {
  const double triangle = area_ / surface_.triangle_count();
  const double spacing = ball_spacing(radius);
  return triangle > kMaxFineTriangle * spacing * spacing || spacing_ > kMaxFineSpacing * spacing;
}

void ContactSampling::add_ball(const ModelMesh& mesh, double radius) {
  if (!too_coarse_for(radius) || ball(radius).count > 0) return;
  const double spacing = ball_spacing(radius);
  const std::vector<BallSample> samples = irdm::ball_samples(mesh, surface_, spacing);
  ball_ranges_.push_back(
      {static_cast<int>(ball_samples_.size()), static_cast<int>(samples.size()), spacing});
  ball_samples_.insert(ball_samples_.end(), samples.begin(), samples.end());
}

ContactSampling::BallRange ContactSampling::ball(double radius) const noexcept {
  if (!too_coarse_for(radius)) return {};
  const double spacing = ball_spacing(radius);
  for (const BallRange& range : ball_ranges_) {
    if (range.spacing == spacing) return range;
  }
  return {};
}

SurfacePlace ContactSampling::place(int sample) const noexcept {
  SurfacePlace place;
  if (sample < first_ball()) {
    place.rows[0] = samples_[static_cast<std::size_t>(sample)].row;
    place.weights[0] = 1.0;
    place.count = 1;
    return place;
  }
  place.ball_sample = sample - first_ball();
  const BallSample& ball = ball_samples_[static_cast<std::size_t>(place.ball_sample)];
  place.count = static_cast<int>(ball.node_count);
  for (std::size_t k = 0; k < ball.node_count; ++k) {
    place.rows[k] = site_of_node_[static_cast<std::size_t>(ball.nodes[k])];
    place.weights[k] = ball.weights[k];
  }
  return place;
}

SurfacePlace ContactSampling::node_place(int node) const noexcept {
  SurfacePlace place;
  place.rows[0] = site_of_node_[static_cast<std::size_t>(node)];
  place.weights[0] = 1.0;
  place.count = 1;
  return place;
}

SurfacePlace ContactSampling::place(const SurfaceLocation& at) const noexcept {
  SurfacePlace place;
  std::copy(sites(at.triangle).begin(), sites(at.triangle).end(), place.rows.begin());
  std::copy(at.point.weights.begin(), at.point.weights.end(), place.weights.begin());
  place.count = 3;
  return place;
}

SurfacePatch ContactSampling::patch_of(int sample) const noexcept {
  if (sample < first_ball()) return patch(samples_[static_cast<std::size_t>(sample)].row);
  const BallSample& ball = ball_samples_[static_cast<std::size_t>(sample - first_ball())];
  return {{ball.nodes.data(), ball.node_count}, {ball.weights.data(), ball.node_count}};
}

// Of each node that lies on several parts: convex, where each part lies behind the others.
void ContactSampling::find_creases() {
  std::map<int, std::vector<int>> of_node;
  for (int s = 0; s < static_cast<int>(sites_.size()); ++s) {
    of_node[sites_[static_cast<std::size_t>(s)].node].push_back(s);
  }
  for (const auto& [node, here] : of_node) {
    const Vector3& x = surface_.node(node);
    bool convex = here.size() > 1;
    for (const int s : here) {
      const Site& site = sites_[static_cast<std::size_t>(s)];
      for (const int t : here) {
        const Vector3& normal = sites_[static_cast<std::size_t>(t)].normal;
        convex = convex && (s == t || (site.moment / site.area - x).dot(normal) < 0.0);
      }
    }
    if (!convex) continue;
    const auto first = static_cast<int>(crease_sites_.size());
    for (const int s : here) {
      Site& site = sites_[static_cast<std::size_t>(s)];
      site.first_at_node = first;
      site.count_at_node = static_cast<int>(here.size());
      crease_sites_.push_back(s);
      crease_normals_.push_back(site.normal);
    }
  }
}

void ContactSampling::add_edge_samples() {
  first_edge_ = static_cast<int>(samples_.size());
  for (std::size_t i = 0; i < crease_sites_.size();) {
    const int first = crease_sites_[i];
    const Site& here = sites_[static_cast<std::size_t>(first)];
    Sample sample;
    for (const int end = static_cast<int>(i) + here.count_at_node; static_cast<int>(i) < end; ++i) {
      const Site& site = sites_[static_cast<std::size_t>(crease_sites_[i])];
      sample.area += site.area;
      sample.normal += site.normal;
    }
    sample.normal.normalize();
    sample.place = surface_.closest(surface_.node(here.node));
    sample.row = sample.site = first;
    samples_.push_back(sample);
  }
}

// The normal beyond the edge of a triangle that lies opposite to a corner, if that is a convex
// crease; else 0.
Vector3 ContactSampling::across_edge(const SurfaceLocation& at,
                                     std::size_t opposite) const noexcept {
  const std::array<int, 3>& corner = sites(at.triangle);
  const std::size_t j = (opposite + 1) % 3;
  const std::size_t k = (opposite + 2) % 3;
  const auto site = [&](int s) -> const Site& { return sites_[static_cast<std::size_t>(s)]; };
  const Site& one = site(corner[j]);
  const Site& two = site(corner[k]);
  for (int a = 0; a < one.count_at_node; ++a) {
    const Site& beyond = site(crease_sites_[static_cast<std::size_t>(one.first_at_node + a)]);
    if (beyond.part == one.part) continue;
    for (int b = 0; b < two.count_at_node; ++b) {
      const Site& same = site(crease_sites_[static_cast<std::size_t>(two.first_at_node + b)]);
      if (same.part != beyond.part) continue;
      return (at.point.weights[j] * beyond.normal + at.point.weights[k] * same.normal).normalized();
    }
  }
  return Vector3::Zero();
}

Vector3 ContactSampling::normal(const SurfaceLocation& at, const Vector3& direction,
                                double reach) const noexcept {
  std::array<Vector3, 4> faces{normal(at)};
  std::size_t count = 1;
  const TriangleCorners corners = surface_.corners(at.triangle);
  const double twice_area = area_normal(corners).norm();
  for (std::size_t i = 0; i < 3; ++i) {
    const double edge = (corners[(i + 2) % 3] - corners[(i + 1) % 3]).norm();
    if (at.point.weights[i] * twice_area >= reach * edge) continue;
    const Vector3 beyond = across_edge(at, i);
    if (!beyond.isZero()) faces[count++] = beyond;
  }
  return nearest_in_cone({faces.data(), count}, direction);
}

std::span<const Vector3> ContactSampling::faces_near(const SurfaceLocation& at,
                                                     double reach) const noexcept {
  for (const int s : sites(at.triangle)) {
    const Site& site = sites_[static_cast<std::size_t>(s)];
    if (site.count_at_node == 0) continue;
    if ((surface_.node(site.node) - at.position).norm() < reach) return faces_at(s);
  }
  return {};
}

Vector3 ContactSampling::normal(const SurfaceLocation& at) const noexcept {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const int site = sites(at.triangle)[i];
    sum += at.point.weights[i] * sites_[static_cast<std::size_t>(site)].normal;
  }
  return sum.normalized();
}

}  // namespace irdm
