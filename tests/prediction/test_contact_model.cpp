#include <functional>
#include <limits>

#include "device_bridge/contact/contact_predictor.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;

namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A cube that a tip touches from above, as its bridge learns of it.
ContactModel good_model(ResponseKind kind = ResponseKind::kModal) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = test::fem_cube({}, kind);
  config.objects[0].friction = {0.6, 0.5};
  config.styluses = {{0.0, 2000.0, 0.0}};
  Simulation simulation(config);
  StepRecord record;
  StylusCommand command;
  command.present = true;
  for (int k = 0; k < 20; ++k) {
    command.tip = Vector3(0.01, 0.062 - 5e-4 * k, 0.0);
    simulation.step({&command, 1}, record);
  }
  ContactModel model;
  simulation.predict_horizon(0, command.tip, 25, model);
  return model;
}

}  // namespace

TEST_CASE("contact model: what a server says of a touch is believed", "[slow]") {
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    const ContactModel model = good_model(kind);
    CHECK(model.valid);
    CHECK(model.state == ContactState::kTouching);
    CHECK(model.step == 19);
    CHECK(model.horizon == 25);
    CHECK(check(model) == ContactModelFault::kNone);
  }
}

TEST_CASE("contact model: of a free tip it is computed in parts, of a contact at once") {
  const bool touching = GENERATE(true, false);
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = test::fem_cube({}, ResponseKind::kModal);
  config.styluses = {{0.0, 2000.0, 0.0}};
  Simulation in_parts(config);
  Simulation at_once(config);
  StepRecord record;
  StylusCommand command;
  command.present = true;
  const auto step = [&](double height) {
    command.tip = Vector3(0.01, height, 0.0);
    for (Simulation* simulation : {&in_parts, &at_once}) simulation->step({&command, 1}, record);
  };
  for (int k = 0; k < 20; ++k) step((touching ? 0.062 : 0.072) - 5e-4 * k);
  int begun = 0;
  ContactModel model;
  while (true) {
    int budget = 1;
    if (in_parts.predict_horizon(0, command.tip, 25, model, budget)) break;
    CHECK(budget <= 0);
    REQUIRE(++begun < 10);
    step(touching ? 0.052 : 0.062);
  }
  // The point that is nearest, its response and the path, a step each; all at once in contact.
  CHECK(begun == (touching ? 0 : 2));
  ContactModel whole;
  at_once.predict_horizon(0, command.tip, 25, whole);
  CHECK(model.step == whole.step);
  CHECK((model.place - whole.place).norm() < 1e-4);
  for (std::size_t n = 0; n < 25; ++n) {
    if (!touching) break;  // the nearest point is that of two steps before
    CHECK((model.path[n] - whole.path[n]).norm() < 1e-12);
    CHECK((model.response[n] - whole.response[n]).norm() < 1e-12 * whole.response[0].norm());
  }
  // What stays costs nothing of the budget.
  step(touching ? 0.052 : 0.062);
  int budget = 0;
  CHECK(in_parts.predict_horizon(0, command.tip, 25, model, budget) == touching);
}

