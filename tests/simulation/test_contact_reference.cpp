// Two soft cubes pressed together, against finite elements on their whole meshes.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "simulation/contact/normal_cone.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_contact.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kReach = 0.012;    // [m]
constexpr double kNoSlip = 1000.0;  // friction
constexpr int kCells = 6;           // of the run's meshes, an edge

/// How two cubes are pressed together: the upper one stands on the lower one, by its weight.
struct Press {
  FemCube lower;
  FemCube upper;
  double gravity = kGravity;  // [m/s^2]
  double turn = 0.0;          // of the upper about x [rad]
  double aside = 0.0;         // of the upper along z [m]
  double friction = 0.0;
  bool upper_first = false;  // in the scene
};

FemCube cube(double youngs_modulus) {
  return {.cells = kCells, .youngs_modulus = youngs_modulus, .poisson_ratio = 0.3};
}

// Tethers keep the lower one in its place, and both from turning, which for the upper one on its
// edge is all that keeps it upright.
SimulationConfig scene(const Press& press) {
  SimulationConfig config;
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) {
    object.friction = {press.friction, press.friction};
    object.damping = {20.0, 20.0};
    object.tether.angular_stiffness = 50.0;
  }
  SimulationObject& lower = config.objects[0];
  SimulationObject& upper = config.objects[1];
  lower.model = fem_cube(press.lower);
  lower.tether.stiffness = 5000.0;
  upper.model = fem_cube(press.upper);
  upper.orientation = Quaternion(Eigen::AngleAxisd(press.turn, Vector3::UnitX()));
  const double extent =
      kHalfEdge * (std::abs(std::cos(press.turn)) + std::abs(std::sin(press.turn)));
  const auto middle = [](const SimulationObject& object) -> Vector3 {  // from the centre of mass
    return object.orientation * (Vector3::Constant(kHalfEdge) - object.model->mesh.com_offset);
  };
  upper.position = middle(lower) + Vector3(0, kHalfEdge + extent, press.aside) - middle(upper);
  if (press.upper_first) std::swap(lower, upper);
  return config;
}

struct Pressed {
  double force = 0.0;     // vertical [N]
  double sideways = 0.0;  // [N]
  double approach = 0.0;  // of the centres of mass [m]
  std::vector<BodyContactRecord> contacts;
};

// Under a weight that grows within 1.4 s, until all is at rest.
Pressed press_together(const Press& press) {
  const SimulationConfig config = scene(press);
  const int above = press.upper_first ? 0 : 1;
  const auto upper = static_cast<std::size_t>(above);
  const std::size_t lower = 1 - upper;
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  Settings settings = simulation.settings();
  for (int k = 1; k <= 1500; ++k) {
    settings.gravity = Vector3(0, -press.gravity * std::min(1.0, k / 700.0), 0);
    simulation.set(settings);
    step_alone(simulation, *record);
  }
  CHECK(record->object[upper].velocity.norm() < 1e-4);
  const Vector3 force = force_between(*record, above, 1 - above);
  const auto apart = [&](const auto& objects) {
    return objects[upper].position.y() - objects[lower].position.y();
  };
  return {force.y(),
          std::hypot(force.x(), force.z()),
          apart(config.objects) - apart(record->object),
          {record->body_contacts().begin(), record->body_contacts().end()}};
}

FemContactBody at(const SimulationObject& object, FemContactBody body) {
  // The middle of the cube stays where it is, whatever the mesh.
  const Vector3 shift = object.model->mesh.com_offset - body.mesh.com_offset;
  body.position = object.position - object.orientation * shift;
  body.orientation = object.orientation;
  return body;
}

/// Meshes of the reference: those of the run (cells 0) or others.
struct ReferenceMesh {
  int cells = 0;
  int order = 1;
};

FemContact reference(const Press& press, const ReferenceMesh& mesh = {}) {
  SimulationConfig config = scene(press);
  if (press.upper_first) std::swap(config.objects[0], config.objects[1]);
  const auto body = [&](const SimulationObject& object) {
    const Model& model = *object.model;
    return at(object, mesh.cells == 0 ? FemContactBody{model.mesh, model.material, {}, {}}
                                      : fine_cube(mesh.cells, mesh.order, model.material));
  };
  FemPress load{config.objects[1].model->body.mass * press.gravity, press.friction > 0.0};
  if (load.sticks) load.moves = {true, true, true, false, false, false};
  return fem_contact(body(config.objects[0]), body(config.objects[1]), load, kReach);
}

