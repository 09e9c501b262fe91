#include "precompute/dynamics/neo_hookean.hpp"

#include <cmath>
#include <limits>

namespace irdm::precompute::neo_hookean {
namespace {

// C - Id, without the noise that C itself would leave in small strains.
Matrix3 excess(const Matrix3& du_dX) {
  const bool inside_out = (Matrix3::Identity() + du_dX).determinant() <= 0.0;
  if (inside_out) return Matrix3::Constant(std::numeric_limits<double>::quiet_NaN());
  return du_dX + du_dX.transpose() + du_dX.transpose() * du_dX;
}

// Of det C - 1 = tr A + (tr^2 A - tr A^2)/2 + det A with A = C - Id.
double log_J(const Matrix3& A) {
  const double trace = A.trace();
  return 0.5 * std::log1p(trace + 0.5 * (trace * trace - A.squaredNorm()) + A.determinant());
}

double energy_of(const Matrix3& A, const Lame& lame) {
  const double log = log_J(A);
  return lame.mu * (0.5 * A.trace() - log) + 0.5 * lame.lambda * log * log;
}

// Id - C^-1 = A C^-1.
Matrix3 second_stress(const Matrix3& A, const Lame& lame) {
  const Matrix3 inverse_C = (Matrix3::Identity() + A).inverse();
  const Matrix3 S = (lame.mu * A + lame.lambda * log_J(A) * Matrix3::Identity()) * inverse_C;
  return 0.5 * (S + S.transpose());
}

}  // namespace

double energy_density(const Matrix3& du_dX, const Lame& lame) {
  return energy_of(excess(du_dX), lame);
}

Matrix3 stress(const Matrix3& du_dX, const Matrix3& dv_dX, const Lame& lame, double beta) {
  const Matrix3 F = Matrix3::Identity() + du_dX;
  return F *
         (second_stress(excess(du_dX), lame) + lame_stress(beta * (F.transpose() * dv_dX), lame));
}

Matrix3 mean_stress(const Matrix3& du_dX0, const Matrix3& du_dX1, double h, const Lame& lame,
                    double beta) {
  // Below it the correction is less than the rounding of the energies that it is made of.
  constexpr double kSmallChange = 1e-6;
  const Matrix3 middle = Matrix3::Identity() + 0.5 * (du_dX0 + du_dX1);
  const Matrix3 A0 = excess(du_dX0);
  const Matrix3 A1 = excess(du_dX1);
  const Matrix3 turned = middle.transpose() * (du_dX1 - du_dX0);
  const Matrix3 change = turned + turned.transpose();
  Matrix3 S = second_stress(0.5 * (A0 + A1), lame);
  if (change.norm() > kSmallChange) {
    const double left =
        2.0 * (energy_of(A1, lame) - energy_of(A0, lame)) - S.cwiseProduct(change).sum();
    S += left / change.squaredNorm() * change;
  }
  return middle * (S + lame_stress((0.5 * beta / h) * change, lame));
}

Tangent::Tangent(const Matrix3& du_dX, const Lame& lame)
    : inverse_F_((Matrix3::Identity() + du_dX).inverse()), lambda_(lame.lambda) {
  const Matrix3 A = excess(du_dX);
  S_ = second_stress(A, lame);
  mu_ = lame.mu - lame.lambda * log_J(A);
}

Matrix3 Tangent::block(const Vector3& gi, const Vector3& gj) const {
  const Vector3 ai = inverse_F_.transpose() * gi;
  const Vector3 aj = inverse_F_.transpose() * gj;
  return lambda_ * ai * aj.transpose() + mu_ * aj * ai.transpose() +
         (mu_ * ai.dot(aj) + gi.dot(S_ * gj)) * Matrix3::Identity();
}

}  // namespace irdm::precompute::neo_hookean
