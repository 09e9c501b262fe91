// Gravity bends what is fixed, by the load on all of its mass, and what floats by what carries it.
#include <cmath>
#include <deque>
#include <iostream>

#include "common/response/modal_response.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/deformation/deformation.hpp"
#include "simulation/step/settings.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fixed_box.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/spinning_fem.hpp"
#include "tests/support/static_fem.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

const Vector3 kDown(0, -kGravity, 0);

SimulationConfig standing(std::shared_ptr<const Model> model, const Vector3& gravity = kDown) {
  SimulationConfig config;
  config.gravity = gravity;
  config.objects.resize(1);
  config.objects[0].model = std::move(model);
  config.styluses[0] = {0.0, 500.0, 0.02};
  return config;
}

Points displaced_surface_of(const ResponseEngine& engine) {
  Points u;
  engine.displacement(u);
  return u;
}

Points displaced_surface_of(const Simulation& simulation) {
  return displaced_surface_of(simulation.object().engine());
}

void step_alone(Simulation& simulation, int steps, StepRecord& record) {
  const StylusCommand nobody;
  for (int k = 0; k < steps; ++k) simulation.step({&nobody, 1}, record);
}

double largest_distance(const Points& a, const Points& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

Model synthetic_fixed(bool rest) {
  Model model = synthetic_cube(3, 20, 60);
  add_gravity(model, rest);
  model.body.support = Support::kFixed;
  return model;
}

// Comes down on the top, and takes hold of it.
StylusCommand touch(const Model& model, int k) {
  if (k < 20 || k > 160) return {};
  const double top = model.mesh.nodes.col(1).maxCoeff();
  const double depth = 1e-4 * std::min(k - 20, 60) + 0.004;
  return at_tip(Vector3(0.01, top - depth, 0.005), k > 60);
}

// A force on the nodes of a patch, in the coordinates of the whole mesh.
void add_load(const ModelMesh& mesh, int node, const Vector3& force, Eigen::VectorXd& load) {
  load.segment<3>(3 * mesh.surface_nodes[static_cast<std::size_t>(node)]) += force;
}

}  // namespace

TEST_CASE("gravity: a fixed cube stands in its static sag from the first step on", "[slow]") {
  const ResponseKind kind = GENERATE(ResponseKind::kModal, ResponseKind::kDense);
  FixedBox box;
  if (kind == ResponseKind::kModal) box.order = 2;
  const auto model = fixed_box(box, kind);
  const Vector3 gravity = GENERATE(Vector3(0, -9.81, 0), Vector3(3, 5, -2));
  SimulationConfig config = standing(model, gravity);
  config.objects[0].orientation = Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 2, 2) / 3.0));
  const Points truth = clamped_sag(*model, 1, config.objects[0].orientation.conjugate() * gravity);
  Simulation simulation(config);
  StepRecord record;
  step_alone(simulation, 1, record);
  const double first = largest_error(displaced_surface_of(simulation), truth);
  step_alone(simulation, 500, record);
  const double later = largest_error(displaced_surface_of(simulation), truth);
  std::cout << "fixed cube, " << (kind == ResponseKind::kModal ? "modes" : "dense") << ", sag "
            << 1000 * truth.rowwise().norm().maxCoeff() << " mm, error against static FEM " << first
            << " at once, " << later << " after 500 steps\n";
  CHECK(first < 1e-6);
  CHECK(later < 1e-6);
  CHECK(record.object[0].position == Vector3::Zero());
  CHECK(record.object[0].velocity == Vector3::Zero());
}

