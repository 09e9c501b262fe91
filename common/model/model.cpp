#include "common/model/model.hpp"

#include <algorithm>

namespace irdm {

Matrix3 ResidualCompliance::diagonal(int node) const {
  const auto found =
      std::lower_bound(nodes.begin() + begin_of(node), nodes.begin() + end_of(node), node);
  return block(static_cast<int>(found - nodes.begin())).cast<double>();
}

bool is_rigid(const Model& model) {
  return std::holds_alternative<RigidResponse>(model.response);
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

bool has_gravity(const Model& model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return modal->gravity.rows() > 0;
  }
  if (const auto* dense = std::get_if<DenseResponse>(&model.response)) {
    return !dense->gravity.empty();
  }
  const auto* streamed = std::get_if<StreamedResponse>(&model.response);
  return streamed != nullptr && !streamed->gravity.empty();
}

template <typename Number>
GravityResponse gravity_response(std::vector<Number> displacement, int degrees_of_freedom,
                                 int steps) {
  GravityResponse gravity;
  gravity.sag.resize(degrees_of_freedom, 3);
  auto column = displacement.begin();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (Eigen::Index a = 0; a < degrees_of_freedom; ++a) {
      const auto end = column + steps;
      const Number settled = *(end - 1);
      gravity.sag(a, axis) = static_cast<double>(settled);
      std::for_each(column, end, [settled](Number& value) { value -= settled; });
      column = end;
    }
  }
  gravity.approach = std::move(displacement);
  return gravity;
}

template GravityResponse gravity_response(std::vector<float>, int, int);
template GravityResponse gravity_response(std::vector<double>, int, int);

}  // namespace irdm
