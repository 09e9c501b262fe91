#include <algorithm>

#include "precompute/check/lines.hpp"
#include "precompute/check/step_error.hpp"

namespace irdm::precompute {
namespace {

constexpr double kNoticeable = 0.1;  // of force, by a finger

}  // namespace

Line step_line(const Model& model) {
  const auto distance = [&](int node) { return model.mesh.rest_position(node).norm(); };
  int nearest = -1;
  int farthest = -1;
  const auto& response = std::get<ModalResponse>(model.response);
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const bool moves =
        std::visit([&](const auto& shapes) { return !shapes.middleRows(3 * i, 3).isZero(0.0); },
                   response.shapes);
    if (!moves) continue;
    if (nearest < 0 || distance(i) < distance(nearest)) nearest = i;
    if (farthest < 0 || distance(i) > distance(farthest)) farthest = i;
  }
  if (nearest < 0) return {"step", Verdict::kNone, "no node moves"};
  const double error = std::max(step_error(model, nearest, 1.0), step_error(model, farthest, 1.0));
  const double factor = std::min(stiffness_for_error(model, nearest, kNoticeable),
                                 stiffness_for_error(model, farthest, kNoticeable));
  return {"step", error < kNoticeable ? Verdict::kOk : Verdict::kWarn,
          text("a node that is pushed and held is felt within %.2g %% of what short steps give; "
               "10 %% from a Young's modulus of %.2g N/m^2 on",
               100.0 * error, factor * model.material.youngs_modulus)};
}

}  // namespace irdm::precompute
