// The finite elements that replays are compared with: against closed forms of rigid motion, and
// against the impulse responses where both must say the same.
#include <numbers>

#include "replay/reference/fem_body.hpp"
#include "replay/reference/fem_reference.hpp"
#include "replay/rerun/rerun.hpp"
#include "tests/replay/kept_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr double kFemStep = 0.002;
constexpr auto kCorotational = precompute::Elasticity::kCorotational;

SimulationConfig one_fem_cube(const FemCube& cube) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube(cube);
  return config;
}

// So stiff that it moves as a rigid body: its lowest mode has some 200 Hz.
SimulationConfig rigid_fem_cube() {
  return one_fem_cube({.cells = 2, .youngs_modulus = 5e5, .poisson_ratio = 0.3});
}

ObjectRecord fly(FemBody& body, int steps) {
  ObjectRecord record;
  for (int k = 0; k < steps; ++k) {
    body.step(record, {});
    record.start.orientation = record.orientation;
    record.halfway = record.orientation;
  }
  return record;
}

double angle_about_z(const Quaternion& q) {
  return 2.0 * std::atan2(q.z(), q.w());
}

/// The surface point at the node nearest to a place.
SurfacePoint node_at(const Model& model, const Vector3& place) {
  int nearest = 0;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const double distance = (model.mesh.rest_position(i) - place).norm();
    if (distance < (model.mesh.rest_position(nearest) - place).norm()) nearest = i;
  }
  for (Eigen::Index t = 0; t < model.mesh.triangles.rows(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      if (model.mesh.triangles(t, corner) != nearest) continue;
      SurfacePoint point;
      for (std::size_t i = 0; i < 3; ++i) {
        point.nodes[i] = model.mesh.triangles(t, static_cast<Eigen::Index>(i));
        point.weights[i] = static_cast<int>(i) == corner ? 1.0 : 0.0;
      }
      return point;
    }
  }
  return {};
}

/// Half a sine of 20 ms on the top, off its middle and a little askew.
struct Tap {
  double peak = 0.05;  ///< [N]
  int steps = 500;

  KeptRun run(const SimulationConfig& config) const {
    KeptRun kept(config);
    Simulation simulation(config);
    const SurfacePoint point = node_at(*config.objects[0].model, Vector3(0.03, 0.06, 0.0));
    StepRecord record;
    for (int k = 0; k < steps; ++k) {
      const double size = k < 10 ? peak * std::sin(std::numbers::pi * (k + 0.5) / 10) : 0.0;
      StylusCommand command{size > 0.0, 0, Vector3::Zero(), {}};
      const Vector3 direction = Vector3(0.2, -1.0, 0.1).normalized();
      if (size > 0.0) {
        command.given = GivenForce{ContactState::kTouching, point,
                                   config.objects[0].orientation * (size * direction), 0};
      }
      simulation.step({&command, 1}, record);
      kept.keep(simulation, record);
    }
    return kept;
  }
};

/// Displacement of nodes against what it was [m].
struct FemDifference {
  double rms = 0.0;      ///< over nodes and steps
  double largest = 0.0;  ///< of a node
  double peak = 0.0;     ///< displacement in the run itself, of a node

  void add(const Points& was, const Points& is) {
    squares_ += (was - is).rowwise().squaredNorm().sum();
    count_ += static_cast<double>(was.rows());
    rms = std::sqrt(squares_ / count_);
    largest = std::max(largest, (was - is).rowwise().norm().maxCoeff());
    peak = std::max(peak, was.rowwise().norm().maxCoeff());
  }

 private:
  double squares_ = 0.0;
  double count_ = 0.0;
};

FemDifference fem_against(const KeptRun& run, double substep) {
  FemBody body(run.config, 0, kCorotational, substep);
  FemDifference apart;
  Points u;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    ObjectRecord record = run.records[k].object[0];
    body.step(record, {});
    body.displacement(u);
    apart.add(run.displacements[k][0], u);
  }
  return apart;
}

}  // namespace

