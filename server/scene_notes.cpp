#include "server/scene_notes.hpp"

#include <algorithm>
#include <iostream>
#include <sstream>

#include "common/contact/contact_model.hpp"
#include "common/error.hpp"
#include "server/stylus_notes.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

// Where a fixed object is clamped its surface does not yield at all: without a spring between tip
// and surface no force takes the one to the other.
void check_coupling(const SceneConfig& scene, const SimulationConfig& config,
                    const std::string& name) {
  const bool rigid =
      std::any_of(config.styluses.begin(), config.styluses.end(),
                  [](const SimulationStylus& stylus) { return stylus.coupling_stiffness <= 0.0; });
  for (std::size_t i = 0; rigid && i < config.objects.size(); ++i) {
    if (config.objects[i].model->body.support != Support::kFixed) continue;
    throw Error(
        name,
        "object " + in_quotes(scene.objects[i].name) +
            " is fixed and contact.coupling_stiffness is 0, so that nothing yields where it "
            "is clamped",
        "set contact.coupling_stiffness, for instance to 2000 (N/m)");
  }
}

namespace {

// Such a run can be looked at, and played in lockstep.
std::string long_step_warning(double dt) {
  if (dt <= kLongestForceStep) return {};
  std::ostringstream text;
  text << "the model's dt of " << dt << " s is too long for a hand: above " << kLongestForceStep
       << " s bridges predict no contact and let held forces fade between steps; compute the model "
          "with a shorter response.dt";
  return text.str();
}

// Gravity that nobody sees would be taken for a mistake.
std::string missing_sag_warning(const SimulationObject& object) {
  const bool compressed = std::holds_alternative<CompressedResponse>(object.model->response);
  return "fixed object '" + object.name + "' does not sag under gravity: its model " +
         (compressed ? "is compressed, which leaves gravity out; use engine = \"modal\" or "
                       "\"dense\""
                     : "does not say how; precompute it again with method = \"modal\"");
}

}  // namespace

void SceneNotes::say() const {
  if (!note.empty()) std::cout << note + "\n" << std::flush;
  std::cerr << warnings;
}

SceneNotes scene_notes(const SceneConfig& scene, const SimulationConfig& config, bool viewer_stylus,
                       bool lockstep, const std::string& name) {
  SceneNotes notes{default_radius_note(scene, config, viewer_stylus)};
  const auto warn = [&](const std::string& warning) {
    if (!warning.empty()) notes.warnings += "irdm-server: warning: " + name + ": " + warning + "\n";
  };
  for (const SimulationObject& object : config.objects) {
    if (config.gravity.isZero(0.0) || takes_gravity(object)) continue;
    warn(missing_sag_warning(object));
  }
  if (!lockstep) warn(long_step_warning(config.objects.front().model->dt));
  warn(point_warning(scene, config, viewer_stylus));
  warn(coupling_warning(scene, config));
  return notes;
}

}  // namespace irdm
