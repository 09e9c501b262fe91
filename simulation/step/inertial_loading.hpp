#pragma once

#include <string>

#include "common/model/model.hpp"

namespace irdm {

/// Whether the body's own spin is to load its elastic part. A fixed body has none.
inline bool has_inertial_loading(const Model& model, bool inertial_loading) {
  return inertial_loading && model.body.support == Support::kFloating;
}

/// Throws Error, naming `where` (the model file), when the model cannot say what its spin does.
void check_inertial_loading(const Model& model, bool inertial_loading, const std::string& where);

}  // namespace irdm
