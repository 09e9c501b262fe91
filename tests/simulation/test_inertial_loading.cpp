#include <cmath>
#include <deque>
#include <iostream>

#include "common/error.hpp"
#include "common/response/modal_response.hpp"
#include "common/response/stored_response.hpp"
#include "simulation/deformation/deformation.hpp"
#include "simulation/step/settings.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/spinning_fem.hpp"
#include "tests/support/synthetic_model.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kTwoTurns = 4.0 * 3.14159265358979323846;  // 2 revolutions a second [rad/s]

SimulationConfig spinning(std::shared_ptr<const Model> model, const Vector3& w,
                          bool inertial_loading = true) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::move(model);
  config.objects[0].angular_velocity = w;
  config.objects[0].inertial_loading = inertial_loading;
  return config;
}

// Presses on a spinning cube, takes hold of it, pulls it about and lets go: its spin changes.
StylusCommand pull(int k) {
  if (k < 50 || k >= 350) return {};
  const double t = 0.002 * (k - 50);
  return at_tip(Vector3(0.03 + 0.02 * std::sin(5.0 * t), 0.065 - 0.1 * std::min(t, 0.1), 0.01),
                k > 120);
}

Points surface_of(const Simulation& simulation) {
  Points u;
  simulation.object().engine().displacement(u);
  return u;
}

// An undeformed body that is let go spinning with w, after each step.
std::vector<SpinningState> let_go(const std::shared_ptr<const Model>& model, const Vector3& w,
                                  int steps) {
  Simulation simulation(spinning(model, w));
  StepRecord record;
  const StylusCommand nobody;
  std::vector<SpinningState> states;
  for (int k = 0; k < steps; ++k) {
    simulation.step({&nobody, 1}, record);
    states.push_back({surface_of(simulation), record.object[0].spin});
  }
  return states;
}

// The displacement after steps in which the body turned with w.
Points turned_with(const std::shared_ptr<const Model>& model, const Vector3& w, int steps) {
  const auto engine = make_engine(model);
  for (int k = 0; k < steps; ++k) {
    engine->capabilities().inertial_loading->set_angular_velocity(w);
    engine->advance({});
  }
  Points u;
  engine->displacement(u);
  return u;
}

Points nothing(const Points& like) {
  return Points::Zero(like.rows(), 3);
}

}  // namespace

TEST_CASE("inertial loading: the settled bulge is that of a static solve on the whole mesh",
          "[slow]") {
  const Vector3 axis = GENERATE(Vector3(0, 0, 1), Vector3(0, 1, 1), Vector3(1, 2, -3));
  const ResponseKind kind = GENERATE(ResponseKind::kModal, ResponseKind::kDense);
  // Quadratic, with the paper's material; damped so that the ringing has died within T.
  const auto model = fem_cube({3, 2000.0, 60.0, 0.002, 300, 0.49, 2}, kind);
  const Vector3 w = kTwoTurns * axis.normalized();

  // The same equations, the same numbers: single precision is left.
  const Points linear = static_bulge(*model, w, SpinSoftening::kNone);
  CHECK(largest_error(turned_with(model, w, 600), linear) < 1e-6);

  // The whole step, whose body turns a little about other axes than at first: the inertia of the
  // mesh is not quite that of a cube.
  const SpinningState state = let_go(model, w, 600).back();
  CHECK(state.w.norm() == Approx(kTwoTurns).epsilon(1e-3));
  const Points truth = static_bulge(*model, state.w, SpinSoftening::kIncluded);
  const double error = largest_error(state.displacement, truth);
  const double without = largest_error(nothing(truth), truth);
  std::cout << "2 revolutions/s about (" << axis.transpose()
            << "), static FEM with softening: bulge " << 1000 * truth.rowwise().norm().maxCoeff()
            << " mm, error " << 100 * error << " %, without the option " << 100 * without << " %\n";
  CHECK(error < 0.05);
  CHECK(without == Approx(1.0));
}

