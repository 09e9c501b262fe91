#pragma once

#include <optional>
#include <string>

#include "common/model/model.hpp"

namespace irdm {

/// What is wrong with the modes of a model whose description holds: frequencies that increase and
/// decay rates within lab_ranges.hpp; shapes that can be mass-normalised and add up to a compliance
/// that a body can have; loads of spin and gravity that modes can feel. Nothing when all of that
/// holds.
/// @param response its rows and columns fit the model
std::optional<std::string> modal_fault(const Model& model, const ModalResponse& response);

}  // namespace irdm
