// Objects on scenery that is a triangle mesh: against a box of the same shape, and in hollows,
// which no other shape has.
#include <cmath>
#include <limits>
#include <numbers>

#include "simulation/deformation/deformation.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/simulation/voxel_mesh.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

MeshShape shape(const ModelMesh& mesh) {
  return {std::make_shared<const RestSurface>(mesh)};
}

bool everywhere(const std::array<int, 3>& /*cell*/) {
  return true;
}

/// Half a hollow sphere, open at the top, its centre at the origin.
MeshShape bowl(double inner, double outer, int rings, int sectors) {
  ModelMesh mesh;
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 3>> triangles;
  // From the lowest point of the outside up to the rim, then down the inside.
  for (const double radius : {outer, inner}) {
    for (int i = 1; i <= rings; ++i) {
      const int ring = radius == outer ? i : rings + 1 - i;
      const double polar = 0.5 * std::numbers::pi * ring / rings;
      for (int j = 0; j < sectors; ++j) {
        const double turn = 2.0 * std::numbers::pi * j / sectors;
        nodes.push_back(radius * Vector3(std::sin(polar) * std::cos(turn), -std::cos(polar),
                                         std::sin(polar) * std::sin(turn)));
      }
    }
  }
  const int below = static_cast<int>(nodes.size());
  nodes.push_back(Vector3(0, -outer, 0));
  nodes.push_back(Vector3(0, -inner, 0));
  const int last = (2 * rings - 1) * sectors;
  for (int j = 0; j < sectors; ++j) {
    const int next = (j + 1) % sectors;
    triangles.push_back({below, j, next});
    for (int i = 0; i + 1 < 2 * rings; ++i) {
      const int low = i * sectors;
      const int high = low + sectors;
      triangles.push_back({low + j, high + j, high + next});
      triangles.push_back({low + j, high + next, low + next});
    }
    triangles.push_back({below + 1, last + next, last + j});
  }
  mesh.nodes.resize(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh.nodes.row(static_cast<Eigen::Index>(i)) = nodes[i].transpose();
    mesh.surface_nodes.push_back(static_cast<int>(i));
  }
  mesh.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.triangles.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1],
        triangles[t][2];
  }
  return shape(mesh);
}

/// How deep the deepest patch of the surface is inside the scenery [m], < 0: outside. A corner is
/// nearer to it than the centroids of the patches round it, and goes in deeper.
double depth(const SimulationConfig& config, const ContactSampling& sampling,
             const SurfaceFrame& frame) {
  const ObjectSurface& body = frame.objects[0];
  double deepest = -std::numeric_limits<double>::infinity();
  for (const ContactSampling::Sample& sample : sampling.samples()) {
    const Vector3 u = mean(sampling.patch(sample.row), [&](int node) -> Vector3 {
      return body.displacement.row(node).transpose();
    });
    const Vector3 x = body.position + body.orientation * (sample.place.position + u);
    deepest = std::max(deepest, -closest(config.scenery[0], x).signed_distance);
  }
  return deepest;
}

Vector3 total_force(const StepRecord& record) {
  return force_between(record, 0, -1);
}

}  // namespace

TEST_CASE("mesh scenery: a cube falls on a mesh as on the box that has its shape", "[slow]") {
  SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 2e4}, {0.4, 0.3});
  config.objects[0].position = Vector3(0.01, 0.13, -0.02);
  config.objects[0].orientation = Eigen::AngleAxisd(0.3, Vector3(1, 2, 3).normalized());
  config.objects[0].velocity = Vector3(0.2, 0, 0.1);
  config.scenery[0].position.y() = -0.05;
  config.scenery[0].shape = BoxShape{Vector3(0.5, 0.1, 0.5)};
  Simulation on_box(config);
  config.scenery[0].shape = shape(voxel_surface({10, 2, 10}, 0.05, everywhere));
  Simulation on_mesh(config);
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  double apart = 0.0;
  double strongest = 0.0;
  for (int k = 0; k < 1000; ++k) {
    step_alone(on_box, *one);
    step_alone(on_mesh, *two);
    apart = std::max(apart, (one->object[0].position - two->object[0].position).norm());
    strongest = std::max(strongest, total_force(*two).norm());
  }
  INFO("apart " << apart << " m, largest force " << strongest << " N");
  CHECK(apart < 1e-7);
  CHECK(strongest > 1.0);
}

