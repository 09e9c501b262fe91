// What can be changed while a simulation goes on.

#include "common/error.hpp"
#include "common/response/stored_response.hpp"
#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/point_loads.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/synthetic_model.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using irdm::test::add_centrifugal;
using irdm::test::share;
using irdm::test::synthetic_cube;
using irdm::test::with_dense_response;

namespace {

constexpr double kSettingsDt = 0.002;

SimulationConfig plain(const Model& model) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = share(model);
  config.objects[0].friction = {0.5, 0.4};
  return config;
}

/// Presses on the top, and holds it from step 50 to 100.
StylusCommand press_and_hold(int k) {
  const double depth = std::min(1e-4 * k, 5e-3);
  return {true, k >= 50 && k < 100 ? kGrabButton : 0, Vector3(0.01, 0.061 - depth, 0.005), {}};
}

StepRecord run(Simulation& simulation, int from, int to) {
  StepRecord record;
  for (int k = from; k < to; ++k) {
    const StylusCommand command = press_and_hold(k);
    simulation.step({&command, 1}, record);
  }
  return record;
}

}  // namespace

TEST_CASE("settings: gravity, tether and damping act from the next step on") {
  Simulation simulation(plain(synthetic_cube(2, 5, 10)));
  const double mass = simulation.object().model().body.mass;
  const StylusCommand nobody;
  StepRecord record;
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].velocity == Vector3::Zero());
  CHECK(record.settings_change == 0);
  Settings settings = simulation.settings();
  settings.gravity = Vector3(0, -2, 0);
  simulation.set(settings);
  simulation.step({&nobody, 1}, record);
  CHECK(record.settings_change == 1);
  CHECK(record.settings == settings);
  CHECK(record.object[0].velocity.y() == Approx(-2 * kSettingsDt));
  settings.gravity.setZero();
  settings.object[0].damping.linear = 10.0;
  simulation.set(settings);
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].velocity.y() == Approx(-2 * kSettingsDt * std::exp(-10.0 * kSettingsDt)));
  const Vector3 before = record.object[0].velocity;
  const double middle = record.object[0].position.y() + 0.5 * kSettingsDt * before.y();
  settings.object[0].damping.linear = 0.0;
  settings.object[0].tether.stiffness = 3.0;
  simulation.set(settings);
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].velocity.y() == Approx(before.y() - kSettingsDt * 3.0 * middle / mass));
}

TEST_CASE("settings: friction decides from the next step on whether a tip slips") {
  const auto slips = [](double friction) {
    SimulationConfig config = plain(synthetic_cube(3, 30, 10));
    config.objects[0].damping = {200.0, 200.0};  // so that it does not run away
    Simulation simulation(config);
    Settings settings = simulation.settings();
    settings.object[0].friction = {friction, friction};
    StepRecord record = run(simulation, 0, 40);
    simulation.set(settings);
    bool slipped = false;
    for (int k = 0; k < 20; ++k) {
      const StylusCommand command{true, 0, Vector3(0.01 + 2e-5 * k, 0.057 - 1e-4 * k, 0.005), {}};
      simulation.step({&command, 1}, record);
      REQUIRE(record.stylus[0].contact == ContactState::kTouching);
      slipped = slipped || record.object[0].contact[0].slipping;
    }
    return slipped;
  };
  CHECK_FALSE(slips(5.0));
  CHECK(slips(0.001));
}

TEST_CASE("settings: a factor on the material's damping is that factor on every decay rate") {
  const Model model = synthetic_cube(3, 30, 10);
  Model damped = model;
  std::get<ModalResponse>(damped.response).decay_rate *= 3.0;
  Simulation changed(plain(model));
  Settings settings = changed.settings();
  settings.object[0].material_damping = 3.0;
  changed.set(settings);
  Simulation expected(plain(damped));
  CHECK(run(changed, 0, 150).stylus[0].force == run(expected, 0, 150).stylus[0].force);

  // In the midst of a run the displacement has no jump, and rings less from there on.
  Simulation later(plain(model));
  Simulation as_it_was(plain(model));
  run(later, 0, 120);
  run(as_it_was, 0, 120);
  const Vector3 free = as_it_was.object().engine().free_displacement(0);
  later.set(settings);
  const double jump = (later.object().engine().free_displacement(0) - free).norm();
  CHECK(jump < 0.2 * free.norm());
  CHECK(jump > 0.0);
}

