#include "simulation/step/inertial_loading.hpp"

#include "common/error.hpp"

namespace irdm {

void check_inertial_loading(const Model& model, bool inertial_loading, const std::string& where) {
  if (!has_inertial_loading(model, inertial_loading) || has_centrifugal(model)) return;
  const bool dense = !std::holds_alternative<ModalResponse>(model.response);
  throw Error(where,
              std::string("has no centrifugal response for engine = \"") +
                  (dense ? "dense" : "modal") + "\", which inertial_loading needs",
              "precompute it again with method = \"modal\", or leave inertial_loading out");
}

}  // namespace irdm