TEST_CASE("gravity: the tip of a slender bar comes down as beam theory says", "[slow]") {
  constexpr double kLength = 0.3;
  constexpr double kHeight = 0.02;
  FixedBox bar;
  bar.size = Vector3(kLength, kHeight, kHeight);
  bar.cells = {20, 2, 2};
  bar.clamped_axis = 0;
  bar.youngs_modulus = 2e5;
  bar.poisson_ratio = 0.3;
  bar.order = 2;
  bar.modes = 40;
  const auto model = fixed_box(bar);
  Simulation simulation(standing(model));
  StepRecord record;
  step_alone(simulation, 1, record);
  const Points u = displaced_surface_of(simulation);
  const Points truth = clamped_sag(*model, 0, kDown);
  const double error = largest_error(u, truth);
  Model modes_alone = *model;
  std::get<ModalResponse>(modes_alone.response).gravity_rest.resize(0, 3);
  Simulation without(standing(share(modes_alone)));
  step_alone(without, 1, record);
  const double tip = -u.col(1).minCoeff();
  const double load = 110.0 * kGravity;  // per volume
  const double bending = load * 12.0 * std::pow(kLength, 4) / (8.0 * 2e5 * kHeight * kHeight);
  const double shear = load * kLength * kLength / (2.0 * (5.0 / 6.0) * 2e5 / 2.6);
  std::cout << "slender bar: tip " << 1000 * tip << " mm, rho g A L^4 / (8 E I) " << 1000 * bending
            << " mm, with shear " << 1000 * (bending + shear) << " mm; 40 modes against static FEM "
            << error << ", without what the others add "
            << largest_error(displaced_surface_of(without), truth) << '\n';
  CHECK(tip == Approx(bending + shear).epsilon(0.02));
  CHECK(error < 1e-6);
}

TEST_CASE("gravity: engines agree on a fixed cube that is touched while gravity changes") {
  FixedBox box;
  box.cells = {2, 2, 2};
  const auto modal = fixed_box(box);
  const auto dense = fixed_box(box, ResponseKind::kDense);
  Simulation a(standing(modal));
  Simulation b(standing(dense));
  StepRecord record;
  double peak = 0.0;
  double worst = 0.0;
  int touching = 0;
  for (int k = 0; k < 400; ++k) {
    if (k % 100 == 50) {
      const Vector3 gravity = k == 150 ? Vector3::Zero() : Vector3(0.02 * k, -5.0, 1.0);
      for (Simulation* simulation : {&a, &b}) {
        Settings settings = simulation->settings();
        settings.gravity = gravity;
        simulation->set(settings);
      }
    }
    const StylusCommand command = touch(*modal, k);
    for (Simulation* simulation : {&a, &b}) simulation->step({&command, 1}, record);
    touching += record.stylus[0].contact == ContactState::kFree ? 0 : 1;
    const Points u = displaced_surface_of(a);
    peak = std::max(peak, u.rowwise().norm().maxCoeff());
    worst = std::max(worst, largest_distance(u, displaced_surface_of(b)));
  }
  INFO("difference " << worst << " of " << peak << " m");
  CHECK(touching > 50);
  CHECK(worst < 1e-6 * peak);
}

