#include "tests/support/fixed_box.hpp"

#include <sstream>

#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

std::shared_ptr<const Model> fixed_box(const FixedBox& box, ResponseKind kind) {
  precompute::PrecomputeConfig config;
  config.name = "fixed box";
  config.mesh.source = precompute::BoxConfig{box.size, box.cells};
  config.mesh.order = box.order;
  config.material = {box.youngs_modulus, box.poisson_ratio, 110.0, box.rayleigh_alpha, 2e-4};
  config.support = precompute::HalfSpace{Vector3::Zero(), Vector3::Unit(box.clamped_axis)};
  if (box.modes > 0) config.modes.count = box.modes;
  config.response.dt = 0.002;
  config.response.steps = 300;
  config.response.precision = Precision::kDouble;
  config.response.storage =
      kind == ResponseKind::kDense ? precompute::Storage::kDense : precompute::Storage::kModal;
  const TemporaryFolder folder;
  std::ostringstream ignored;
  const precompute::Console console{ignored, false};
  const auto path = folder.path() / "box.h5";
  precompute::precompute_model(config, path, console);
  return std::make_shared<const Model>(read_model(path, kind));
}

}  // namespace irdm::test
