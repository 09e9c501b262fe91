#include "tests/support/fem_contact.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

#include "precompute/fem/assembly.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::test {
namespace {

using namespace irdm::precompute;

constexpr double kOnFace = 1e-9;    // [m]
constexpr double kEdge = -1e-9;     // of a triangle, in barycentric weights
constexpr int kMostRounds = 100;    // of the active set
constexpr double kRounding = 1e-9;  // of the force

/// A node of the mesh with its share of a point.
struct Share {
  int node;
  double weight;
};
using Point = std::vector<Share>;

/// Contact i: a point of either body.
struct Constraint {
  Point upper;
  Point lower;
  double gap = 0.0;               ///< along y [m]
  Vector3 arm = Vector3::Zero();  ///< from the upper body's centre of mass [m], W
};

Vector3 in_world(const FemContactBody& body, int node) {
  return body.position + body.orientation * Vector3(body.mesh.nodes.row(node).transpose());
}

// The triangles of the face of greatest y, as mesh nodes.
std::vector<std::array<int, 3>> top_face(const FemContactBody& body) {
  double top = -std::numeric_limits<double>::infinity();
  for (const int node : body.mesh.surface_nodes) top = std::max(top, in_world(body, node).y());
  std::vector<std::array<int, 3>> face;
  for (Eigen::Index t = 0; t < body.mesh.triangles.rows(); ++t) {
    std::array<int, 3> corners{};
    bool on = true;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = body.mesh.surface_nodes[static_cast<std::size_t>(
          body.mesh.triangles(t, static_cast<Eigen::Index>(i)))];
      on = on && in_world(body, corners[i]).y() > top - kOnFace;
    }
    if (on) face.push_back(corners);
  }
  return face;
}

// Of each node: what it has of the triangles that face down, a third of each, seen from below. Of
// quadratic elements, whose faces are cut into four linear triangles, it is a node's share of
// these.
std::vector<double> horizontal_areas(const FemContactBody& body) {
  std::vector<double> areas(static_cast<std::size_t>(body.mesh.nodes.rows()), 0.0);
  for (Eigen::Index t = 0; t < body.mesh.triangles.rows(); ++t) {
    std::array<int, 3> node{};
    for (std::size_t i = 0; i < 3; ++i) {
      node[i] = body.mesh.surface_nodes[static_cast<std::size_t>(
          body.mesh.triangles(t, static_cast<Eigen::Index>(i)))];
    }
    const Vector3 a = in_world(body, node[0]);
    const double down = -0.5 * (in_world(body, node[1]) - a).cross(in_world(body, node[2]) - a).y();
    for (const int n : node) areas[static_cast<std::size_t>(n)] += std::max(0.0, down) / 3.0;
  }
  return areas;
}

// Where a vertical line through x meets a triangle: weights of its corners.
std::optional<Vector3> below(const Vector3& x, const Vector3& a, const Vector3& b,
                             const Vector3& c) {
  Matrix3 corners;
  corners << a.x(), b.x(), c.x(), a.z(), b.z(), c.z(), 1.0, 1.0, 1.0;
  const Vector3 weights = corners.inverse() * Vector3(x.x(), x.z(), 1.0);
  if (weights.minCoeff() < kEdge) return std::nullopt;
  return weights;
}

std::vector<Constraint> constraints(const FemContactBody& lower, const FemContactBody& upper,
                                    double reach) {
  const std::vector<std::array<int, 3>> face = top_face(lower);
  std::vector<Constraint> all;
  for (const int node : upper.mesh.surface_nodes) {
    const Vector3 x = in_world(upper, node);
    for (const std::array<int, 3>& corners : face) {
      const Vector3 a = in_world(lower, corners[0]);
      if (x.y() - a.y() >= reach) break;
      const auto weights = below(x, a, in_world(lower, corners[1]), in_world(lower, corners[2]));
      if (!weights) continue;
      Point there;
      for (std::size_t i = 0; i < 3; ++i) {
        there.push_back({corners[i], (*weights)(static_cast<Eigen::Index>(i))});
      }
      all.push_back({{{node, 1.0}}, there, x.y() - a.y(), x - upper.position});
      break;
    }
  }
  return all;
}

// Displacement of the points per force on them, W, on directions alternating x, y, z: (3m, 3m).
Eigen::MatrixXd compliance(const FemContactBody& body, const std::vector<Point>& points) {
  const TetMesh mesh{body.mesh.nodes, body.mesh.tets, {}};
  const ElasticStatics statics(assemble_stiffness(mesh, body.material), mesh.nodes,
                               body.mesh.node_mass, {});
  Eigen::MatrixXd load =
      Eigen::MatrixXd::Zero(3 * mesh.nodes.rows(), 3 * static_cast<Eigen::Index>(points.size()));
  const Matrix3 to_body = body.orientation.toRotationMatrix().transpose();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const Share& share : points[i]) {
      load.block<3, 3>(3 * share.node, 3 * static_cast<Eigen::Index>(i)) += share.weight * to_body;
    }
  }
  return load.transpose() * statics.displacement(load);
}

/// Rows that are solved for: axis 0..2 of a contact.
struct Row {
  Eigen::Index contact;
  Eigen::Index axis;
  Eigen::Index of_compliance() const { return 3 * contact + axis; }
};

std::vector<Row> rows_of(const std::vector<bool>& closed, bool sticks) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (closed[i] && (sticks || axis == 1)) rows.push_back({static_cast<Eigen::Index>(i), axis});
    }
  }
  return rows;
}