// rms of what a contact of the run carries less what the nearest node of the reference, of the same
// mesh, does; over their mean.
double nodal_error(const Pressed& run, const FemContact& fem) {
  double squares = 0.0;
  for (const BodyContactRecord& contact : run.contacts) {
    const Vector3 here(contact.position.x(), 0.0, contact.position.z());
    Eigen::Index node = 0;
    Points off = fem.position.rowwise() - here.transpose();
    off.col(1).setZero();
    off.rowwise().squaredNorm().minCoeff(&node);
    squares += std::pow(std::abs(contact.force.y()) - fem.force(node, 1), 2);
  }
  const auto count = static_cast<double>(run.contacts.size());
  return std::sqrt(squares / count) / (run.force / count);
}

// rms, over the contacts of the run, of the pressure there less that of the reference, over the
// mean of the run's; of the reference what acts on its nodes that are nearer to a contact's node
// than to others.
double pressure_error(const Pressed& run, const FemContact& fem) {
  constexpr double spacing = 2.0 * kHalfEdge / kCells;
  // Contacts at the rim are nearer to the middle than their nodes.
  const auto node = [](double x) { return spacing * std::round(x / (0.94 * spacing)); };
  double area = 0.0;
  double squares = 0.0;
  for (const BodyContactRecord& contact : run.contacts) {
    const double x = node(contact.position.x());
    const double z = node(contact.position.z());
    double force = 0.0;
    double fem_area = 0.0;
    for (Eigen::Index i = 0; i < fem.force.rows(); ++i) {
      if (std::abs(fem.position(i, 0) - x) > 0.501 * spacing) continue;
      if (std::abs(fem.position(i, 2) - z) > 0.501 * spacing) continue;
      // A node between contacts' nodes counts for each of them by its share.
      const auto share = [](double off) { return std::abs(off) > 0.499 * spacing ? 0.5 : 1.0; };
      const double part = share(fem.position(i, 0) - x) * share(fem.position(i, 2) - z);
      force += part * fem.force(i, 1);
      fem_area += part * fem.area(i);
    }
    const double off = std::abs(contact.force.y()) / contact.area - force / fem_area;
    squares += contact.area * off * off;
    area += contact.area;
  }
  return std::sqrt(squares / area) / (run.force / area);
}

}  // namespace

TEST_CASE("normal cone: no sum of its faces' normals is nearer to a direction") {
  const Vector3 a = Vector3(1, 0.2, 0).normalized();
  const Vector3 b = Vector3(-0.3, 1, 0.1).normalized();
  const Vector3 c = Vector3(0, 0.1, 1).normalized();
  for (const std::vector<Vector3>& faces :
       {std::vector<Vector3>{a}, std::vector<Vector3>{a, b}, std::vector<Vector3>{a, b, c}}) {
    for (int k = 0; k < 200; ++k) {
      const double height = -0.99 + 0.0099 * k;
      const double turn = 2.4 * k;
      const Vector3 direction(std::cos(turn) * std::sqrt(1 - height * height), height,
                              std::sin(turn) * std::sqrt(1 - height * height));
      const double found = nearest_in_cone(faces, direction).dot(direction);
      double best = -1.0;
      constexpr int kParts = 40;
      for (int i = 0; i <= kParts; ++i) {
        for (int j = 0; i + j <= kParts; ++j) {
          const std::array<double, 3> share{static_cast<double>(kParts - i - j),
                                            static_cast<double>(i), static_cast<double>(j)};
          Vector3 sum = Vector3::Zero();
          for (std::size_t f = 0; f < faces.size(); ++f) sum += share[f] * faces[f];
          if (!sum.isZero()) best = std::max(best, sum.normalized().dot(direction));
        }
      }
      CHECK(found > best - 1e-9);
      CHECK(found < best + 0.005);  // of the grid of shares
    }
  }
}

