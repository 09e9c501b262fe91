#include "precompute/mesh/mesh_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <vector>

#include "common/error.hpp"
#include "precompute/mesh/surface.hpp"

namespace irdm::precompute {
namespace {

using Edge = std::pair<int, int>;                     // the lower node first
using EdgeOwners = std::map<Edge, std::vector<int>>;  // triangles at each edge

std::string place(const SurfaceMesh& surface, const Edge& edge) {
  return "from " + place(surface, edge.first) + " to " + place(surface, edge.second);
}

EdgeOwners edge_owners(const SurfaceMesh& surface) {
  EdgeOwners owners;
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      owners[std::minmax({surface.triangles(t, i), surface.triangles(t, (i + 1) % 3)})].push_back(
          t);
    }
  }
  return owners;
}

std::string edges(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " edge" : " edges");
}

void check_edges(const SurfaceMesh& surface, const EdgeOwners& owners, const std::string& name,
                 const std::string& crowded_remedy) {
  std::vector<Edge> open;
  std::vector<Edge> crowded;
  for (const auto& [edge, triangles] : owners) {
    if (triangles.size() == 1) open.push_back(edge);
    if (triangles.size() > 2) crowded.push_back(edge);
  }
  if (!open.empty()) {
    throw Error(name,
                "the surface is open at " + edges(open.size()) + ", for instance " +
                    place(surface, open.front()),
                "close the hole there with the program that made it");
  }
  if (!crowded.empty()) {
    throw Error(name,
                "the surface is not manifold: more than two triangles meet at " +
                    edges(crowded.size()) + ", for instance " + place(surface, crowded.front()),
                crowded_remedy);
  }
}

// Whether triangle t runs along the edge from `a` to `b`.
bool runs(const SurfaceMesh& surface, int t, int a, int b) {
  for (int i = 0; i < 3; ++i) {
    if (surface.triangles(t, i) == a && surface.triangles(t, (i + 1) % 3) == b) return true;
  }
  return false;
}

// Turns the triangles that can be reached from the first one as that one is; which these are.
std::vector<bool> turn_alike(SurfaceMesh& surface, const EdgeOwners& owners) {
  std::vector<bool> reached(static_cast<std::size_t>(surface.triangles.rows()), false);
  reached.front() = true;
  for (std::vector<int> pending{0}; !pending.empty();) {
    const int t = pending.back();
    pending.pop_back();
    for (int i = 0; i < 3; ++i) {
      const int a = surface.triangles(t, i);
      const int b = surface.triangles(t, (i + 1) % 3);
      for (const int other : owners.at(std::minmax(a, b))) {
        if (reached[static_cast<std::size_t>(other)]) continue;
        reached[static_cast<std::size_t>(other)] = true;
        // Neighbours run along their common edge in opposite directions.
        if (runs(surface, other, a, b)) {
          std::swap(surface.triangles(other, 1), surface.triangles(other, 2));
        }
        pending.push_back(other);
      }
    }
  }
  return reached;
}

}  // namespace

SurfaceMesh checked_surface(const SurfaceMesh& surface, const std::string& name) {
  if (surface.triangles.rows() < 4) {
    throw Error(name, "has " + std::to_string(surface.triangles.rows()) + " triangles",
                "give a closed surface of triangles");
  }
  const EdgeOwners owners = edge_owners(surface);
  check_edges(surface, owners, name, "remove double triangles and inner walls there");
  SurfaceMesh turned = surface;
  const std::vector<bool> reached = turn_alike(turned, owners);
  const auto other = std::find(reached.begin(), reached.end(), false);
  if (other != reached.end()) {
    const auto t = static_cast<Eigen::Index>(other - reached.begin());
    throw Error(
        name,
        "the surface is in more than one piece: " + place(surface, surface.triangles(0, 0)) +
            " and " + place(surface, surface.triangles(t, 0)) + " are not connected",
        "keep one closed surface; a cavity inside it needs a tetrahedral mesh");
  }
  return turned;
}

namespace {

constexpr double kLargestSize = 10.0;   // [m]
constexpr double kSmallestSize = 1e-4;  // [m]

}  // namespace

double mean_ratio(const TetMesh& mesh, int e) {
  double squares = 0.0;
  for (const auto& [i, j] : kTetEdges) {
    squares += (mesh.position(mesh.tets(e, i)) - mesh.position(mesh.tets(e, j))).squaredNorm();
  }
  return 12.0 * std::pow(3.0 * signed_volume(mesh, e), 2.0 / 3.0) / squares;
}

std::optional<std::string> flattest_element(const TetMesh& mesh) {
  int flattest = 0;
  for (int e = 1; e < mesh.tet_count(); ++e) {
    if (mean_ratio(mesh, e) < mean_ratio(mesh, flattest)) flattest = e;
  }
  const double quality = mean_ratio(mesh, flattest);
  if (quality > kFlatMeanRatio) return std::nullopt;
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%.2g", quality);
  return tetrahedron_text(mesh, flattest) + " m, which is flat (mean ratio " + ratio + ")";
}

MeshReport report_mesh(const TetMesh& mesh) {
  std::vector<double> quality;
  for (int e = 0; e < mesh.tet_count(); ++e) quality.push_back(mean_ratio(mesh, e));
  std::sort(quality.begin(), quality.end());
  return {(mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).transpose(),
          quality.front(), quality[quality.size() / 2]};
}

std::string format_extent(const Vector3& extent) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g x %.4g x %.4g m", extent.x(), extent.y(), extent.z());
  return text;
}

