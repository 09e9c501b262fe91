#pragma once

#include <Eigen/Dense>
#include <array>

/// Frames: W world, B object body frame (origin at the centre of mass of the rest shape, axes of
/// the input mesh), D device. A name such as `tip_W` ends in the frame that its components are
/// given in. SI units everywhere (m, kg, s, N).
namespace irdm {

static_assert(EIGEN_MAX_ALIGN_BYTES == 16 && EIGEN_MALLOC_ALREADY_ALIGNED == 0,
              "compile with the definitions of irdm's CMake targets: without them matrices of this "
              "program and of irdm's libraries are laid out differently");

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Quaternion = Eigen::Quaterniond;

/// n points or vectors, one a row: shape (n, 3).
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// t triangles, three indices a row: shape (t, 3).
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The matrix of the cross product: skew(a) b = a x b.
inline Matrix3 skew(const Vector3& a) {
  Matrix3 s;
  s << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return s;
}

/// A point of the deformable surface: the corners of its triangle (surface node numbers) and their
/// barycentric weights, which sum to one. A node is a weight of 1.
struct SurfacePoint {
  std::array<int, 3> nodes{0, 0, 0};
  std::array<double, 3> weights{1.0, 0.0, 0.0};
};

}  // namespace irdm