TEST_CASE("inertial loading: the settled bulge is that of a free spinning corotational body",
          "[slow]") {
  const double poisson = GENERATE(0.49, 0.3);
  const Vector3 axis = GENERATE(Vector3(0, 0, 1), Vector3(1, 2, -3));
  const auto model = fem_cube({6, 2000.0, 60.0, 0.002, 300, poisson});
  const Vector3 start = kTwoTurns * axis.normalized();
  constexpr int kSteps = 400;
  const SpinningState truth = corotational_spin(*model, start, kSteps).back();
  const double same_spin = largest_error(turned_with(model, truth.w, 600), truth.displacement);
  const double alike =
      largest_error(let_go(model, start, kSteps).back().displacement, truth.displacement);
  std::cout << "corotational, nu " << poisson << ", about (" << axis.transpose() << "): bulge "
            << 1000 * truth.displacement.rowwise().norm().maxCoeff() << " mm at "
            << 2.0 * truth.w.norm() / kTwoTurns << " revolutions/s; error at that spin "
            << 100 * same_spin << " %, let go alike " << 100 * alike
            << " %, without the option 100 %\n";
  CHECK(same_spin < 0.05);
  CHECK(alike < 0.05);
}

TEST_CASE("inertial loading: what is left out while the cube rings is of the order of the spin",
          "[slow]") {
  const Vector3 axis = Vector3(1, 2, -3).normalized();
  const auto model = fem_cube({4, 2000.0, 8.0, 0.002, 300, 0.3});
  std::vector<double> errors;
  for (const double share : {1.0, 0.5, 0.25}) {
    const auto truth = corotational_spin(*model, share * kTwoTurns * axis, 250, 8);
    const auto ours = let_go(model, share * kTwoTurns * axis, 250);
    double worst = 0.0;
    double peak = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const Points difference = ours[k].displacement - truth[k].displacement;
      worst = std::max(worst, difference.rowwise().norm().maxCoeff());
      peak = std::max(peak, truth[k].displacement.rowwise().norm().maxCoeff());
    }
    errors.push_back(worst / peak);
    std::cout << "corotational, ringing, " << 2.0 * share << " revolutions/s: peak " << 1000 * peak
              << " mm, largest error within 0.5 s " << 100 * errors.back() << " %\n";
  }
  CHECK(errors[1] < 0.6 * errors[0]);
  CHECK(errors[2] < 0.6 * errors[1]);
}

TEST_CASE("inertial loading: both engines equal the direct sum over the products held") {
  constexpr int kSteps = 60;
  Model modal = synthetic_cube(2, 20, kSteps);
  add_centrifugal(modal);
  const auto& response = std::get<ModalResponse>(modal.response);
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const auto by_modes = make_engine(share(modal));
  const auto by_history = make_engine(share(with_dense_response<double>(modal)));
  Eigen::MatrixXd h(response.mode_count(), 4 * kSteps);
  for (int i = 0; i < response.mode_count(); ++i) {
    h.row(i) = held_force_response(held_force_oscillator(response.angular_frequency(i),
                                                         response.decay_rate(i), modal.dt),
                                   4 * kSteps)
                   .transpose();
  }
  std::deque<Eigen::VectorXd> loads;
  const auto direct = [&](int last) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(shapes.cols());
    for (int age = 0; age < std::min(last, static_cast<int>(loads.size())); ++age) {
      q += h.col(age).cwiseProduct(loads[static_cast<std::size_t>(age)]);
    }
    const Eigen::VectorXd u = shapes * q;
    return Points(Eigen::Map<const Points>(u.data(), u.size() / 3, 3));
  };
  double peak = 0.0;
  Points u;
  for (int k = 0; k < 4 * kSteps; ++k) {
    // Changes all the time, pauses once for longer than T.
    Vector3 w(3.0 * std::sin(0.1 * k), 2.0, 4.0 * std::cos(0.23 * k));
    if (k > 100 && k < 180) w.setZero();
    const NodalForce force{k % 7, Vector3(0.1, std::sin(0.3 * k), -0.2)};
    loads.push_front(response.centrifugal * spin_products(w) +
                     shapes.middleRows(3 * force.node, 3).transpose() * force.force);
    for (const auto* engine : {&by_modes, &by_history}) {
      (*engine)->capabilities().inertial_loading->set_angular_velocity(w);
      (*engine)->advance({&force, 1});
    }
    const Points all = direct(4 * kSteps);
    peak = std::max(peak, all.cwiseAbs().maxCoeff());
    by_modes->displacement(u);
    REQUIRE((u - all).cwiseAbs().maxCoeff() <= 1e-11 * peak);
    by_history->displacement(u);
    REQUIRE((u - direct(kSteps)).cwiseAbs().maxCoeff() <= 1e-11 * peak);
  }
}

