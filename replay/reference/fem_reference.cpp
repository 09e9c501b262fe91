#include "replay/reference/fem_reference.hpp"

#include "common/error.hpp"
#include "precompute/fem/assembly.hpp"
#include "replay/reference/fem_body.hpp"
#include "replay/rerun/rerun.hpp"

namespace irdm::replay {
namespace {

void check_model(const Model& model, const std::string& name) {
  if (is_rigid(model)) {
    throw Error(name, "is of a rigid body, and the reference deforms elastic ones",
                "leave --reference out");
  }
  if (model.body.support == Support::kFixed) {
    throw Error(name, "is of a fixed object, and the reference moves floating ones only",
                "give a floating object, or leave --reference out");
  }
  const Eigen::VectorXd mass =
      precompute::lumped_mass({model.mesh.nodes, model.mesh.tets, {}}, model.material);
  if ((mass - model.mesh.node_mass).cwiseAbs().maxCoeff() <= 1e-9 * mass.maxCoeff()) return;
  throw Error(name, "has masses that its tetrahedra and density do not give",
              "precompute it again");
}

}  // namespace

double fem_substep(double dt, double longest) {
  return dt / fem_parts(dt, longest);
}

std::unique_ptr<Rerun> fem_reference(const TracedScene& scene, precompute::Elasticity elasticity,
                                     double substep, bool follow_tips,
                                     const std::vector<DelayedForces>& delayed_forces,
                                     StepJournal* journal) {
  if (!tool_styluses(scene.config).empty()) {
    throw Error("--reference fem", "has no coupling that leads a tool", "leave --reference out");
  }
  std::vector<std::unique_ptr<ForcedBody>> bodies;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    check_model(*scene.config.objects[i].model, scene.objects[i].model.string());
    std::vector<DelayedForces> own;
    for (const DelayedForces& told : delayed_forces) {
      if (told.late.object == static_cast<int>(i)) own.push_back(told);
    }
    auto body = std::make_unique<FemBody>(scene.config, i, elasticity, substep, follow_tips,
                                          std::move(own));
    if (journal != nullptr) body->use(*journal);
    bodies.push_back(std::move(body));
  }
  return std::make_unique<ForceRerun>(scene.config, std::move(bodies));
}

}  // namespace irdm::replay