TEST_CASE("the reference in free flight slows and falls as the rigid motion's equations say") {
  SimulationConfig config = rigid_fem_cube();
  SimulationObject& object = config.objects[0];
  config.gravity = Vector3(0, -2, 0);
  object.position = Vector3(0.1, 0.2, -0.3);
  object.velocity = Vector3(0.3, 0.0, 0.1);
  object.angular_velocity = Vector3(0, 0, 1.5);
  object.damping = {4.0, 6.0};
  FemBody body(config, 0, kCorotational, 5e-4);
  const ObjectRecord end = fly(body, 250);
  const double t = 250 * kFemStep;
  const Vector3 limit = config.gravity / 4.0;
  const Vector3 still_to_lose = object.velocity - limit;
  CHECK((end.velocity - limit - still_to_lose * std::exp(-4 * t)).norm() < 1e-12);
  // Half kicks: a trapezoidal rule, whose error is (rate h)^2 / 12 of the way.
  const Vector3 way = limit * t + still_to_lose * (1 - std::exp(-4 * t)) / 4.0;
  CHECK((end.position - object.position - way).norm() < 1e-6);
  CHECK(angle_about_z(end.orientation) == Approx(1.5 * (1 - std::exp(-6 * t)) / 6).epsilon(1e-5));
}

TEST_CASE("the reference swings on its tether at the frequency of mass and spring") {
  SimulationConfig config = rigid_fem_cube();
  SimulationObject& object = config.objects[0];
  const BodyProperties& properties = object.model->body;
  object.orientation = Quaternion(Eigen::AngleAxisd(1.0, Vector3(1, 2, 3).normalized()));
  object.velocity = Vector3(0.2, 0.0, 0.0);
  const Vector3 spin(0, 0, 0.05);  // B
  object.angular_velocity = object.orientation * spin;
  const double rate = 2.0 * std::numbers::pi;
  object.tether = {properties.mass * rate * rate, properties.inertia(2, 2) * rate * rate};
  FemBody body(config, 0, kCorotational, 5e-4);
  const ObjectRecord end = fly(body, 375);  // three quarters of a swing
  CHECK((end.position - Vector3(-0.2 / rate, 0, 0)).norm() < 1e-5 * 0.2);
  const Quaternion turned = object.orientation.conjugate() * end.orientation;
  // The mesh of six tetrahedra a cell has products of inertia: three swings, each with its rate.
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(properties.inertia);
  Vector3 swing = axes.eigenvectors().transpose() * spin;
  for (int i = 0; i < 3; ++i) {
    const double own = std::sqrt(object.tether.angular_stiffness / axes.eigenvalues()(i));
    swing(i) *= std::sin(own * 375 * kFemStep) / own;
  }
  CHECK((2.0 * turned.vec() - axes.eigenvectors() * swing).norm() < 1e-4 * 0.05 / rate);
}

TEST_CASE("the reference has the momentum of the recorded forces, and their couples") {
  const SimulationConfig config = one_fem_cube({.cells = 3, .poisson_ratio = 0.45});
  const KeptRun run = Tap{.steps = 30}.run(config);
  FemBody body(config, 0, kCorotational, kFemStep);
  for (const StepRecord& recorded : run.records) {
    ObjectRecord again = recorded.object[0];
    body.step(again, {});
    CHECK((again.velocity - recorded.object[0].velocity).norm() < 1e-12);
    CHECK((again.position - recorded.object[0].position).norm() < 1e-12);
  }
  body.reset();
  ObjectRecord record;
  record.contact[0].state = ContactState::kHeld;
  record.contact[0].point = node_at(*config.objects[0].model, Vector3(0, 0.06, 0));
  record.contact[0].force = Vector3(0, 0.05, 0);
  record.contact[0].offset = Vector3(0.01, 0, 0);
  body.step(record, {});
  const Vector3 arm = config.objects[0].model->mesh.rest_position(record.contact[0].point.nodes[0]);
  const Vector3 expected = config.objects[0].model->body.inertia.inverse() *
                           (kFemStep * (arm + Vector3(0.01, 0, 0)).cross(Vector3(0, 0.05, 0)));
  CHECK((record.angular_velocity - expected).norm() < 1e-3 * expected.norm());
}

// Measured: rms 0.04 %, largest 0.6 % of the peak; of quadratic elements 0.05 % and 1.5 %.
TEST_CASE("a tap of 0.05 N: finite elements and all modes are within 2 % of the peak for 1 s",
          "[slow]") {
  const bool linear = GENERATE(true, false);
  const KeptRun run = linear ? Tap{}.run(one_fem_cube({.cells = 4}))
                             : Tap{.steps = 100}.run(one_fem_cube({.cells = 2, .order = 2}));
  const FemDifference apart = fem_against(run, kReferenceSubstep);
  CHECK(apart.peak > 1e-4);
  CHECK(apart.rms < 0.02 * apart.peak);
  CHECK(apart.largest < 0.02 * apart.peak);
}

