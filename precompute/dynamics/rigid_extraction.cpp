#include "precompute/dynamics/rigid_extraction.hpp"

#include "precompute/dynamics/corotational.hpp"

namespace irdm::precompute {
namespace {

Vector3 mass_mean(const Points& vectors, const Eigen::VectorXd& mass) {
  return vectors.transpose() * mass / mass.sum();
}

Eigen::VectorXd rotation_weights(const Eigen::VectorXd& mass, RotationWeights weights) {
  if (weights == RotationWeights::kMass) return mass;
  return Eigen::VectorXd::Ones(mass.size());
}

}  // namespace

RigidMotion extract_rigid_motion(const Points& rest, const Points& displacement,
                                 const Eigen::VectorXd& mass, RotationWeights weights) {
  const Vector3 translation = mass_mean(displacement, mass);
  const Points arms = rest + (displacement.rowwise() - translation.transpose());
  const Matrix3 moment = arms.transpose() * rotation_weights(mass, weights).asDiagonal() * rest;
  return {translation, polar_rotation(moment / moment.norm())};
}

Points elastic_part(const Points& rest, const Points& displacement, const RigidMotion& motion) {
  // Rows are transposed vectors: Q^T a stands as a^T Q. Small displacements keep their digits.
  return (displacement.rowwise() - motion.translation.transpose()) * motion.rotation +
         rest * (motion.rotation - Matrix3::Identity());
}

Points linear_elastic_part(const Points& rest, const Points& displacement,
                           const Eigen::VectorXd& mass, RotationWeights weights) {
  const Eigen::VectorXd w = rotation_weights(mass, weights);
  Points e = displacement.rowwise() - mass_mean(displacement, mass).transpose();
  const Matrix3 second = rest.transpose() * w.asDiagonal() * rest;
  const Matrix3 inertia = second.trace() * Matrix3::Identity() - second;
  Vector3 moment = Vector3::Zero();
  for (Eigen::Index i = 0; i < e.rows(); ++i) {
    moment += w(i) * Vector3(rest.row(i)).cross(Vector3(e.row(i)));
  }
  // w x X as a row: X^T skew(w)^T.
  e -= rest * skew(inertia.ldlt().solve(moment)).transpose();
  return e;
}

}  // namespace irdm::precompute
