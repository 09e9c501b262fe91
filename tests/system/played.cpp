#include "tests/system/played.hpp"

#include <algorithm>

namespace irdm::test {
namespace {

const std::filesystem::path kConfigs = IRDM_SOURCE_DIR "/configs";

// A model of configs/models, made once a process.
std::filesystem::path gallery_model(const std::string& name) {
  static const TemporaryFolder folder;
  const std::filesystem::path model = folder.path() / (name + ".h5");
  if (!std::filesystem::exists(model)) {
    const FinishedProgram made = run_to_end(
        {IRDM_PRECOMPUTE, (kConfigs / "models" / (name + ".toml")).string(), "-o", model.string()});
    if (made.status != 0) throw std::runtime_error("no model: " + made.err);
  }
  return model;
}

}  // namespace

Played::Played(const std::string& scene, const std::string& bridge) {
  const std::string text = file_content(kConfigs / "scenes" / (scene + ".toml"));
  stage_.write("scene.toml", text);
  config_ = read_scene(TomlTable::parse_file(stage_.path("scene.toml")));
  for (const ObjectConfig& object : config_.objects) {
    if (std::filesystem::exists(object.model)) continue;
    std::filesystem::create_symlink(gallery_model(object.model.stem().string()), object.model);
  }
  Server server = stage_.start_server({"--lockstep", "--record", stage_.path("trace.h5").string()});
  const std::string name = (bridge.empty() ? scene : bridge) + ".toml";
  ChildProcess player({IRDM_BRIDGE, (kConfigs / "bridges" / name).string(), "--server",
                       "127.0.0.1:" + std::to_string(server.port)});
  REQUIRE(player.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  CHECK(number_after(server.process.out(), "steps without a finite solution: ") == 0);
  file_ = std::make_unique<hdf5::File>(hdf5::File::open(stage_.path("trace.h5")));
  rows_ = file_->shape("/step/time")[0];
  dt_ = file_->read_double_attribute("/", "dt");
  mass_ = mass();
}

Vector3 Played::body_force(std::size_t k, int object, int other) {
  if (touching_.empty()) read_body_contacts();
  Vector3 sum = Vector3::Zero();
  for (const Touch& touch : touching_[k]) {
    if (touch.object == object && touch.other == other) sum += touch.force;
    if (touch.object == other && touch.other == object) sum -= touch.force;
  }
  return sum;
}

Vector3 Played::unbalanced(std::size_t k) {
  const double share = std::exp(-0.5 * dt_ * config_.objects[0].damping.linear);
  const Vector3 gained =
      vector("/step/body_velocity", k) / share - vector("/step/body_velocity", k - 1) * share;
  Vector3 forces = mass_ * config_.world.gravity;
  for (std::size_t s = 0; s < config_.styluses.size(); ++s) forces -= force(k, static_cast<int>(s));
  for (std::size_t i = 0; i < config_.scenery.size(); ++i) {
    forces += body_force(k, 0, -1 - static_cast<int>(i));
  }
  return mass_ / dt_ * gained - forces;
}

Vector3 Played::floor_force(std::size_t k) {
  const auto count = file_->read<std::int32_t>("/floor/count", {rows_});
  const auto force = file_->read<float>("/floor/force", {0, 3});
  std::size_t row = 0;
  for (std::size_t i = 0; i < k; ++i) row += static_cast<std::size_t>(count[i]);
  Vector3 sum = Vector3::Zero();
  for (std::int32_t c = 0; c < count[k]; ++c, ++row) {
    sum += Eigen::Map<const Eigen::Vector3f>(force.data() + 3 * row).cast<double>();
  }
  return orientation(k - 1) * sum;
}

Vector3 Played::contact_at_rest(std::size_t k, int stylus, const Model& model) {
  const std::string group = "/stylus/" + std::to_string(stylus);
  std::vector<std::int32_t>& nodes = contact_nodes_[stylus];
  if (nodes.empty()) nodes = file_->read<std::int32_t>(group + "/contact_nodes", {rows_, 3});
  const Vector3 weights = vector(group + "/contact_weights", k);
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 3; ++i) {
    sum += weights[i] * model.mesh.rest_position(nodes[3 * k + static_cast<std::size_t>(i)]);
  }
  return sum;
}

double Played::peak_force(int stylus) {
  double peak = 0.0;
  for (std::size_t k = 0; k < rows_; ++k) peak = std::max(peak, force(k, stylus).norm());
  return peak;
}

void Played::read_body_contacts() {
  const auto step = file_->read<std::uint64_t>("/body_contact/force_step", {0});
  const auto object = file_->read<std::int32_t>("/body_contact/object", {0});
  const auto other = file_->read<std::int32_t>("/body_contact/other", {0});
  const auto force = file_->read<double>("/body_contact/force", {0, 3});
  const auto first = file_->read<std::uint64_t>("/step/force_step", {rows_}).front();
  touching_.resize(rows_);
  for (std::size_t i = 0; i < step.size(); ++i) {
    touching_[step[i] - first].push_back({object[i], other[i], Vector3(force.data() + 3 * i)});
  }
}

NodeInside Played::deepest_node() const {
  const std::filesystem::path run = stage_.path("run.h5");
  const FinishedProgram made =
      run_to_end({IRDM_REPLAY, stage_.path("trace.h5").string(), "--output", run.string()});
  if (made.status != 0) throw std::runtime_error("no run file: " + made.err);
  return deepest_inside(run, config_);
}

void check_penetration(const Played& played) {
  const NodeInside deepest = played.deepest_node();
  INFO("node " << deepest.node << " of " << deepest.object << " " << deepest.depth << " m inside "
               << deepest.other << " at " << deepest.time << " s");
  CHECK(deepest.depth < 5e-4);
}

}  // namespace irdm::test