TEST_CASE("gravity: both engines equal the direct sum over the gravity of every step") {
  constexpr int kSteps = 60;
  const Model model = synthetic_fixed(false);
  const auto& response = std::get<ModalResponse>(model.response);
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const auto by_modes = make_engine(share(model));
  const auto by_history = make_engine(share(with_dense_response<double>(model)));
  Eigen::MatrixXd h(response.mode_count(), 4 * kSteps);
  for (int i = 0; i < response.mode_count(); ++i) {
    h.row(i) = held_force_response(held_force_oscillator(response.angular_frequency(i),
                                                         response.decay_rate(i), model.dt),
                                   4 * kSteps)
                   .transpose();
  }
  const auto points = [&](const Eigen::VectorXd& q) {
    const Eigen::VectorXd u = shapes * q;
    return Points(Eigen::Map<const Points>(u.data(), u.size() / 3, 3));
  };
  const Vector3 at_start(1.0, -9.81, 2.0);  // since ever
  std::deque<Vector3> gravity;
  Points u;
  double peak = 0.0;
  for (int k = 0; k < 4 * kSteps; ++k) {
    Vector3 now = at_start;
    if (k >= 20) now = Vector3(0, 3, 0);
    if (k >= 23 && k < 35) now = Vector3(0.3 * k, -2, std::sin(0.5 * k));
    if (k >= 140) now.setZero();
    gravity.push_front(now);
    for (const auto* engine : {&by_modes, &by_history})
      (*engine)->capabilities().gravity->set_gravity(now);
    const Vector3 free = by_modes->free_displacement(4);
    const Vector3 free_by_history = by_history->free_displacement(4);
    for (const auto* engine : {&by_modes, &by_history}) (*engine)->advance({});
    // All that was before the start is at rest by then.
    Eigen::VectorXd whole = response.angular_frequency.cwiseAbs2().cwiseInverse().cwiseProduct(
        response.gravity * at_start);
    Eigen::VectorXd cut = Eigen::VectorXd::Zero(whole.size());
    for (int age = 0; age < 4 * kSteps; ++age) {
      const auto index = static_cast<std::size_t>(age);
      const Vector3 then = index < gravity.size() ? gravity[index] : at_start;
      whole += h.col(age).cwiseProduct(response.gravity * (then - at_start));
      if (age < kSteps) cut += h.col(age).cwiseProduct(response.gravity * then);
    }
    peak = std::max(peak, points(whole).cwiseAbs().maxCoeff());
    by_modes->displacement(u);
    REQUIRE((u - points(whole)).cwiseAbs().maxCoeff() <= 1e-11 * peak);
    REQUIRE((free - u.row(4).transpose()).norm() <= 1e-12 * peak);
    by_history->displacement(u);
    REQUIRE((u - points(cut)).cwiseAbs().maxCoeff() <= 1e-11 * peak);
    REQUIRE((free_by_history - u.row(4).transpose()).norm() <= 1e-12 * peak);
  }
}

TEST_CASE("gravity: set before the first step and after a reset nothing rings") {
  const Model modal = synthetic_fixed(true);
  const Model without_rest = synthetic_fixed(false);
  for (const Model& model : {modal, with_dense_response<double>(without_rest)}) {
    const auto engine = make_engine(share(model));
    engine->capabilities().gravity->set_gravity(Vector3(1, 1, 1));
    engine->capabilities().gravity->set_gravity(
        kDown);  // no step between: as if the other had never been
    const Points sag = displaced_surface_of(*engine);
    CHECK(sag.norm() > 0.0);
    double moved = 0.0;
    for (int k = 0; k < 200; ++k) {
      engine->advance({});
      moved = std::max(moved, largest_distance(displaced_surface_of(*engine), sag));
    }
    CHECK(moved < 1e-13 * sag.norm());
    // It swings when it changes; where a reset comes before or after does not matter.
    engine->capabilities().gravity->set_gravity(2.0 * kDown);
    CHECK(largest_distance(displaced_surface_of(*engine), sag) < 1e-13 * sag.norm());
    engine->advance({});
    CHECK(largest_distance(displaced_surface_of(*engine), 2.0 * sag) > 1e-3 * sag.norm());
    engine->reset();
    const Points reset_last = displaced_surface_of(*engine);
    CHECK(largest_distance(reset_last, 2.0 * sag) < 1e-13 * sag.norm());
    engine->advance({});
    engine->reset();
    engine->capabilities().gravity->set_gravity(kDown);
    CHECK(displaced_surface_of(*engine) == sag);
    engine->advance({});
    CHECK(largest_distance(displaced_surface_of(*engine), sag) < 1e-13 * sag.norm());
  }
}