TEST_CASE("inertial loading: the predicted displacement has the spin of the coming step in it") {
  Model modal = synthetic_cube(2, 20, 60);
  add_centrifugal(modal);
  for (const Model& model : {modal, with_dense_response<double>(modal)}) {
    const auto engine = make_engine(share(model));
    for (int k = 0; k < 20; ++k) {
      engine->capabilities().inertial_loading->set_angular_velocity(Vector3(1.0, -2.0, 0.1 * k));
      const Vector3 free = engine->free_displacement(5);
      const ContactPatch patch(SurfacePoint{{5, 0, 1}, {1.0, 0.0, 0.0}});
      Vector3 h;
      ContactMatrix W;
      engine->predict({&patch, 1}, {&h, 1}, W);
      engine->advance({});
      Points u;
      engine->displacement(u);
      REQUIRE((free - u.row(5).transpose()).norm() <= 1e-13 * u.norm());
      REQUIRE((h - free).norm() <= 1e-13 * u.norm());
    }
    engine->reset();
    engine->advance({});
    Points u;
    engine->displacement(u);
    CHECK(u.norm() == 0.0);
  }
}

TEST_CASE(
    "inertial loading: engines agree on a cube that is pushed, held and let go while it spins",
    "[unsanitized]") {
  const FemCube cube{3, 2000.0, 60.0, 0.002, 300};
  SimulationConfig modal = spinning(fem_cube(cube), Vector3(2, 5, -3));
  SimulationConfig dense = modal;
  dense.objects[0].model = fem_cube(cube, ResponseKind::kDense);
  modal.styluses[0] = dense.styluses[0] = {0.0, 500.0, 0.02};
  Simulation a(modal);
  Simulation b(dense);
  StepRecord of_a;
  StepRecord of_b;
  double peak = 0.0;
  double worst = 0.0;
  double changed = 0.0;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = pull(k);
    a.step({&command, 1}, of_a);
    b.step({&command, 1}, of_b);
    const Points u = surface_of(a);
    peak = std::max(peak, u.rowwise().norm().maxCoeff());
    worst = std::max(worst, (u - surface_of(b)).rowwise().norm().maxCoeff());
    changed = std::max(changed, (of_a.object[0].spin - Vector3(2, 5, -3)).norm());
  }
  INFO("difference " << worst << " of " << peak << " m");
  CHECK(changed > 1.0);
  CHECK(worst < 1e-4 * peak);
}

TEST_CASE("inertial loading: off, a model that has the data gives the bits of one without") {
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    const auto with = fem_cube({3, 2000.0, 60.0, 0.002, 300}, kind);
    REQUIRE(has_centrifugal(*with));
    Model stripped = *with;
    if (auto* modal = std::get_if<ModalResponse>(&stripped.response)) {
      modal->centrifugal.resize(0, 0);
    } else {
      std::get<DenseResponse>(stripped.response).centrifugal = {};
    }
    REQUIRE_FALSE(has_centrifugal(stripped));
    Simulation a(spinning(with, Vector3(2, 5, -3), false));
    Simulation b(spinning(share(stripped), Vector3(2, 5, -3), false));
    StepRecord of_a;
    StepRecord of_b;
    for (int k = 0; k < 400; ++k) {
      const StylusCommand command = pull(k);
      a.step({&command, 1}, of_a);
      b.step({&command, 1}, of_b);
      REQUIRE(of_a.stylus[0].force == of_b.stylus[0].force);
      REQUIRE(of_a.object[0].position == of_b.object[0].position);
      REQUIRE(of_a.object[0].spin == Vector3::Zero());
    }
    CHECK(surface_of(a) == surface_of(b));
  }
}