TEST_CASE("settings: the deformation follows them") {
  SimulationConfig config = plain(synthetic_cube(3, 30, 10));
  Simulation simulation(config);
  Deformation deformation(config);
  SurfaceFrame frame = rest_frame(config);
  StepRecord record;
  Points expected;
  for (int k = 0; k < 200; ++k) {
    if (k == 90 || k == 150) {
      Settings settings = simulation.settings();
      settings.object[0].material_damping = k == 90 ? 4.0 : 0.5;
      simulation.set(settings);
    }
    const StylusCommand command = press_and_hold(k);
    simulation.step({&command, 1}, record);
    deformation.follow(record);
  }
  deformation.compute(frame);
  simulation.object().engine().displacement(expected);
  CHECK(frame.objects[0].displacement == expected);
  CHECK(expected.norm() > 1e-6);  // there is something to compare
}

TEST_CASE("settings: what a step cannot bear or a model cannot do is refused with the reason") {
  const SimulationConfig config = plain(synthetic_cube(2, 5, 10));
  const auto refused = [&](const auto& change) {
    Settings settings = initial_settings(config);
    CHECK_NOTHROW(check_settings(config, settings));
    change(settings.object[0]);
    try {
      check_settings(config, settings);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused([](ObjectSettings& s) { s.damping.linear = 1e4; }),
             ContainsSubstring("too strong"));
  CHECK_THAT(refused([](ObjectSettings& s) { s.tether.stiffness = 1e9; }),
             ContainsSubstring("too stiff"));
  CHECK_THAT(refused([](ObjectSettings& s) { s.inertial_loading = true; }),
             ContainsSubstring("spin"));
  CHECK(refused([](ObjectSettings& s) { s.material_damping = 2.0; }).empty());
  CHECK(refused([](ObjectSettings& s) { s.friction = {1.0, 1.0}; }).empty());
}

TEST_CASE("settings: coupling to inertia is switched where the model knows it") {
  Model model = synthetic_cube(2, 5, 10);
  add_centrifugal(model);
  SimulationConfig config = plain(model);
  config.objects[0].angular_velocity = Vector3(0, 5, 0);
  CHECK(settings_choice(config, 0).inertial_loading);
  CHECK(settings_choice(config, 0).motion);
  model.body.support = Support::kFixed;
  CHECK(settings_choice(plain(model), 0) == SettingsChoice{true, false, false});
  Simulation simulation(config);
  const StylusCommand nobody;
  StepRecord record;
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].spin == Vector3::Zero());
  Settings settings = simulation.settings();
  settings.object[0].inertial_loading = true;
  simulation.set(settings);
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].spin.norm() == Approx(5.0));
}

TEST_CASE("static compliance is what a lasting force leads to, by modes and by R itself",
          "[slow]") {
  const bool reduced = GENERATE(false, true);
  CAPTURE(reduced);
  Model modal = synthetic_cube(2, 12, 4000);
  if (reduced) test::add_residual(modal);
  const Model dense = with_dense_response<double>(modal);
  const Vector3 d = Vector3(1, 2, -2) / 3.0;
  const std::vector<Vector3> directions(static_cast<std::size_t>(modal.mesh.surface_node_count()),
                                        d);
  const Eigen::SparseMatrix<double> loads = test::point_loads(directions);
  const Eigen::VectorXd by_modes = static_compliance(modal, loads);
  const Eigen::VectorXd by_history = static_compliance(dense, loads);
  const auto engine = make_engine(share(modal));
  const int node = 5;
  const std::vector<NodalForce> force{{node, d}};
  for (int k = 0; k < 20'000; ++k) engine->advance(force);
  Points u;
  engine->displacement(u);
  CHECK(by_modes(node) == Approx(u.row(node).dot(d)).epsilon(1e-5));
  CHECK(((by_history - by_modes).array() / by_modes.array()).abs().maxCoeff() < 1e-4);
}
