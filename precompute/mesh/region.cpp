#include "precompute/mesh/region.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "common/dense_algebra.hpp"
#include "common/error.hpp"

namespace irdm::precompute {
namespace {

constexpr double kRounding = 1e-9;

double size_of(const TetMesh& mesh) {
  return (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
}

bool contains(const HalfSpace& half, const Vector3& x, double tolerance) {
  return half.normal.normalized().dot(x - half.point) <= tolerance;
}

bool contains(const BoxRegion& box, const Vector3& x, double tolerance) {
  return ((x - box.lowest).array() >= -tolerance).all() &&
         ((box.highest - x).array() >= -tolerance).all();
}

bool contains(const BallRegion& ball, const Vector3& x, double tolerance) {
  return (x - ball.centre).norm() <= ball.radius + tolerance;
}

// A group has no inside of its own.
bool contains(const GroupRegion&, const Vector3&, double) {
  return false;
}

bool contains(const Region& region, const Vector3& x, double tolerance) {
  return std::visit([&](const auto& shape) { return contains(shape, x, tolerance); }, region);
}

constexpr std::size_t kMostGroups = 40;  // in a message

std::string group_list(const TetMesh& mesh) {
  std::string list;
  std::size_t left = kMostGroups;
  for (const auto& [name, group] : mesh.groups) {
    if (left-- == 0) return list + ", ...";
    list += (list.empty() ? "" : ", ") + in_quotes(name);
  }
  return list;
}

// The groups of that name or number that the file has in several dimensions; empty: none.
std::string of_several_dimensions(const TetMesh& mesh, const std::string& group) {
  std::string list;
  for (const char* dimension : {"point", "curve", "surface", "volume"}) {
    const std::string full = std::string(dimension) + " " + group;
    if (mesh.groups.contains(full)) list += (list.empty() ? "" : " or ") + in_quotes(full);
  }
  return list;
}

const MeshGroup& find_group(const TetMesh& mesh, const std::string& group,
                            const std::string& name) {
  const auto found = mesh.groups.find(group);
  if (found == mesh.groups.end()) {
    const std::string meant = of_several_dimensions(mesh, group);
    if (!meant.empty()) {
      throw Error(name, "the mesh has several groups " + in_quotes(group), "say which: " + meant);
    }
    throw Error(name, "the mesh has no group " + in_quotes(group),
                mesh.groups.empty()
                    ? "only Gmsh and Medit files have groups: use a box or a half-space"
                    : "it has " + group_list(mesh));
  }
  return found->second;
}

std::vector<int> nodes_of_group(const MeshGroup& group) {
  std::vector<int> nodes;
  for (const auto& element : group) nodes.insert(nodes.end(), element.begin(), element.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::array<int, 4> sorted_corners(std::span<const int> nodes) {
  std::array<int, 4> corners{};
  std::copy_n(nodes.begin(), 4, corners.begin());
  std::ranges::sort(corners);
  return corners;
}

// Its points, edges and faces are passed over.
std::vector<int> elements_of_group(const TetMesh& mesh, const MeshGroup& group) {
  const auto width = static_cast<std::size_t>(mesh.tets.cols());
  std::set<std::array<int, 4>> named;
  for (const std::vector<int>& nodes : group) {
    if (nodes.size() == width) named.insert(sorted_corners(nodes));
  }
  std::vector<int> elements;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    if (named.contains(sorted_corners({mesh.tets.row(e).data(), width}))) elements.push_back(e);
  }
  return elements;
}

// Whether all nodes lie on one line: the spread across their main direction vanishes.
bool collinear(const TetMesh& mesh, const std::vector<int>& nodes) {
  if (nodes.size() < 3) return true;
  const Points points = mesh.nodes(nodes, Eigen::all);
  const Points arms = points.rowwise() - points.colwise().mean();
  const Eigen::VectorXd spread = symmetric_eigenvalues(Matrix3(arms.transpose() * arms));
  return spread(1) <= 1e-12 * spread(2);
}

}  // namespace

std::vector<int> nodes_in(const TetMesh& mesh, const Region& region, const std::string& name) {
  if (const auto* group = std::get_if<GroupRegion>(&region)) {
    return nodes_of_group(find_group(mesh, group->group, name));
  }
  const double tolerance = kRounding * size_of(mesh);
  std::vector<int> nodes;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (contains(region, mesh.position(i), tolerance)) nodes.push_back(i);
  }
  return nodes;
}

std::vector<int> elements_in(const TetMesh& mesh, const Region& region, const std::string& name) {
  if (const auto* group = std::get_if<GroupRegion>(&region)) {
    return elements_of_group(mesh, find_group(mesh, group->group, name));
  }
  const double tolerance = kRounding * size_of(mesh);
  std::vector<int> elements;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    if (contains(region, centroid_of(mesh, e), tolerance)) elements.push_back(e);
  }
  return elements;
}

int count_cut_elements(const TetMesh& mesh, const Region& region) {
  const double tolerance = kRounding * size_of(mesh);
  int count = 0;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    bool inside = false;
    bool outside = false;
    for (int i = 0; i < 4; ++i) {
      const Vector3 x = mesh.position(mesh.tets(e, i));
      inside = inside || contains(region, x, -tolerance);
      outside = outside || !contains(region, x, tolerance);
    }
    if (inside && outside) ++count;
  }
  return count;
}

void check_clamped(const TetMesh& mesh, const std::vector<int>& clamped,
                   const std::vector<int>& surface_nodes, const std::string& name) {
  if (clamped.empty()) {
    throw Error(name, "the support holds no node of the mesh",
                "mind that its coordinates are those of the mesh, in metres");
  }
  if (std::includes(clamped.begin(), clamped.end(), surface_nodes.begin(), surface_nodes.end())) {
    throw Error(name, "the support holds every node of the surface", "make it smaller");
  }
  if (collinear(mesh, clamped)) {
    throw Error(name,
                "the support holds " + std::to_string(clamped.size()) +
                    (clamped.size() == 1 ? " node" : " nodes on one line") +
                    ", about which the body can still turn",
                "make it hold three nodes that do not lie on a line");
  }
}

}  // namespace irdm::precompute
