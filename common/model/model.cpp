#include "common/model/model.hpp"

#include <algorithm>

namespace irdm {

Matrix3 ResidualCompliance::diagonal(int node) const {
  const int begin = row_start[static_cast<std::size_t>(node)];
  const int end = row_start[static_cast<std::size_t>(node) + 1];
  const auto found = std::lower_bound(nodes.begin() + begin, nodes.begin() + end, node);
  const float* block = blocks.data() + 9 * (found - nodes.begin());
  return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(block).cast<double>();
}

bool has_centrifugal(const Model& model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return modal->centrifugal.rows() > 0;
  }
  const auto any = [](const auto& values) { return !values.empty(); };
  if (const auto* dense = std::get_if<DenseResponse>(&model.response)) {
    return std::visit(any, dense->centrifugal);
  }
  const auto* streamed = std::get_if<StreamedResponse>(&model.response);
  return streamed != nullptr && std::visit(any, streamed->centrifugal);
}

}  // namespace irdm