TEST_CASE("reference: its forces balance the load, none pulls, no node is inside") {
  Press press{cube(5000.0), cube(20'000.0)};
  press.turn = GENERATE(0.0, 0.25 * std::numbers::pi);
  press.friction = GENERATE(0.0, kNoSlip);
  const FemContact fem = reference(press);
  const double weight = fem_cube(press.upper)->body.mass * press.gravity;
  CHECK(fem.force.col(1).sum() == Approx(weight));
  CHECK(std::abs(fem.force.col(0).sum()) < 1e-9 * weight);
  CHECK(std::abs(fem.force.col(2).sum()) < 1e-9 * weight);
  CHECK(fem.force.col(1).minCoeff() >= -1e-9 * weight);
  CHECK(fem.gap.minCoeff() >= -1e-12);
  for (Eigen::Index i = 0; i < fem.gap.size(); ++i) {
    CHECK((fem.gap(i) < 1e-12 || fem.force.row(i).isZero()));
  }
}

TEST_CASE("pressed cubes: face on face they approach and press as by finite elements", "[slow]") {
  struct Case {
    double lower, upper;  // [Pa]
    double friction;
    double aside;  // [m]
  };
  for (const Case& each :
       {Case{5000.0, 5000.0, 0.0, 0.0}, Case{20'000.0, 5000.0, 0.0, 0.0},
        Case{20'000.0, 5000.0, kNoSlip, 0.0}, Case{5000.0, 5000.0, kNoSlip, 0.02}}) {
    Press press{cube(each.lower), cube(each.upper)};
    press.friction = each.friction;
    press.aside = each.aside;
    const Pressed run = press_together(press);
    const double weight = fem_cube(press.upper)->body.mass * press.gravity;
    CHECK(run.force == Approx(weight).epsilon(1e-4));
    const FemContact same = reference(press);
    const FemContact fine = reference(press, {12, 1});
    INFO(each.lower << ", " << each.upper << " Pa, friction " << each.friction << ", " << each.aside
                    << " m aside: approach over the reference's with the same mesh "
                    << run.approach / same.approach << ", with half the cells' size "
                    << run.approach / fine.approach << ", pressure off by "
                    << pressure_error(run, same) << ", " << pressure_error(run, fine));
    // The force at an approach goes with 1 / approach at a force.
    CHECK(run.approach == Approx(same.approach).epsilon(0.03));
    CHECK(run.approach == Approx(fine.approach).epsilon(0.03));
    // Patches at the rim touch at the centroids of their areas, so that the other cube's nodes at
    // its rim carry too little: all that the pressure is off by (below 0.015 if they touched at
    // their nodes). Of cubes that differ in stiffness it is 0.15 to 0.18. Aside, patches that are
    // covered in part have no area of their own to compare with.
    if (each.lower == each.upper && each.aside == 0.0) CHECK(pressure_error(run, fine) < 0.15);
  }
}

// What a line of nodes carries depends on the mesh, however fine: the reference's approach is 31 %
// larger with 12 cells an edge, 66 % with 8 quadratic ones. So it has the mesh of the run.
TEST_CASE("pressed cubes: edge on face each node carries what it does by finite elements",
          "[slow]") {
  Press press{cube(5000.0), cube(5000.0)};
  press.gravity = 1.0;
  press.turn = 0.25 * std::numbers::pi;
  press.upper_first = GENERATE(false, true);
  press.aside = GENERATE(0.0, 0.007);
  press.friction = GENERATE(0.0, 0.5, kNoSlip);
  const Pressed run = press_together(press);
  const double weight = fem_cube(press.upper)->body.mass * press.gravity;
  CHECK(run.force == Approx(weight).epsilon(1e-3));
  CHECK(run.sideways < 1e-3 * weight);
  const FemContact fem = reference(press);
  const double off = nodal_error(run, fem);
  INFO("approach over the reference's " << run.approach / fem.approach << ", nodal forces off by "
                                        << off << " of the mean");
  CHECK(run.contacts.size() == 7);
  CHECK(run.approach == Approx(fem.approach).epsilon(0.03));
  CHECK(off < 0.05);
}
