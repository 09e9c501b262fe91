#include "precompute/mesh/region.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

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

template <typename Shape>
std::vector<int> nodes_inside(const TetMesh& mesh, const Shape& shape) {
  const double tolerance = kRounding * size_of(mesh);
  std::vector<int> nodes;
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (contains(shape, mesh.position(i), tolerance)) nodes.push_back(i);
  }
  return nodes;
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

std::vector<int> nodes_of_group(const TetMesh& mesh, const std::string& group,
                                const std::string& name) {
  const auto found = mesh.groups.find(group);
  if (found == mesh.groups.end()) {
    throw Error(name, "the mesh has no group " + in_quotes(group),
                mesh.groups.empty()
                    ? "only Gmsh and Medit files have groups: use a box or a half-space"
                    : "it has " + group_list(mesh));
  }
  std::vector<int> nodes;
  for (const auto& element : found->second)
    nodes.insert(nodes.end(), element.begin(), element.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Whether all nodes lie on one line: the spread across their main direction vanishes.
bool collinear(const TetMesh& mesh, const std::vector<int>& nodes) {
  if (nodes.size() < 3) return true;
  const Points points = mesh.nodes(nodes, Eigen::all);
  const Points arms = points.rowwise() - points.colwise().mean();
  const Eigen::SelfAdjointEigenSolver<Matrix3> spread(arms.transpose() * arms,
                                                      Eigen::EigenvaluesOnly);
  return spread.eigenvalues()(1) <= 1e-12 * spread.eigenvalues()(2);
}

}  // namespace

std::vector<int> nodes_in(const TetMesh& mesh, const Region& region, const std::string& name) {
  if (const auto* group = std::get_if<GroupRegion>(&region)) {
    return nodes_of_group(mesh, group->group, name);
  }
  if (const auto* half = std::get_if<HalfSpace>(&region)) return nodes_inside(mesh, *half);
  return nodes_inside(mesh, std::get<BoxRegion>(region));
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
