// What the server says of its styluses at the start.
#include <cmath>

#include "common/motion/rigid_body.hpp"
#include "common/response/stored_response.hpp"
#include "common/stability/coupling_limit.hpp"
#include "server/stylus_notes.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/step/default_fingertip.hpp"
#include "tests/server/scene_text.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_model.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr int kCellsAnEdge = 12;
constexpr double kCubeEdge = 0.12;

// A cube of one mode, that moves each node along its normal: by 1, or every other one by `factor`.
std::shared_ptr<const Model> checkered(double factor) {
  Model model = synthetic_cube(kCellsAnEdge, 1, 4, kCubeEdge);
  const RestSurface surface(model.mesh);
  RowMatrix<double> shapes(model.degrees_of_freedom(), 1);
  for (int node = 0; node < surface.node_count(); ++node) {
    const Vector3 cell = (surface.node(node).array() + 0.5 * kCubeEdge) * kCellsAnEdge / kCubeEdge;
    const bool odd = std::lround(cell.sum()) % 2 != 0;
    shapes.col(0).segment<3>(3 * node) =
        (odd ? factor : 1.0) * surface.smooth_normal({{node, node, node}, {1.0, 0.0, 0.0}});
  }
  std::get<ModalResponse>(model.response).shapes = shapes;
  return share(std::move(model));
}

SimulationConfig simulated(const SceneConfig& scene, std::shared_ptr<const Model> model) {
  SimulationConfig config;
  config.objects.emplace_back().model = std::move(model);
  config.styluses = scene.styluses;
  return config;
}

}  // namespace

TEST_CASE(
    "points on a cube that is equally soft everywhere feel no mesh, on a checkered one they do") {
  const double radius = 0.012;
  CHECK(mesh_dependence_of_points(*checkered(1.0), radius) == Approx(1.0).epsilon(1e-9));
  // Four times as soft; only the diagonals lead to a node that is alike.
  CHECK(mesh_dependence_of_points(*checkered(2.0), 3 * radius) == Approx(4.0).epsilon(0.1));
  const Model rigid = made_rigid(synthetic_cube(2, 3, 4));
  CHECK(std::isnan(mesh_dependence_of_points(rigid, radius)));
}

TEST_CASE("the default fingertip is by the smallest object that deforms, and fits on all of them") {
  const auto radius_for = [](const std::vector<Model>& models) {
    SimulationConfig config;
    for (const Model& model : models) config.objects.emplace_back().model = share(model);
    return default_fingertip(config);
  };
  const Model cube = synthetic_cube(12, 1, 4, 0.12);
  const Model small = synthetic_cube(12, 1, 4, 0.08);
  CHECK(radius_for({cube}) == Approx(1.65 * 0.02));
  CHECK(radius_for({cube, small}) == Approx(1.65 * 0.08 / 6));
  CHECK(radius_for({cube, made_rigid(small)}) == Approx(1.65 * 0.02));
  CHECK(radius_for({made_rigid(cube)}) == 0.0);
  // Two edges of a square and its diagonal.
  const double edge = (2.0 + std::sqrt(2.0)) / 3.0;
  CHECK(radius_for({synthetic_cube(2, 1, 4, 0.12)}) == Approx(0.06 * edge));
  CHECK(radius_for({cube, made_rigid(synthetic_cube(12, 1, 4, 0.03))}) ==
        Approx(6.3 * 0.0025 * edge));
}

TEST_CASE("the default ball is two edges wide, but never large beside an object") {
  const auto radius_for = [](double edge, int cells) {
    SimulationConfig config;
    config.objects.emplace_back().model = share(synthetic_cube(cells, 1, 4, edge));
    return default_ball_radius(config);
  };
  const double edge = (2.0 + std::sqrt(2.0)) / 3.0;  // two edges of a square and its diagonal
  CHECK(radius_for(0.12, 12) == Approx(0.1 * 0.12));
  CHECK(radius_for(0.12, 40) == Approx(2.0 * 0.003 * edge));
  CHECK(radius_for(0.06, 60) == Approx(0.003));
  CHECK(radius_for(0.02, 20) == Approx(0.002));
}