TEST_CASE("contact model: each thing that can be wrong with one is found") {
  using Fault = ContactModelFault;
  struct Case {
    Fault fault;
    std::function<void(ContactModel&)> spoil;
  };
  const std::vector<Case> cases{
      {Fault::kShape, [](ContactModel& m) { m.horizon = 0; }},
      {Fault::kShape, [](ContactModel& m) { m.horizon = kMaxHorizon + 1; }},
      {Fault::kShape, [](ContactModel& m) { m.dt = kNaN; }},
      {Fault::kShape, [](ContactModel& m) { m.dt = 0.1; }},
      {Fault::kShape, [](ContactModel& m) { m.state = static_cast<ContactState>(3); }},
      {Fault::kNotFinite, [](ContactModel& m) { m.path[24].y() = kNaN; }},
      {Fault::kNotFinite, [](ContactModel& m) { m.response[3](0, 1) = kNaN; }},
      {Fault::kNotFinite, [](ContactModel& m) { m.other_force.x() = kNaN; }},
      {Fault::kNotFinite, [](ContactModel& m) { m.free_forces.damping.linear = -1.0; }},
      {Fault::kFar, [](ContactModel& m) { m.path[5].x() = 2e3; }},
      {Fault::kFar, [](ContactModel& m) { m.place.x() = 2e3; }},
      {Fault::kFar, [](ContactModel& m) { m.motion.position.x() = kNaN; }},
      {Fault::kFar, [](ContactModel& m) { m.motion.velocity.x() = 200.0; }},
      {Fault::kFar, [](ContactModel& m) { m.motion.angular_momentum.x() = 10.0; }},
      {Fault::kBody, [](ContactModel& m) { m.body.mass = 0.0; }},
      {Fault::kBody, [](ContactModel& m) { m.body.mass = kNaN; }},
      {Fault::kBody, [](ContactModel& m) { m.body.inertia(0, 0) = -1.0; }},
      {Fault::kBody, [](ContactModel& m) { m.motion.orientation.w() = 2.0; }},
      {Fault::kNormal, [](ContactModel& m) { m.normal *= 2.0; }},
      {Fault::kFriction, [](ContactModel& m) { m.friction.kinetic = 0.7; }},
      {Fault::kFriction, [](ContactModel& m) { m.friction.static_ = kNaN; }},
      {Fault::kAsymmetric, [](ContactModel& m) { m.response[0](0, 1) += 1e-3; }},
      {Fault::kAsymmetric, [](ContactModel& m) { m.response[7](0, 1) += 1e-3; }},
      {Fault::kStiffness, [](ContactModel& m) { m.response[0] *= -1.0; }},
      {Fault::kStiffness, [](ContactModel& m) { m.series.diagonal().array() += 2.0; }},
      {Fault::kStiffness, [](ContactModel& m) { m.series(0, 0) += 2.0; }},  // in one direction
      {Fault::kStiffness, [](ContactModel& m) { m.series *= -1.0; }},
      {Fault::kGrowing, [](ContactModel& m) { m.response[1] = 4.0 * m.response[0]; }},
  };
  const ContactModel good = good_model();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ContactModel bad = good;
    cases[i].spoil(bad);
    CAPTURE(i);
    CHECK(static_cast<int>(check(bad)) == static_cast<int>(cases[i].fault));
  }
  ContactModel stiff = good;
  stiff.series.setZero();
  CHECK(check(stiff, {.stiffest = 100.0}) == Fault::kStiffness);
}

TEST_CASE("contact model: a response may grow as far as a passive object's can, and no further") {
  const ContactModel good = good_model();
  for (const std::size_t n : {1, 2, 10}) {
    const double bound = 2.0 * static_cast<double>(n) + 1.0;
    CAPTURE(n);
    ContactModel model = good;
    model.response[n] = bound * good.response[0];
    CHECK(check(model) == ContactModelFault::kNone);
    model.response[n] = -bound * good.response[0];
    CHECK(check(model) == ContactModelFault::kNone);
    model.response[n] = 1.02 * bound * good.response[0];
    CHECK(check(model) == ContactModelFault::kGrowing);
  }
}

TEST_CASE("contact predictor: models that are not newer and steps out of reach") {
  const ContactModel model = good_model();
  ContactPredictor predictor;
  const Vector3 tip(0.01, 0.05, 0.0);
  CHECK_FALSE(predictor.solve(1, tip).known);
  predictor.receive(model);
  ContactModel other = model;
  other.valid = false;
  predictor.receive(other);  // of the same step
  CHECK(predictor.solve(20, tip).known);
  CHECK(predictor.solve(20 + 24, tip).known);
  CHECK_FALSE(predictor.solve(20 + 25, tip).known);
  CHECK(predictor.applied(20).norm() > 0.0);
  CHECK(predictor.applied(21) == Vector3::Zero());
  // Out of the object again there is no force, and no pull on the way.
  const ContactPredictor::Answer out = predictor.solve(44, Vector3(0.01, 0.2, 0.0));
  CHECK(out.known);
  CHECK(out.force == Vector3::Zero());
  CHECK(out.state == ContactState::kFree);
}

TEST_CASE("contact predictor: a tick allocates nothing", "[unsanitized]") {
  if (!test::AllocationGuard::active()) return test::leave_out(test::kNotCounted);
  ContactModel model = good_model();
  ContactPredictor predictor;
  const test::AllocationGuard guard;
  for (std::uint64_t k = 20; k < 2000; ++k) {
    model.step = k - 10;
    if (check(model) == ContactModelFault::kNone) predictor.receive(model);
    predictor.solve(k, Vector3(0.01, 0.05, 1e-5 * static_cast<double>(k)));
  }
  CHECK(guard.count() == 0);
}