TEST_CASE("gravity: no node's free displacement is beyond its bound, where an engine knows one") {
  const Model model = synthetic_fixed(true);
  const auto modal = make_engine(share(model));
  const auto dense = make_engine(share(with_dense_response<double>(synthetic_fixed(false))));
  for (int k = 0; k < 300; ++k) {
    const Vector3 gravity = k < 100 ? Vector3(0.1 * k, -9.81, 3.0) : Vector3::Zero();
    for (const auto* engine : {&modal, &dense}) {
      (*engine)->capabilities().gravity->set_gravity(gravity);
      double largest = 0.0;
      for (int node = 0; node < model.mesh.surface_node_count(); ++node) {
        largest = std::max(largest, (*engine)->free_displacement(node).cwiseAbs().maxCoeff());
      }
      REQUIRE(largest <= (1.0 + 1e-12) * (*engine)->free_displacement_bound());
      if (k == 0) CHECK((*engine)->free_displacement_bound() < 10.0 * largest);
      (*engine)->advance({});
    }
  }
  CHECK(dense->free_displacement_bound() == 0.0);
}

TEST_CASE("gravity: path and prediction are what stepping on brings") {
  const bool changes = GENERATE(false, true);
  for (const Model& model : {synthetic_fixed(true), synthetic_fixed(false),
                             with_dense_response<double>(synthetic_fixed(false))}) {
    const auto engine = make_engine(share(model));
    engine->capabilities().gravity->set_gravity(kDown);
    for (int k = 0; k < 30; ++k) engine->advance({});
    if (changes) engine->capabilities().gravity->set_gravity(Vector3(4, 2, -3));
    ContactPatch patch;
    patch.add(3, 0.5);
    patch.add(7, 0.3);
    patch.add(11, 0.2);
    const std::vector<NodalForce> held{{2, Vector3(0.1, -0.2, 0.3)}};
    std::vector<Vector3> path(kMaxHorizon);
    std::vector<Matrix3> response(kMaxHorizon);
    engine->predict_horizon(patch, held, path, response);
    Vector3 h;
    ContactMatrix W;
    engine->predict({&patch, 1}, {&h, 1}, W);
    const Vector3 free = mean(patch, [&](int node) { return engine->free_displacement(node); });
    CHECK((h - free).norm() <= 1e-13 * free.norm());
    double largest = 0.0;
    for (const Vector3& place : path) largest = std::max(largest, place.norm());
    for (std::size_t n = 0; n < path.size(); ++n) {
      engine->advance(held);
      const Points u = displaced_surface_of(*engine);
      const Vector3 there = mean(patch, [&](int i) { return Vector3(u.row(i).transpose()); });
      REQUIRE((path[n] - there).norm() < 1e-6 * largest);  // tables in single precision
    }
  }
}

TEST_CASE("gravity: a force that comes late acts as one in time") {
  for (const Model& model :
       {synthetic_fixed(true), with_dense_response<double>(synthetic_fixed(false))}) {
    const auto in_time = make_engine(share(model));
    const auto late = make_engine(share(model));
    const NodalForce force{5, Vector3(0.3, -0.1, 0.2)};
    for (const auto* engine : {&in_time, &late})
      (*engine)->capabilities().gravity->set_gravity(kDown);
    for (int k = 0; k < 20; ++k) {
      if (k == 12) {
        for (const auto* engine : {&in_time, &late})
          (*engine)->capabilities().gravity->set_gravity(Vector3(1, 2, 3));
      }
      in_time->advance({&force, k == 10 ? 1U : 0U});
      late->advance({});
      if (k == 14) late->add_delayed_force({&force, 1}, 4);
    }
    CHECK(largest_distance(displaced_surface_of(*in_time), displaced_surface_of(*late)) <
          1e-13 * displaced_surface_of(*late).norm());
  }
}