TEST_CASE("styluses without a radius are told to have a fingertip") {
  const SceneConfig read = scene("[[stylus]]\nradius = 0.004\n[[stylus]]\n" + kObject);
  SimulationConfig config = simulated(read, share(synthetic_cube(12, 1, 4, 0.12)));
  config.styluses[1].radius = 0.033;
  CHECK(default_radius_note(read, config, false) ==
        "stylus 2: fingertip of radius 33 mm by default, from the objects' size; `radius` sets "
        "another");
  CHECK(default_radius_note(scene("[[stylus]]\nradius = 0.004\n" + kObject), config, true) == "");
  config.styluses.push_back({.radius = 0.012, .ball = true});
  CHECK(default_radius_note(read, config, false).find("ball") == std::string::npos);
  config.styluses[1] = config.styluses.back();
  CHECK(default_radius_note(read, config, false) ==
        "stylus 2: ball of radius 12 mm by default, from the objects' mesh and size; `radius` sets "
        "another");
  CHECK(point_warning(read, config, false) == "");
  CHECK(list_of_styluses({0, 2, 3}, 3) == "styluses 1, 3 and the viewers' stylus");
  CHECK(list_of_styluses({3}, 3) == "the viewers' stylus");
}

TEST_CASE("of points it is told by how much they feel the mesh") {
  const SceneConfig read = scene("[[stylus]]\nradius = 0\n" + kObject);
  const SimulationConfig config = simulated(read, checkered(2.0));
  CHECK_THAT(point_warning(read, config, false),
             ContainsSubstring("stylus 1 is a point (radius = 0)") &&
                 ContainsSubstring("neighbouring nodes differ by a factor of 3.9,") &&
                 ContainsSubstring("leave `radius` out for a fingertip of 33 mm"));
  Model unknown = synthetic_cube(12, 1, 4);
  unknown.response = std::monostate{};
  CHECK_THAT(point_warning(read, simulated(read, share(std::move(unknown))), false),
             ContainsSubstring("depends on the mesh: half the edge length is up to twice as soft"));
  CHECK(point_warning(read, simulated(read, share(made_rigid(synthetic_cube(2, 1, 4)))), false) ==
        "");
}

TEST_CASE("a coupling that a loop over a link does not bear is warned of, with what it bears") {
  Model stiff = synthetic_cube(2, 12, 400);
  std::get<RowMatrix<double>>(std::get<ModalResponse>(stiff.response).shapes) *= 0.3;
  const double limit = sampled_coupling(stiff, stiff.mesh.surface_node_count());
  REQUIRE(limit < kStiffestCoupling);
  REQUIRE(limit > kSoftestCoupling);
  CHECK(sampled_coupling(stiff, 4) >= limit);
  // At one node it is what is found of its record.
  const HandLoop loop{{}, stiff.dt, loop_delay(stiff.dt, stiff.dt)};
  const RecordLength length = record_length(std::get<ModalResponse>(stiff.response), stiff.dt);
  const Vector3 x = stiff.mesh.rest_position(0);
  CHECK(sampled_coupling(stiff, 1) ==
        largest_coupling(stored_response(stiff)->driving_points(0, 1, length.steps).front(),
                         RigidBody(stiff.body, stiff.dt).mobility().between(x, x), loop,
                         length.radius * std::exp(-kSlowestGrowth * stiff.dt)));

  const SceneConfig read = scene("[contact]\ncoupling_stiffness = 1e6\n" + kObject);
  CHECK_THAT(coupling_warning(read, simulated(read, share(Model(stiff)))),
             ContainsSubstring("coupling_stiffness 1e+06 N/m is too stiff for object 'object'") &&
                 ContainsSubstring("irdm-precompute check"));
  const SceneConfig soft = scene("[contact]\ncoupling_stiffness = 1\n" + kObject);
  CHECK(coupling_warning(soft, simulated(soft, share(Model(stiff)))) == "");
  CHECK(coupling_warning(read, simulated(read, share(made_rigid(stiff)))) == "");
}
