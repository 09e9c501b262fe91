#include "scene/scene_run.hpp"

#include <cmath>

#include "common/checksum.hpp"
#include "common/config/range.hpp"
#include "common/error.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

std::string checksum_of(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.update(bytes.data(), bytes.size());
  return sha.hexadecimal();
}

// Of what the bytes of a state mean.
std::string identity_of(const SimulationConfig& config) {
  Sha256 sha;
  const auto add = [&](const auto& number) { sha.update(&number, sizeof number); };
  const auto add_all = [&](const auto& numbers) {
    sha.update(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof *numbers.data());
  };
  add_all(std::string_view("irdm state " IRDM_VERSION));
  for (const SimulationObject& object : config.objects) {
    const Model& model = *object.model;
    add_all(model.mesh.nodes);
    add_all(model.mesh.triangles);
    add(model.body.mass);
    add_all(model.body.inertia);
    const Material& material = model.material;
    for (const double number : {material.youngs_modulus, material.poisson_ratio, material.density,
                                material.rayleigh_alpha, material.rayleigh_beta, model.dt}) {
      add(number);
    }
    add_all(material.elements.youngs_modulus);
    add_all(material.elements.poisson_ratio);
    add(model.steps);
    add(model.response.index());
    if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
      add_all(modal->angular_frequency);
    }
  }
  return sha.hexadecimal();
}

}  // namespace

const char* fault_of(const StylusCommand& command) noexcept {
  constexpr double kNormTolerance = 1e-6;
  if (!command.present) return nullptr;
  for (const double component : command.tip) {
    if (!lab::kPlace.contains(component)) return "the tip is not within 1e4 m of the origin";
  }
  const bool unit = std::abs(command.orientation.norm() - 1.0) <= kNormTolerance;
  return unit ? nullptr : "the orientation is not a quaternion of length 1";
}

SceneRun::SceneRun(const TomlTable& file)
    : scene_(read_scene(file)),
      config_(simulation_config(scene_, false)),
      simulation_(std::make_unique<Simulation>(config_)),
      rows_(config_),
      record_(std::make_unique<StepRecord>()),
      objects_(config_.objects.size()),
      identity_(identity_of(config_)) {}

const StepRecord& SceneRun::step(std::span<const StylusCommand> commands) noexcept {
  simulation_->step(commands, *record_);
  describe();
  return *record_;
}

void SceneRun::describe() noexcept {
  contacts_ = rows_.of(*simulation_, *record_);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    objects_[i] = row_of(record_->object[i], simulation_->object(static_cast<int>(i)).energy());
  }
}

void SceneRun::archive(StateArchive& state) const {
  simulation_->archive(state);
  state.value(static_cast<StepHead&>(*record_));
  state.numbers(record_->object.data(), static_cast<std::size_t>(record_->object_count));
  state.numbers(record_->stylus.data(), static_cast<std::size_t>(record_->stylus_count));
  const std::size_t contacts = state.size(record_->body_contact.size(), kMaxBodyContacts);
  record_->body_contact.resize(contacts);
  state.numbers(record_->body_contact.data(), contacts);
  state.end();
}

// Identity, checksum of the rest, the rest.
std::vector<std::byte> SceneRun::save_state() const {
  StateArchive archived;
  archive(archived);
  const std::vector<std::byte> body = archived.take();
  std::vector<std::byte> state;
  for (const std::string& text : {identity_, checksum_of(body)}) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    state.insert(state.end(), bytes, bytes + text.size());
  }
  state.insert(state.end(), body.begin(), body.end());
  return state;
}

void SceneRun::load_state(std::span<const std::byte> state) {
  const std::string_view text(reinterpret_cast<const char*>(state.data()), state.size());
  if (!text.starts_with(identity_)) {
    throw Error("state", "is not one of these models with irdm " IRDM_VERSION,
                "load it where it was saved");
  }
  const std::size_t head = 2 * identity_.size();
  if (text.size() < head ||
      text.substr(identity_.size(), identity_.size()) != checksum_of(state.subspan(head))) {
    throw Error("state", "is damaged", "save it anew, and keep all of its bytes");
  }
  const std::vector<std::byte> before = save_state();
  try {
    StateArchive archived(state.subspan(head));
    archive(archived);
  } catch (const Error&) {
    StateArchive back(std::span<const std::byte>(before).subspan(head));
    archive(back);
    throw;
  }
  if (simulation_->next_step() > 0) {
    describe();
  } else {
    contacts_ = {};
  }
}

void SceneRun::set_gravity(const Vector3& gravity) {
  for (const double component : gravity) {
    if (lab::kGravity.contains(component)) continue;
    throw Error("gravity", "is " + number_text(component) + " along an axis",
                "give a finite number, from -100 to 100 m/s^2");
  }
  Settings settings = simulation_->settings();
  settings.gravity = gravity;
  simulation_->set(settings);
}

void SceneRun::surface(int i, Points& x) const {
  const SoftObject& object = simulation_->object(i);
  object.engine().displacement(x);
  const ModelMesh& mesh = object.model().mesh;
  const Matrix3 turn = object.state().orientation.toRotationMatrix();
  for (int node = 0; node < mesh.surface_node_count(); ++node) {
    const Vector3 in_body = mesh.rest_position(node) + Vector3(x.row(node).transpose());
    x.row(node) = (object.state().position + turn * in_body).transpose();
  }
}

}  // namespace irdm