std::optional<std::string> unit_hint(const Vector3& extent) {
  const double size = extent.maxCoeff();
  if (size <= kLargestSize && size >= kSmallestSize) return std::nullopt;
  const std::string found = "the body is " + format_extent(extent);
  if (size > kLargestSize) {
    return found +
           "; if the mesh file is in millimetres or centimetres, set mesh.unit = \"mm\" or "
           "\"cm\"";
  }
  return found + "; if the mesh file is in larger units, mind mesh.unit (\"m\" unless given)";
}

namespace {

// A tetrahedron is flat when its volume is below this share of its longest edge cubed (a regular
// one has 0.118); far below the worst slivers of mesh generators.
constexpr double kSmallestVolume = 1e-9;

void check_coordinates(const TetMesh& mesh, const std::string& name) {
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (mesh.nodes.row(i).allFinite()) continue;
    throw Error(
        name,
        "the node at " + place_text(mesh.position(i)) + " has a coordinate that is not finite",
        "write the mesh again");
  }
}

void check_indices(const TetMesh& mesh, const std::string& name) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.node_count()), false);
  for (int e = 0; e < mesh.tet_count(); ++e) {
    for (int i = 0; i < mesh.tets.cols(); ++i) {
      const int node = mesh.tets(e, i);
      if (node < 0 || node >= mesh.node_count()) {
        throw Error(name,
                    "tetrahedron " + std::to_string(e + 1) + " uses a node that does not exist",
                    "write the mesh again");
      }
      used[static_cast<std::size_t>(node)] = true;
      for (int j = 0; j < i; ++j) {
        if (mesh.tets(e, j) != node) continue;
        throw Error(name,
                    "a tetrahedron uses the node at " + place_text(mesh.position(node)) + " twice",
                    "remove degenerate elements");
      }
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    throw Error(name,
                "the node at " + place_text(mesh.position(static_cast<int>(i))) +
                    " belongs to no tetrahedron",
                "remove unused nodes");
  }
}

double longest_edge(const TetMesh& mesh, int e) {
  double longest = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      const Vector3 edge = mesh.position(mesh.tets(e, i)) - mesh.position(mesh.tets(e, j));
      longest = std::max(longest, edge.norm());
    }
  }
  return longest;
}

void check_volumes(const TetMesh& mesh, const std::string& name) {
  int first = -1;
  int inverted = 0;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const double volume = signed_volume(mesh, e);
    if (!(std::abs(volume) > kSmallestVolume * std::pow(longest_edge(mesh, e), 3))) {
      throw Error(name, tetrahedron_text(mesh, e) + " has zero volume",
                  "repair or optimise the mesh");
    }
    if (volume > 0.0) continue;
    if (inverted++ == 0) first = e;
  }
  if (inverted == 0) return;
  if (inverted == mesh.tet_count()) {
    throw Error(name, "all " + std::to_string(inverted) + " tetrahedra are inverted",
                "the file orders the nodes of an element the other way round: exchange two nodes "
                "of every element");
  }
  throw Error(name,
              std::to_string(inverted) + " of " + std::to_string(mesh.tet_count()) +
                  " tetrahedra are inverted, for instance " + tetrahedron_text(mesh, first),
              "repair the mesh");
}

// Where an element folds over first: at its corners, but for coarse meshes of strongly curved
// edges.
bool folds(const TetMesh& mesh, int e) {
  for (int i = 0; i < 4; ++i) {
    if (!(jacobian(mesh, e, Eigen::Vector4d::Unit(i)).determinant() > 0.0)) return true;
  }
  return !(jacobian(mesh, e, Eigen::Vector4d::Constant(0.25)).determinant() > 0.0);
}

void check_curved(const TetMesh& mesh, const std::string& name) {
  for (int e = 0; e < mesh.tet_count(); ++e) {
    if (is_straight(mesh, e) || !folds(mesh, e)) continue;
    throw Error(name, tetrahedron_text(mesh, e) + " folds over: its edges are curved too much",
                "make it smaller, or let gmsh move the nodes (Mesh.HighOrderOptimize = 2)");
  }
}

class Pieces {
 public:
  explicit Pieces(int count) : parent_(static_cast<std::size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    int& parent = parent_[static_cast<std::size_t>(i)];
    while (parent_[static_cast<std::size_t>(parent)] != parent) {
      parent = parent_[static_cast<std::size_t>(parent)];
    }
    return parent;
  }
  void join(int i, int j) { parent_[static_cast<std::size_t>(find(i))] = find(j); }

 private:
  std::vector<int> parent_;
};

void check_connected(const TetMesh& mesh, const std::string& name) {
  Pieces pieces(mesh.tet_count());
  for (const auto& [nodes, owners] : faces_by_nodes(mesh)) {
    for (const TetFace& owner : owners) pieces.join(owners.front().tet, owner.tet);
  }
  int count = 0;
  for (int e = 0; e < mesh.tet_count(); ++e) count += pieces.find(e) == e ? 1 : 0;
  if (count == 1) return;
  throw Error(name,
              "the mesh falls into " + std::to_string(count) +
                  " pieces that share no face of a tetrahedron",
              "keep one piece or join them conformingly");
}

void check_surface(const TetMesh& mesh, const std::string& name) {
  const Triangles triangles = boundary_faces(mesh, name);
  check_edges({mesh.nodes, triangles}, edge_owners({mesh.nodes, triangles}), name,
              "separate or join the parts that touch there");
}

}  // namespace

void check_mesh(const TetMesh& mesh, const std::string& name) {
  if (mesh.tet_count() == 0 || mesh.node_count() < 4) {
    throw Error(name, "there are no tetrahedra", "make a volume mesh of linear tetrahedra");
  }
  check_coordinates(mesh, name);
  check_indices(mesh, name);
  check_volumes(mesh, name);
  check_curved(mesh, name);
  check_connected(mesh, name);
  check_surface(mesh, name);
}

}  // namespace irdm::precompute