TEST_CASE("mesh scenery: a cube comes to rest in a bowl, which carries its weight",
          "[unsanitized]") {
  for (const double youngs_modulus : {2e4, 1e6}) {
    SimulationConfig config =
        stacked(1, {.cells = 3, .youngs_modulus = youngs_modulus}, {0.2, 0.15});
    config.scenery[0].shape = bowl(0.2, 0.21, 12, 32);
    config.objects[0].position = Vector3(0.05, -0.05, 0.02);
    config.objects[0].damping = {3.0, 3.0};
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    const RestSurface rest(config.objects[0].model->mesh);
    const ContactSampling sampling(rest, config.contact_samples);
    Deformation deformation(config);
    SurfaceFrame frame = rest_frame(config);
    double deepest = 0.0;
    Vector3 before = Vector3::Zero();
    for (int k = 0; k < 4000; ++k) {
      step_alone(simulation, *record);
      if (k == 3500) before = record->object[0].position;
      deformation.follow(*record);
      if (k % 20 != 0) continue;
      deformation.compute(frame);
      deepest = std::max(deepest, depth(config, sampling, frame));
    }
    deformation.compute(frame);
    const double at_rest = depth(config, sampling, frame);
    const double weight = config.objects[0].model->body.mass * kGravity;
    const Vector3 centre = record->object[0].position;
    INFO("E " << youngs_modulus << ": at " << centre.transpose() << ", drift in 1 s "
              << (centre - before).norm() << " m, depth " << deepest << " m, at rest " << at_rest
              << " m, force " << total_force(*record).transpose() << " N of " << weight);
    CHECK((total_force(*record) - Vector3(0, weight, 0)).norm() < 1e-3 * weight);
    CHECK((centre - before).norm() < 1e-5);
    CHECK(deepest < 5e-4);
    CHECK(at_rest < 1e-5);
    CHECK(centre.norm() < 0.2);  // in the hollow, not through its wall of a centimetre
    CHECK(centre.y() < -0.08);
  }
}

TEST_CASE("mesh scenery: a fast cube does not pass through a wall of five millimetres") {
  for (const double speed : {5.0, 60.0}) {
    SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 2e5}, {0.5, 0.5});
    config.gravity.setZero();
    config.objects[0].position = Vector3(0.003, 0.3, -0.002);
    config.objects[0].velocity = Vector3(0, -speed, 0);
    config.scenery[0].shape = shape(voxel_surface({100, 1, 100}, 0.005, everywhere));
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    for (int k = 0; k < 200; ++k) step_alone(simulation, *record);
    CHECK(record->object[0].position.y() > 0.0);
  }
}

TEST_CASE("mesh scenery: the same steps give the same bits, after a reset as well") {
  SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 2e4}, {0.2, 0.15});
  config.scenery[0].shape = bowl(0.2, 0.21, 6, 16);
  config.objects[0].position = Vector3(0.05, -0.03, 0.02);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  std::vector<Vector3> positions;
  for (int k = 0; k < 300; ++k) {
    step_alone(simulation, *record);
    positions.push_back(record->object[0].position);
  }
  simulation.reset();
  for (const Vector3& position : positions) {
    step_alone(simulation, *record);
    REQUIRE(record->object[0].position == position);
  }
}

TEST_CASE("mesh scenery: an object that starts in its wall is refused, one in its hollow is not") {
  SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 2e4}, {0.2, 0.15});
  config.scenery[0].name = "bowl";
  config.scenery[0].shape = bowl(0.2, 0.21, 12, 32);
  config.objects[0].position = Vector3::Zero();
  CHECK_NOTHROW(Simulation(config));
  config.objects[0].position = Vector3(0, -0.15, 0);
  CHECK_THROWS_WITH(Simulation(config),
                    Catch::Matchers::ContainsSubstring("scenery \"bowl\" are inside one another"));
}