TEST_CASE("inertial loading: momentum still changes by exactly the impulses") {
  const auto model = fem_cube({3, 2000.0, 8.0, 0.002, 300});
  SimulationConfig config = spinning(model, Vector3(2, 5, -3));
  config.styluses[0] = {0.0, 500.0, 0.02};
  Simulation simulation(config);
  const Eigen::MatrixXd R0 = stored_response(*model)->zero_lag();
  const RestSurface& surface = simulation.object().surface();
  RigidState before = simulation.object().state();
  StepRecord record;
  double turned = 0.0;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = pull(k);
    simulation.step({&command, 1}, record);
    const RigidState after = simulation.object().state();
    const ContactRecord& contact = record.object[0].contact[0];
    Vector3 impulse = Vector3::Zero();
    Vector3 turn = Vector3::Zero();
    if (contact.state != ContactState::kFree) {
      // The lever arm: where the tip is felt, the point's end less what the force of this step
      // moved it and the offset.
      Vector3 arm = after.orientation.conjugate() * (contact.proxy - after.position) +
                    contact.offset + contact.arm_shift;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          arm -= contact.point.weights[i] * contact.point.weights[j] *
                 R0.block<3, 3>(3 * contact.point.nodes[i], 3 * contact.point.nodes[j]) *
                 contact.force;
        }
      }
      const Quaternion& Q = record.object[0].halfway;
      impulse = model->dt * (Q * contact.force);
      turn = model->dt * (Q * arm.cross(contact.force));
    }
    const Vector3 gained = model->body.mass * (after.velocity - before.velocity);
    REQUIRE((gained - impulse).norm() < 1e-14);
    REQUIRE((after.angular_momentum - before.angular_momentum - turn).norm() < 1e-14);
    turned += turn.norm();
    before = after;
  }
  CHECK(surface.node_count() > 0);
  CHECK(turned > 1e-4);
}

TEST_CASE("inertial loading: the surface is computed again from what was recorded") {
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    const auto model = fem_cube({3, 2000.0, 8.0, 0.002, 300}, kind);
    SimulationConfig config = spinning(model, Vector3(2, 5, -3));
    config.styluses[0] = {0.0, 500.0, 0.02};
    config.objects[0].damping.angular = 0.5;
    Simulation simulation(config);
    Deformation deformation(config);
    const RigidBody body(model->body, model->dt);
    const auto engine = make_engine(model);
    RecordedForces forces(config, 0, simulation.object().surface());
    SurfaceFrame frame = rest_frame(config);
    // What a trace has of the step before.
    RigidState before = simulation.object().state();
    StepRecord record;
    double worst = 0.0;
    for (int k = 0; k < 400; ++k) {
      const StylusCommand command = pull(k);
      simulation.step({&command, 1}, record);
      const ObjectRecord& object = record.object[0];
      deformation.follow(record);
      const Vector3 spin = body.mid_step_spin(before);
      worst = std::max(worst, (spin - object.spin).norm() / object.spin.norm());
      engine->capabilities().inertial_loading->set_angular_velocity(spin);
      engine->advance(forces.of(object, {}));
      before.orientation = object.orientation;
      before.angular_momentum = body.angular_momentum(object.orientation, object.angular_velocity);
    }
    deformation.compute(frame);
    const Points u = surface_of(simulation);
    CHECK(frame.objects[0].displacement == u);
    CHECK(worst < 1e-12);
    Points again;
    engine->displacement(again);
    CHECK(largest_error(again, u) < 1e-12);
  }
}

TEST_CASE(
    "inertial loading: without the data it is refused with the way out, unless nothing spins") {
  Model model = synthetic_cube(2, 5, 10);
  CHECK_THROWS_WITH(Simulation(spinning(share(model), Vector3::Zero())),
                    ContainsSubstring("no centrifugal response for engine = \"modal\"") &&
                        ContainsSubstring("method = \"modal\"") &&
                        ContainsSubstring("inertial_loading"));
  CHECK_THROWS_WITH(
      check_inertial_loading(with_dense_response<float>(model), true, "scene/cube.h5"),
      ContainsSubstring("scene/cube.h5") && ContainsSubstring("engine = \"dense\""));
  CHECK_NOTHROW(check_inertial_loading(model, false, "cube.h5"));
  model.body.support = Support::kFixed;
  CHECK_NOTHROW(Simulation(spinning(share(model), Vector3::Zero())));
}
