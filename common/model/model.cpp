#include "common/model/model.hpp"

namespace irdm {

bool has_centrifugal(const Model& model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return modal->centrifugal.rows() > 0;
  }
  const auto* dense = std::get_if<DenseResponse>(&model.response);
  return dense != nullptr &&
         std::visit([](const auto& values) { return !values.empty(); }, dense->centrifugal);
}

}  // namespace irdm
