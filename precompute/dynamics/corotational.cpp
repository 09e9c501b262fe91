#include "precompute/dynamics/corotational.hpp"

#include <cmath>

namespace irdm::precompute {
namespace {

Matrix3 by_singular_values(const Matrix3& F) {
  const Eigen::JacobiSVD<Matrix3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

Matrix3 cofactors(const Matrix3& a) {
  Matrix3 c;
  c.row(0) = a.row(1).cross(a.row(2));
  c.row(1) = a.row(2).cross(a.row(0));
  c.row(2) = a.row(0).cross(a.row(1));
  return c;
}

}  // namespace

Matrix3 polar_rotation(const Matrix3& F) {
  constexpr int kMaxIterations = 30;
  // A step this small leaves an error of its square.
  constexpr double kLastStep = 1e-9;
  const double size = F.norm();
  if (!(F.determinant() > 1e-9 * size * size * size)) return by_singular_values(F);
  Matrix3 q = F;
  for (int i = 0; i < kMaxIterations; ++i) {
    Matrix3 inverse_transposed = cofactors(q);
    inverse_transposed /= q.row(0).dot(inverse_transposed.row(0));
    double scale = std::sqrt(inverse_transposed.norm() / q.norm());
    if (std::abs(scale - 1.0) < 1e-2) scale = 1.0;
    const Matrix3 next = 0.5 * (scale * q + inverse_transposed / scale);
    const double step = (next - q).squaredNorm();
    q = next;
    if (step < kLastStep * kLastStep) return q;
  }
  return by_singular_values(F);
}

}  // namespace irdm::precompute

namespace irdm::precompute::corotational {
namespace {

// The vector a with skew(a) = m - m^T.
Vector3 twice_axial(const Matrix3& m) {
  return {m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)};
}

Matrix3 stretch(const Matrix3& F, const Matrix3& R) {
  const Matrix3 S = R.transpose() * F;
  return 0.5 * (S + S.transpose());
}

// (S - Id)(S + Id) = F^T F - Id, and that is H + H^T + H^T H: S - Id itself would leave 1e-16 of
// noise in strains of any size.
Matrix3 strain_of_stretch(const Matrix3& du_dX, const Matrix3& S) {
  const Matrix3 squared = du_dX + du_dX.transpose() + du_dX.transpose() * du_dX;
  const Matrix3 e = squared * (S + Matrix3::Identity()).inverse();
  return 0.5 * (e + e.transpose());
}

}  // namespace

Matrix3 strain(const Matrix3& du_dX) {
  const Matrix3 F = Matrix3::Identity() + du_dX;
  return strain_of_stretch(du_dX, stretch(F, polar_rotation(F)));
}

double energy_density(const Matrix3& strain, const Lame& lame) {
  return lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * strain.trace() * strain.trace();
}

Matrix3 stress(const Matrix3& du_dX, const Matrix3& dv_dX, const Lame& lame, double beta) {
  const Matrix3 F = Matrix3::Identity() + du_dX;
  const Matrix3 R = polar_rotation(F);
  const Matrix3 S = stretch(F, R);
  const Matrix3 elastic = lame_stress(strain_of_stretch(du_dX, S), lame);
  if (beta == 0.0) return R * elastic;
  // A = R^T dF/dt = dS/dt + W S with W = R^T dR/dt skew; that dS/dt is symmetric gives
  // (tr(S) Id - S) w = twice_axial(A). The stress whose power is T : dS/dt is R (T + skew(c)).
  const Matrix3 A = R.transpose() * dv_dX;
  const Matrix3 inverse_G = (S.trace() * Matrix3::Identity() - S).inverse();
  const Matrix3 S_rate = A - skew(inverse_G * twice_axial(A)) * S;
  const Matrix3 T = beta * lame_stress(S_rate, lame);
  return R * (elastic + T + skew(inverse_G * twice_axial(S * T)));
}

Matrix3 mean_stress(const Matrix3& du_dX0, const Matrix3& strain0, const Matrix3& du_dX1, double h,
                    const Lame& lame, double beta) {
  const Matrix3 strain1 = strain(du_dX1);
  const Matrix3 middle = 0.5 * (strain0 + strain1);
  const Matrix3 inverse_S = (Matrix3::Identity() + middle).inverse();
  Matrix3 sigma;
  if (beta == 0.0) {
    sigma = inverse_S * lame_stress(middle, lame);  // the factors commute
  } else {
    // Sigma = S^-1 (T + skew(z)) solves S Sigma + Sigma S = 2 T; it is symmetric when
    // S^-1 skew(z) + skew(z) S^-1 = T S^-1 - S^-1 T, that is (tr(S^-1) Id - S^-1) z = its axis.
    const Matrix3 T = lame_stress(middle + (beta / h) * (strain1 - strain0), lame);
    const Matrix3 G = inverse_S.trace() * Matrix3::Identity() - inverse_S;
    const Vector3 z = G.inverse() * twice_axial(T * inverse_S);
    sigma = inverse_S * (T + skew(z));
  }
  sigma = 0.5 * (sigma + sigma.transpose()).eval();
  return (Matrix3::Identity() + 0.5 * (du_dX0 + du_dX1)) * sigma;
}

}  // namespace irdm::precompute::corotational