TEST_CASE("what sets finite elements and responses apart is as small a share as the force is",
          "[slow]") {
  const SimulationConfig config = one_fem_cube({.cells = 3});
  const auto share = [&](double peak) {
    const FemDifference apart = fem_against(Tap{.peak = peak, .steps = 50}.run(config), 1e-4);
    return apart.largest / apart.peak;
  };
  const double strong = share(0.5);
  CHECK(strong > 0.02);
  CHECK(share(0.05) == Approx(0.1 * strong).epsilon(0.05));
  CHECK(share(0.005) == Approx(0.01 * strong).epsilon(0.1));
}

TEST_CASE("the reference converges with the square of its sub-step", "[slow]") {
  const KeptRun run = Tap{.steps = 50}.run(one_fem_cube({.cells = 3}));
  FemBody finest(run.config, 0, kCorotational, 3.125e-5);
  std::array<std::unique_ptr<FemBody>, 3> bodies;
  for (std::size_t i = 0; i < 3; ++i) {
    bodies[i] = std::make_unique<FemBody>(run.config, 0, kCorotational, 2.5e-4 * (1 << i));
  }
  std::array<FemDifference, 3> apart;
  Points exact;
  Points u;
  const auto step = [](FemBody& body, ObjectRecord record, Points& surface) {
    body.step(record, {});
    body.displacement(surface);
  };
  for (const StepRecord& recorded : run.records) {
    step(finest, recorded.object[0], exact);
    for (std::size_t i = 0; i < 3; ++i) {
      step(*bodies[i], recorded.object[0], u);
      apart[i].add(exact, u);
    }
  }
  CHECK(apart[0].largest < 2e-3 * apart[0].peak);
  CHECK(apart[1].rms == Approx(4 * apart[0].rms).epsilon(0.15));
  CHECK(apart[2].rms == Approx(4 * apart[1].rms).epsilon(0.15));
}

TEST_CASE("the reference is the same however the body is turned, and after a reset") {
  SimulationConfig config = one_fem_cube({.cells = 3});
  const KeptRun run = Tap{.peak = 0.5, .steps = 30}.run(config);
  config.objects[0].orientation =
      Quaternion(Eigen::AngleAxisd(2.0, Vector3(1, -2, 3).normalized()));
  config.objects[0].position = Vector3(0.3, -0.2, 0.1);
  const KeptRun turned = Tap{.peak = 0.5, .steps = 30}.run(config);
  FemBody straight(run.config, 0, kCorotational, kFemStep);
  FemBody askew(config, 0, kCorotational, kFemStep);
  Points u;
  Points v;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    ObjectRecord a = run.records[k].object[0];
    ObjectRecord b = turned.records[k].object[0];
    straight.step(a, {});
    askew.step(b, {});
    straight.displacement(u);
    askew.displacement(v);
    REQUIRE((u - v).cwiseAbs().maxCoeff() < 1e-11);
    REQUIRE((a.contact[0].force - b.contact[0].force).norm() < 1e-10);
  }
  CHECK(u.cwiseAbs().maxCoeff() > 1e-4);
  straight.reset();
  ObjectRecord first = run.records[0].object[0];
  straight.step(first, {});
  straight.displacement(u);
  FemBody fresh(run.config, 0, kCorotational, kFemStep);
  first = run.records[0].object[0];
  fresh.step(first, {});
  fresh.displacement(v);
  CHECK(u == v);
}

