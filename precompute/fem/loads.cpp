#include "precompute/fem/loads.hpp"

namespace irdm::precompute {

Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> centrifugal_loads(
    const Points& nodes, const Eigen::VectorXd& mass) {
  Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> loads(3 * nodes.rows(), kSpinProducts);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const double x = nodes(i, 0);
    const double y = nodes(i, 1);
    const double z = nodes(i, 2);
    Eigen::Matrix<double, 3, kSpinProducts> load;
    // One column each: xx, yy, zz push away from the axis, the mixed ones take -w (w . X) apart.
    load << 0, x, x, 0, -z, -y,  //
        y, 0, y, -z, 0, -x,      //
        z, z, 0, -y, -x, 0;
    loads.middleRows<3>(3 * i) = mass(i) * load;
  }
  return loads;
}

Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> loads(3 * mass.size(), 3);
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    loads.middleRows<3>(3 * i) = mass(i) * Eigen::Matrix3d::Identity();
  }
  return loads;
}

}  // namespace irdm::precompute
