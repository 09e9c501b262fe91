#pragma once

#include <memory>
#include <utility>

#include "tests/support/fixed_box.hpp"

namespace irdm::test {

inline constexpr double kTop = 0.06;  ///< height of the cube's top [m]

/// A clamped cube of 12 cm with elements of 30 mm, twice as large as the balls.
inline std::shared_ptr<const Model> coarse_cube(double dt = 0.002, int order = 2) {
  FixedBox box;
  box.cells = {4, 4, 4};
  box.order = order;
  Model model = *fixed_box(box);
  model.dt = dt;
  return std::make_shared<const Model>(std::move(model));
}

}  // namespace irdm::test