TEST_CASE("the reference follows gravity, damping and the material's damping when they are set") {
  const SimulationConfig config = one_fem_cube({.cells = 3});
  Simulation simulation(config);
  KeptRun run(config);
  Settings settings = simulation.settings();
  settings.gravity = Vector3(0, -1, 0);
  settings.object[0].damping = {1.0, 2.0};
  settings.object[0].material_damping = 4.0;
  const SurfacePoint point = node_at(*config.objects[0].model, Vector3(0.02, 0.06, 0.02));
  StepRecord record;
  for (int k = 0; k < 100; ++k) {
    if (k == 20) simulation.set(settings);
    StylusCommand command{k < 5, 0, Vector3::Zero(), {}};
    if (k < 5) {
      command.given = GivenForce{ContactState::kTouching, point, Vector3(0, -0.02, 0), 0};
    }
    simulation.step({&command, 1}, record);
    run.keep(simulation, record);
  }
  std::vector<std::unique_ptr<ForcedBody>> bodies;
  bodies.push_back(std::make_unique<FemBody>(config, 0, kCorotational, kReferenceSubstep));
  ForceRerun made(config, std::move(bodies));
  FemDifference apart;
  StepRecord again;
  Points u;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    made.step(run.records[k], again);
    made.displacement(0, u);
    apart.add(run.displacements[k][0], u);
  }
  const ObjectRecord& last = run.records.back().object[0];
  CHECK(apart.largest < 5e-3 * apart.peak);
  CHECK((again.object[0].velocity - last.velocity).norm() < 2e-3 * last.velocity.norm());
  CHECK((again.object[0].angular_velocity - last.angular_velocity).norm() <
        5e-3 * last.angular_velocity.norm());
}

TEST_CASE("what the reference cannot do is refused by name") {
  TracedScene scene;
  scene.objects.push_back({"cube", "some.h5", "", ResponseKind::kModal});
  scene.config = one_fem_cube({.cells = 2});
  Model fixed = *fem_cube({.cells = 2});
  fixed.body.support = Support::kFixed;
  scene.config.objects[0].model = std::make_shared<const Model>(fixed);
  CHECK_THROWS_WITH(fem_reference(scene, kCorotational, 1e-3),
                    ContainsSubstring("some.h5") && ContainsSubstring("fixed"));
  Model heavy = *fem_cube({.cells = 2});
  heavy.mesh.node_mass(3) *= 1.1;
  scene.config.objects[0].model = std::make_shared<const Model>(heavy);
  CHECK_THROWS_WITH(fem_reference(scene, kCorotational, 1e-3), ContainsSubstring("masses"));
}

namespace {

/// How far the force of a held point that follows its tip is from the server's, as a share of its
/// peak: small motions at 1 Hz for 0.5 s.
double held_force_apart(double dt) {
  SimulationConfig config = one_fem_cube({.cells = 3, .dt = dt, .poisson_ratio = 0.45});
  config.styluses = {{0.0, 1000.0, 0.01}};
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k * dt < 0.5; ++k) {
    const double phase = 2.0 * std::numbers::pi * std::max((k + 1) * dt - 0.04, 0.0);
    const Vector3 tip(5e-4 * std::sin(phase), 0.061, 2e-4 * (1.0 - std::cos(phase)));
    const StylusCommand command{true, k * dt > 0.01 ? kGrabButton : 0, tip, {}};
    simulation.step({&command, 1}, record);
    run.keep(simulation, record);
  }
  FemBody body(config, 0, kCorotational, 5e-4, true);
  double peak = 0.0;
  double apart = 0.0;
  Points u;
  for (const StepRecord& recorded : run.records) {
    ObjectRecord again = recorded.object[0];
    body.step(again, {{recorded.stylus.data(), 1}, recorded.body_contacts()});
    const ContactRecord& contact = recorded.object[0].contact[0];
    if (contact.state != ContactState::kHeld) continue;
    const Vector3 was = recorded.object[0].halfway * contact.force;
    const Vector3 is = again.halfway * again.contact[0].force;
    peak = std::max(peak, was.norm());
    apart = std::max(apart, (was - is).norm());
    body.displacement(u);
    const Vector3 on_body = mean(ContactPatch(contact.point), [&](int node) -> Vector3 {
      return config.objects[0].model->mesh.rest_position(node) + u.row(node).transpose();
    });
    const Vector3 point = again.position + again.orientation * (on_body + contact.offset);
    REQUIRE((point + is / 1000.0 - recorded.stylus[0].tip).norm() < 1e-7);
  }
  CHECK(peak > 5e-3);
  return apart / peak;
}

}  // namespace

// Motions of 0.5 mm at 60 mm from the middle: what is not linear is below 1 % of them. It is 0.2 %,
// and up to as much again the reference's own substep makes; the server's step makes no difference.
TEST_CASE("a held point of the reference follows its tip by the server's force", "[slow]") {
  const double coarse = held_force_apart(0.002);
  const double fine = held_force_apart(0.001);
  CAPTURE(coarse, fine);
  CHECK(coarse < 0.005);
  CHECK(fine < 0.005);
}

