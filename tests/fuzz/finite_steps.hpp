#pragma once

#include "common/model/model.hpp"

namespace irdm::fuzz {

/// What is read must render: an object of this model is pressed by a stylus for 20 steps, on a
/// floor where it floats, and everything stays finite.
void press(Model model);

}  // namespace irdm::fuzz
