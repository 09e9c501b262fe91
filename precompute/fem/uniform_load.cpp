#include "precompute/fem/uniform_load.hpp"

namespace irdm::precompute {

Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass) {
  Eigen::Matrix<double, Eigen::Dynamic, 3> loads(3 * mass.size(), 3);
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    loads.middleRows<3>(3 * i) = mass(i) * Eigen::Matrix3d::Identity();
  }
  return loads;
}

}  // namespace irdm::precompute
