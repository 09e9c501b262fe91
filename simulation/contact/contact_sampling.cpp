#include "simulation/contact/contact_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace irdm {
namespace {

// Faces whose normals are nearer than 40 degrees belong to one smooth part.
constexpr double kSmooth = 0.766;

// Centroid of the third of a triangle that is nearest to a corner (cut off by its medians), in
// barycentric weights of that corner and of each other one.
constexpr double kOwn = 11.0 / 18.0;
constexpr double kOther = 7.0 / 36.0;

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
  for (Site& site : sites_) site.normal.normalize();
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
    sample.row = sites.front();
    if (sites.size() > 1) {
      sample.row = row_count();
      add_row(sites);
    }
    sample.place = surface_.closest(moment / sample.area);
    total += sample.area;
    samples_.push_back(sample);
  }
  spacing_ = std::sqrt(total / static_cast<double>(samples_.size()));
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