// What the upper body's motions, along and about x, y, z, move each contact by: (3m, 6).
Eigen::MatrixXd moved_by_body(const std::vector<Constraint>& contacts) {
  Eigen::MatrixXd G(3 * static_cast<Eigen::Index>(contacts.size()), 6);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    G.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << Matrix3::Identity(),
        -skew(contacts[i].arm);
  }
  return G;
}

/// Forces on the upper body and its motion, of one set of closed contacts.
struct Equilibrium {
  Eigen::VectorXd force;   ///< (3m) [N]
  Eigen::VectorXd motion;  ///< (6) [m], [rad]
};

// (C, G; G^T, 0) (f; q) = (-gap; -load)
Equilibrium equilibrium(const Eigen::MatrixXd& C, const Eigen::MatrixXd& G,
                        const Eigen::VectorXd& gap, const FemPress& press,
                        const std::vector<Row>& rows) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (press.moves[static_cast<std::size_t>(k)]) free.push_back(k);
  }
  std::vector<Eigen::Index> of;
  for (const Row& row : rows) of.push_back(row.of_compliance());
  const auto m = static_cast<Eigen::Index>(of.size());
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(m + n, m + n);
  A.topLeftCorner(m, m) = C(of, of);
  A.topRightCorner(m, n) = G(of, free);
  A.bottomLeftCorner(n, m) = G(of, free).transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(m + n);
  right.head(m) = -gap(of);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (free[static_cast<std::size_t>(k)] == 1) right(m + k) = press.force;
  }
  // The motions in units of the compliance: else the matrix is badly scaled.
  const double scale = C.diagonal().mean();
  A.topRightCorner(m, n) *= scale;
  A.bottomLeftCorner(n, m) *= scale;
  right.tail(n) *= scale;
  const Eigen::VectorXd x = A.fullPivLu().solve(right);
  Equilibrium found{Eigen::VectorXd::Zero(C.rows()), Eigen::VectorXd::Zero(6)};
  found.force(of) = x.head(m);
  found.motion(free) = scale * x.tail(n);
  return found;
}

// Those that touch first: where the active set begins.
std::vector<bool> lowest(const std::vector<Constraint>& contacts) {
  double least = std::numeric_limits<double>::infinity();
  for (const Constraint& contact : contacts) least = std::min(least, contact.gap);
  std::vector<bool> closed;
  for (const Constraint& contact : contacts) closed.push_back(contact.gap < least + kOnFace);
  return closed;
}

}  // namespace

FemContactBody fine_cube(int cells, int order, const Material& material) {
  TetMesh mesh = tetrahedralise(box_surface(Vector3::Constant(0.12), {cells, cells, cells}));
  if (order == 2) mesh = quadratic_mesh(mesh);
  const Surface surface = extract_surface(mesh, "cube");
  FemContactBody body;
  body.material = material;
  body.mesh.node_mass = lumped_mass(mesh, material);
  body.mesh.com_offset = nodal_mass_properties(mesh.nodes, body.mesh.node_mass).centre_of_mass;
  mesh.nodes.rowwise() -= body.mesh.com_offset.transpose();
  body.mesh.nodes = mesh.nodes;
  body.mesh.tets = mesh.tets;
  body.mesh.surface_nodes = surface.nodes;
  body.mesh.triangles = surface.triangles;
  return body;
}

FemContact fem_contact(const FemContactBody& lower, const FemContactBody& upper,
                       const FemPress& press, double reach) {
  const std::vector<Constraint> contacts = constraints(lower, upper, reach);
  if (contacts.empty()) throw std::runtime_error("no node faces the other body");
  std::vector<Point> above;
  std::vector<Point> under;
  Eigen::VectorXd gap = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    above.push_back(contacts[i].upper);
    under.push_back(contacts[i].lower);
    gap(3 * static_cast<Eigen::Index>(i) + 1) = contacts[i].gap;
  }
  const Eigen::MatrixXd C = compliance(upper, above) + compliance(lower, under);
  const Eigen::MatrixXd G = moved_by_body(contacts);

  FemContact found;
  found.gap.resize(static_cast<Eigen::Index>(contacts.size()));
  std::vector<bool> closed = lowest(contacts);
  Equilibrium at;
  int rounds = 0;
  for (bool settled = false; !settled; ++rounds) {
    if (rounds == kMostRounds) throw std::runtime_error("contact does not settle");
    at = equilibrium(C, G, gap, press, rows_of(closed, press.sticks));
    const Eigen::VectorXd left = gap + C * at.force + G * at.motion;
    settled = true;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Eigen::Index normal = 3 * static_cast<Eigen::Index>(i) + 1;
      const bool wrong = closed[i] ? at.force(normal) < -kRounding * press.force
                                   : left(normal) < -kRounding * C(normal, normal) * press.force;
      if (wrong) closed[i] = !closed[i];
      settled = settled && !wrong;
      found.gap(static_cast<Eigen::Index>(i)) = left(normal);
    }
  }
  found.approach = -at.motion(1);
  found.position.resize(static_cast<Eigen::Index>(contacts.size()), 3);
  found.force = Eigen::Map<const Points>(at.force.data(), found.position.rows(), 3);
  const std::vector<double> areas = horizontal_areas(upper);
  found.area.resize(found.position.rows());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    found.area(static_cast<Eigen::Index>(i)) =
        areas[static_cast<std::size_t>(contacts[i].upper.front().node)];
    found.position.row(static_cast<Eigen::Index>(i)) =
        (upper.position + contacts[i].arm).transpose();
  }
  return found;
}

}  // namespace irdm::test