TEST_CASE("what a bridge told too late acts in the step that it belongs to") {
  const SimulationConfig config = one_fem_cube({.cells = 3});
  const SurfacePoint point = node_at(*config.objects[0].model, Vector3(0.02, 0.06, 0.02));
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 60; ++k) {
    for (int age = 0; k > 10 && k < 20 && age < k % 4; ++age) {
      LateForce late{0, 0, age, point, Vector3(0.002, -0.01, 0.001 * age), Vector3::Zero()};
      late.arm = config.objects[0].model->mesh.rest_position(point.nodes[0]) + Vector3(0, 0, 0.01);
      REQUIRE(simulation.insert_delayed_force(late));
    }
    const StylusCommand command{};
    simulation.step({&command, 1}, record);
    run.keep(simulation, record);
  }
  const Recording recording = run.recording();
  const std::vector<DelayedForces> told = delayed_forces(recording);
  REQUIRE(told.size() == 15);
  FemBody body(config, 0, kCorotational, kReferenceSubstep, false, told);
  FemDifference late_apart;
  ObjectRecord again;
  Points u;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    again = run.records[k].object[0];
    body.step(again, {});
    body.displacement(u);
    if (k >= 20) late_apart.add(run.displacements[k][0], u);  // all has been told
  }
  const ObjectRecord& last = run.records.back().object[0];
  // The server turned each by the orientation that it knew by then, some 1e-7 rad off the trace's.
  CHECK((again.velocity - last.velocity).norm() < 1e-6 * last.velocity.norm());
  CHECK((again.angular_velocity - last.angular_velocity).norm() <
        5e-3 * last.angular_velocity.norm());
  CHECK(late_apart.largest < 0.01 * late_apart.peak);
}

// Both are linear elasticity for small strains: what sets them apart is of second order, so that
// its share grows with the force. What is of third order is a third of a percent of it here.
TEST_CASE("a tap by neo-Hookean elements is that by corotational ones, the nearer the gentler") {
  const auto apart = [](double peak) {
    const KeptRun run =
        Tap{.peak = peak, .steps = 30}.run(one_fem_cube({.cells = 3, .poisson_ratio = 0.3}));
    FemBody corotational(run.config, 0, kCorotational, 5e-4);
    FemBody neo_hookean(run.config, 0, precompute::Elasticity::kNeoHookean, 5e-4);
    FemDifference difference;
    Points one;
    Points other;
    for (const StepRecord& record : run.records) {
      ObjectRecord again = record.object[0];
      corotational.step(again, {});
      corotational.displacement(one);
      again = record.object[0];
      neo_hookean.step(again, {});
      neo_hookean.displacement(other);
      difference.add(one, other);
    }
    return difference.largest / difference.peak;
  };
  const double firm = apart(0.5);
  const double gentle = apart(0.05);
  CAPTURE(firm, gentle);
  CHECK(gentle > 1e-5);
  CHECK(gentle < 0.01);
  CHECK(firm / gentle == Approx(10.0).epsilon(0.01));
}

TEST_CASE("a reference takes its steps from a journal to the bit, and no step for another") {
  const KeptRun run = Tap{.steps = 6}.run(one_fem_cube({.cells = 2, .poisson_ratio = 0.3}));
  const TemporaryFolder folder;
  const auto ends = [&](std::size_t steps, StepJournal& journal) {
    FemBody body(run.config, 0, kCorotational, 1e-3);
    body.use(journal);
    ObjectRecord record;
    for (std::size_t k = 0; k < steps; ++k) {
      record = run.records[k].object[0];
      body.step(record, {});
    }
    Points u;
    body.displacement(u);
    return u;
  };
  StepJournal whole(folder.path() / "whole", "key");
  const Points expected = ends(6, whole);
  const std::filesystem::path path = folder.path() / "parts";
  {
    StepJournal first(path, "key");
    ends(3, first);
  }
  {
    StepJournal rest(path, "key");
    CHECK((ends(6, rest).array() == expected.array()).all());
    CHECK(rest.taken() == 3);
  }
  std::vector<double> numbers;
  {
    StepJournal written_by_two(path, "key");
    REQUIRE(written_by_two.take(numbers));
    written_by_two.keep(numbers);
  }
  StepJournal twice(path, "key");
  CHECK_THROWS_WITH(ends(6, twice), ContainsSubstring("steps of another run"));
}