TEST_CASE("gravity: without it, and of a floating body, every bit is as without the data") {
  const bool fixed = GENERATE(true, false);
  for (const bool dense : {false, true}) {
    Model without = synthetic_cube(3, 20, 60);
    without.body.support = fixed ? Support::kFixed : Support::kFloating;
    Model with = without;
    add_gravity(with, !dense);
    const auto form = [&](const Model& model) {
      return share(dense ? with_dense_response<double>(model) : model);
    };
    Simulation a(standing(form(with), fixed ? Vector3::Zero() : kDown));
    Simulation b(standing(form(without), fixed ? Vector3::Zero() : kDown));
    StepRecord of_a;
    StepRecord of_b;
    for (int k = 0; k < 200; ++k) {
      const StylusCommand command = touch(with, k);
      a.step({&command, 1}, of_a);
      b.step({&command, 1}, of_b);
      REQUIRE(of_a.stylus[0].force == of_b.stylus[0].force);
      REQUIRE(of_a.object[0].position == of_b.object[0].position);
    }
    CHECK(displaced_surface_of(a) == displaced_surface_of(b));
  }
}

TEST_CASE("gravity: which objects it can bend") {
  SimulationObject object;
  object.model = share(synthetic_cube(2, 5, 10));
  CHECK(takes_gravity(object));  // floats
  Model model = synthetic_cube(2, 5, 10);
  model.body.support = Support::kFixed;
  object.model = share(model);
  CHECK_FALSE(takes_gravity(object));
  add_gravity(model);
  object.model = share(model);
  CHECK(takes_gravity(object));
  object.model = share(with_dense_response<float>(model));
  CHECK(takes_gravity(object));
  std::get<ModalResponse>(model.response).gravity.resize(0, 3);
  object.model = share(with_dense_response<float>(model));
  CHECK_FALSE(takes_gravity(object));
  // Without the data it stays as it was.
  Simulation simulation(standing(share(model)));
  StepRecord record;
  step_alone(simulation, 3, record);
  CHECK(displaced_surface_of(simulation).isZero(0.0));
}

TEST_CASE("gravity: the deformation follows the force step to the bit") {
  for (const bool dense : {false, true}) {
    const Model model = synthetic_fixed(!dense);
    SimulationConfig config = standing(share(dense ? with_dense_response<double>(model) : model));
    config.objects[0].orientation = Quaternion(1.0, 0.2, -0.3, 0.1);  // of no unit length
    Simulation simulation(config);
    Deformation deformation(config);
    SurfaceFrame frame = rest_frame(config);
    deformation.compute(frame);
    CHECK(frame.objects[0].displacement == displaced_surface_of(simulation));
    StepRecord record;
    for (int k = 0; k < 200; ++k) {
      if (k == 40 || k == 90 || k == 120) {
        Settings settings = simulation.settings();
        settings.gravity = Vector3(0.1 * k, -5.0, 2.0);
        simulation.set(settings);
      }
      if (k == 70 || k == 150) {
        Settings settings = simulation.settings();
        settings.object[0].material_damping = 0.01 * k;
        simulation.set(settings);
      }
      const StylusCommand command = touch(model, k);
      simulation.step({&command, 1}, record, k == 120 || k == 150);
      deformation.follow(record);
      deformation.compute(frame);
      REQUIRE(frame.objects[0].displacement == displaced_surface_of(simulation));
    }
  }
}

TEST_CASE("gravity: nothing allocates while a fixed object sags, swings and is touched") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  FixedBox box;
  box.cells = {2, 2, 2};
  const int form = GENERATE(0, 1, 2);
  if (form == 1) {
    box.cells = {3, 3, 3};
    box.modes = 20;
  }
  const auto model = fixed_box(box, form == 2 ? ResponseKind::kDense : ResponseKind::kModal);
  Simulation simulation(standing(model));
  Settings settings = simulation.settings();
  StepRecord record;
  ContactModel contact;
  int touching = 0;
  const AllocationGuard guard;
  for (int k = 0; k < 400; ++k) {
    if (k % 50 == 30) {
      settings.gravity = Vector3(0, -0.05 * k, 1.0);
      simulation.set(settings);
    }
    const StylusCommand command = touch(*model, k % 200);
    simulation.step({&command, 1}, record, k == 300);
    if (command.present) simulation.predict_horizon(0, command.tip, 8, contact);
    touching += record.stylus[0].contact == ContactState::kFree ? 0 : 1;
  }
  CHECK(guard.count() == 0);
  CHECK(touching > 50);
}

