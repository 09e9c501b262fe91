#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "common/model/model.hpp"

/// Bodies whose surface yields as an incompressible elastic half-space, by its Green's functions
/// (Boussinesq, Cerruti; Johnson, Contact Mechanics, 3.2, 3.6): what finite elements of finite
/// bodies reach only in the limit. Quasi-static: R[0] is the static compliance, and there is no
/// R[1].
namespace irdm::test {

/// The upper face is a paraboloid y = -r^2 / (2 radius) on a square grid; the other faces are
/// rigid.
struct HalfSpace {
  int cells = 14;               ///< an edge of the grid, even
  double spacing = 1e-3;        ///< of the grid [m]
  double radius = 0.1;          ///< of curvature [m]; infinite: flat
  double youngs_modulus = 1e5;  ///< E [Pa], nu = 0.5
  double mass = 0.1;            ///< [kg]
  Support support = Support::kFloating;
};

/// Displacement at a distance (x, z) along the surface per force of 1 N on the origin [m/N]; frame
/// with y along the outward normal; nu = 0.5, where normal and tangential do not couple.
inline Matrix3 point_compliance(double youngs_modulus, double x, double z) {
  const double shear = youngs_modulus / 3.0;
  const double r = std::hypot(x, z);
  const double scale = 1.0 / (4.0 * std::numbers::pi * shear);
  Matrix3 u = Matrix3::Zero();
  u(1, 1) = scale / r;
  u(0, 0) = scale * (1.0 / r + x * x / (r * r * r));
  u(2, 2) = scale * (1.0 / r + z * z / (r * r * r));
  u(0, 2) = u(2, 0) = scale * x * z / (r * r * r);
  return u;
}

/// The same between two nodes of a grid, force and displacement weighted with the product of linear
/// hat functions round each, by midpoints of small squares; for the square itself its mean.
inline Matrix3 hat_compliance(double youngs_modulus, double spacing, double x, double z) {
  constexpr int kParts = 8;  // of a spacing
  const double h = spacing / kParts;
  const auto weight = [&](int i) { return (1.0 - std::abs((i + 0.5) / kParts - 1.0)) / kParts; };
  // Mean displacement of a square under uniform pressure over that of a point at distance h.
  const double own =
      4.0 * std::log(1.0 + std::numbers::sqrt2) - 4.0 / 3.0 * (std::numbers::sqrt2 - 1.0);
  Matrix3 sum = Matrix3::Zero();
  // Offsets between midpoints come with the products of weights along each axis.
  std::vector<double> along(4 * kParts, 0.0);
  for (int i = 0; i < 2 * kParts; ++i) {
    for (int j = 0; j < 2 * kParts; ++j) {
      along[static_cast<std::size_t>(i - j + 2 * kParts)] += weight(i) * weight(j);
    }
  }
  for (int i = 1; i < 4 * kParts; ++i) {
    for (int k = 1; k < 4 * kParts; ++k) {
      const double dx = x + (i - 2 * kParts) * h;
      const double dz = z + (k - 2 * kParts) * h;
      const double share = along[static_cast<std::size_t>(i)] * along[static_cast<std::size_t>(k)];
      if (std::hypot(dx, dz) > 0.5 * h) {
        sum += share * point_compliance(youngs_modulus, dx, dz);
      } else {
        // On a square x^2 / r^2 is one half in the mean.
        const double mean = own / h / (4.0 * std::numbers::pi * youngs_modulus / 3.0);
        sum += share * mean * Vector3(1.5, 1.0, 1.5).asDiagonal().toDenseMatrix();
      }
    }
  }
  return sum;
}

inline std::shared_ptr<const Model> half_space(const HalfSpace& body) {
  auto model = std::make_shared<Model>();
  const int edge = body.cells + 1;
  const int top = edge * edge;
  const double half = 0.5 * body.cells * body.spacing;
  const double depth = 4.0 * half;
  // The grid above, and the same below; between them walls.
  model->mesh.nodes.resize(2 * top, 3);
  for (int i = 0; i < edge; ++i) {
    for (int k = 0; k < edge; ++k) {
      const double x = i * body.spacing - half;
      const double z = k * body.spacing - half;
      const double y = std::isinf(body.radius) ? 0.0 : -(x * x + z * z) / (2.0 * body.radius);
      model->mesh.nodes.row(i * edge + k) << x, y, z;
      model->mesh.nodes.row(top + i * edge + k) << x, -depth, z;
    }
  }
  std::vector<std::array<int, 3>> triangles;
  const auto quad = [&](int a, int b, int c, int d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  };
  for (int i = 0; i < body.cells; ++i) {
    for (int k = 0; k < body.cells; ++k) {
      const int a = i * edge + k;
      quad(a, a + 1, a + edge + 1, a + edge);
      quad(top + a, top + a + edge, top + a + edge + 1, top + a + 1);
    }
    const int last = body.cells;
    const auto at = [&](int p, int q) { return p * edge + q; };
    quad(at(i, 0), at(i + 1, 0), top + at(i + 1, 0), top + at(i, 0));
    quad(at(i + 1, last), at(i, last), top + at(i, last), top + at(i + 1, last));
    quad(at(0, i + 1), at(0, i), top + at(0, i), top + at(0, i + 1));
    quad(at(last, i), at(last, i + 1), top + at(last, i + 1), top + at(last, i));
  }
  model->mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    model->mesh.triangles.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1],
        triangles[t][2];
  }
  for (int i = 0; i < 2 * top; ++i) model->mesh.surface_nodes.push_back(i);
  model->mesh.node_mass = Eigen::VectorXd::Constant(2 * top, body.mass / (2 * top));
  model->body.mass = body.mass;
  model->body.inertia = body.mass * depth * depth * Matrix3::Identity();
  model->body.support = body.support;
  model->material = {body.youngs_modulus, 0.5, 1000.0, 0.0, 0.0};
  model->dt = 0.002;
  model->steps = 2;

  DenseResponse response;
  response.degrees_of_freedom = 6 * top;
  response.steps = 2;
  const auto dof = static_cast<std::size_t>(6 * top);
  std::vector<float> values(2 * dof * dof, 0.0F);
  std::vector<Matrix3> by_offset;  // of |di|, |dk|
  for (int di = 0; di < edge; ++di) {
    for (int dk = 0; dk < edge; ++dk) {
      by_offset.push_back(
          hat_compliance(body.youngs_modulus, body.spacing, di * body.spacing, dk * body.spacing));
    }
  }
  for (int to = 0; to < top; ++to) {
    for (int from = 0; from < top; ++from) {
      const int di = to / edge - from / edge;
      const int dk = to % edge - from % edge;
      Matrix3 u = by_offset[static_cast<std::size_t>(std::abs(di) * edge + std::abs(dk))];
      if (di * dk < 0) u(0, 2) = u(2, 0) = -u(0, 2);
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          const std::size_t entry =
              static_cast<std::size_t>(3 * from + b) * dof + static_cast<std::size_t>(3 * to + a);
          values[2 * entry] = static_cast<float>(u(a, b));
        }
      }
    }
  }
  response.values = std::move(values);
  model->response = std::move(response);
  return model;
}

}  // namespace irdm::test