// Nothing of gravity is in the response of a floating body. Its lasting answer to a force f is that
// of f balanced by the inertia of all parts, K u = f - M r, with the rigid acceleration r that f
// gives the body. At rest f carries the weight, r = -g, and this is K u = f + M g: the static sag.
TEST_CASE("gravity: a cube that hangs from a stylus has the shape of its weight and that force",
          "[slow]") {
  const auto model = fem_cube({3, 20000.0, 60.0, 0.002, 300, 0.49, 2});
  SimulationConfig config = standing(model);
  config.objects[0].damping = {5.0, 5.0};
  config.styluses[0] = {0.015, 2000.0, 0.01};
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 10'000; ++k) {
    const double depth = std::min(2e-4 * k - 0.001, 0.002);
    const StylusCommand command = at_tip(Vector3(0.004, kHalfEdge - depth, 0.003), k > 10);
    simulation.step({&command, 1}, record);
  }
  const ContactRecord& contact = record.object[0].contact[0];
  REQUIRE(contact.state == ContactState::kHeld);
  const Vector3 down = record.object[0].orientation.conjugate() * kDown;
  const double weight = model->body.mass * kGravity;
  CHECK((contact.force + model->body.mass * down).norm() < 1e-6 * weight);
  ContactPatch patch;
  PressureMask mask(simulation.object().surface(), 0.015);
  mask.spread(contact.point, patch);
  Eigen::VectorXd load = weight_of(*model, down);
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    add_load(model->mesh, patch.nodes[i], patch.weights[i] * contact.force, load);
  }
  const Points truth = balanced_displacement(*model, stiffness_of(*model), load);
  const double error = largest_error(displaced_surface_of(simulation), truth);
  std::cout << "cube that hangs: " << patch.count << " nodes carry "
            << contact.force.norm() / weight << " of its weight, largest displacement "
            << 1000 * truth.rowwise().norm().maxCoeff() << " mm, error against static FEM " << error
            << '\n';
  CHECK(error < 1e-5);
}

TEST_CASE("gravity: a cube that rests on the floor has the shape of its weight and its reaction",
          "[slow]") {
  const auto model = fem_cube({3, 20000.0, 60.0, 0.002, 300, 0.49, 2});
  SimulationConfig config = standing(model);
  config.objects[0].damping = {5.0, 5.0};
  config.floor = FloorConfig{Vector3(0, 1, 0), -kHalfEdge, {0.5, 0.5}};
  Simulation simulation(config);
  StepRecord record;
  step_alone(simulation, 10'000, record);
  const ObjectRecord& object = record.object[0];
  const double weight = model->body.mass * kGravity;
  const Vector3 down = object.start.orientation.conjugate() * kDown;
  Eigen::VectorXd load = weight_of(*model, down);
  for (int i = 0; i < object.floor_count; ++i) {
    const FloorForce& floor = object.floor[static_cast<std::size_t>(i)];
    add_load(model->mesh, floor.node, floor.force.cast<double>(), load);
  }
  const Points truth = balanced_displacement(*model, stiffness_of(*model), load);
  const double error = largest_error(displaced_surface_of(simulation), truth);
  const double off = (object.floor_force + model->body.mass * kDown).norm() / weight;
  std::cout << "cube that rests: " << object.floor_count << " nodes carry it, force off by " << off
            << " of its weight, largest displacement " << 1000 * truth.rowwise().norm().maxCoeff()
            << " mm, error against static FEM " << error << '\n';
  CHECK(off < 1e-4);
  CHECK(error < 1e-3);
  CHECK(truth.rowwise().norm().maxCoeff() > 1e-4);
}
