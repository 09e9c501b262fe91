#include <cmath>
#include <functional>

#include "precompute/mesh/surface.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "viewer/scene_regions.hpp"

using namespace irdm;
using namespace irdm::viewer;
using precompute::TetMesh;

namespace {

constexpr float kSoft = 3000.0F;
constexpr float kStiff = 42500.0F;

/// The unit cube in that many cells an edge, each of six tetrahedra about a diagonal.
TetMesh grid_mesh(int cells) {
  const int nodes = cells + 1;
  TetMesh mesh;
  mesh.nodes.resize(nodes * nodes * nodes, 3);
  const auto node = [&](const std::array<int, 3>& at) {
    return (at[0] * nodes + at[1]) * nodes + at[2];
  };
  for (int i = 0; i < mesh.nodes.rows(); ++i) {
    mesh.nodes.row(i) << i / (nodes * nodes), i / nodes % nodes, i % nodes;
  }
  mesh.nodes /= cells;
  mesh.tets.resize(6 * cells * cells * cells, 4);
  const std::array<std::array<std::size_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int t = 0; t < mesh.tets.rows(); ++t) {
    const int cell = t / 6;
    std::array<int, 3> at{cell / (cells * cells), cell / cells % cells, cell % cells};
    std::array<int, 4> corner{node(at)};
    for (std::size_t step = 0; step < 3; ++step) {
      ++at[orders[static_cast<std::size_t>(t % 6)][step]];
      corner[step + 1] = node(at);
    }
    if (t % 6 >= 3) std::swap(corner[2], corner[3]);
    for (int c = 0; c < 4; ++c) mesh.tets(t, c) = corner[static_cast<std::size_t>(c)];
  }
  return mesh;
}

struct Element {
  int region = 0;
  double modulus = 0.0;  ///< [Pa]
};
/// @param at centroid
using Made = std::function<Element(const Vector3& at)>;

/// A body of that mesh; its response does not matter.
Model model_of(const TetMesh& mesh, const Made& made) {
  Model model = test::synthetic_cube(1, 1, 1);
  const precompute::Surface surface = precompute::extract_surface(mesh, "grid");
  model.mesh.nodes = mesh.nodes;
  model.mesh.tets = mesh.tets;
  model.mesh.surface_nodes = surface.nodes;
  model.mesh.triangles = surface.triangles;
  ElementMaterials& elements = model.material.elements;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    Vector3 centroid = Vector3::Zero();
    for (int c = 0; c < 4; ++c) centroid += 0.25 * mesh.nodes.row(mesh.tets(e, c)).transpose();
    const Element element = made(centroid);
    elements.region.push_back(element.region);
    elements.youngs_modulus.push_back(element.modulus);
    elements.poisson_ratio.push_back(element.region == 0 ? 0.45 : 0.3);
    elements.density.push_back(element.region == 0 ? 1000.0 : 1100.0);
  }
  return model;
}

/// Half a cell of four off the middle in each direction.
bool in_the_middle(const Vector3& at) {
  return (at - Vector3::Constant(0.5)).cwiseAbs().maxCoeff() < 0.25;
}

Element inclusion(const Vector3& at) {
  return in_the_middle(at) ? Element{1, kStiff} : Element{0, kSoft};
}

/// Positive if the faces are outward; of what they enclose if they are closed.
double enclosed_volume(const SceneRegions& regions) {
  double volume = 0.0;
  for (Eigen::Index f = 0; f < regions.faces.rows(); ++f) {
    const Vector3 a = regions.nodes.row(regions.faces(f, 0)).transpose();
    const Vector3 b = regions.nodes.row(regions.faces(f, 1)).transpose();
    const Vector3 c = regions.nodes.row(regions.faces(f, 2)).transpose();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

}  // namespace

TEST_CASE("a body of one material has no regions, nor a rigid one") {
  Model model = model_of(grid_mesh(2), inclusion);
  CHECK_FALSE(scene_regions(model).empty());
  CHECK(scene_regions(test::made_rigid(model)).empty());
  model.material.elements = {};
  CHECK(scene_regions(model).empty());
}

TEST_CASE("an inclusion is shown by the faces around it, outward") {
  TetMesh mesh = grid_mesh(4);
  SECTION("of linear tetrahedra") {}
  SECTION("of quadratic ones") {
    mesh = precompute::quadratic_mesh(mesh);
  }
  const Model model = model_of(mesh, inclusion);
  const SceneRegions regions = scene_regions(model);
  REQUIRE(regions.regions.size() == 2);
  CHECK(regions.regions[0].number == 0);
  CHECK(regions.regions[1].number == 1);
  CHECK(regions.regions[1].youngs_modulus.lowest == kStiff);
  CHECK(regions.regions[1].youngs_modulus.highest == kStiff);
  CHECK(regions.regions[1].poisson_ratio.lowest == 0.3F);
  CHECK(regions.regions[0].density.highest == 1000.0F);
  CHECK_FALSE(regions.some_unlisted);
  CHECK_FALSE(regions.faces_left_out);
  CHECK(regions.nodes.rows() == 26);
  REQUIRE(regions.faces.rows() == 48);
  CHECK(enclosed_volume(regions) == Approx(0.125));
  CHECK(regions.face_modulus == std::vector<float>(48, kStiff));
  CHECK(regions.surface_modulus ==
        std::vector<float>(static_cast<std::size_t>(model.mesh.triangles.rows()), kSoft));
}

TEST_CASE("each triangle of the surface has the modulus of the tetrahedron behind it") {
  TetMesh mesh = grid_mesh(2);
  SECTION("of linear tetrahedra") {}
  SECTION("of quadratic ones") {
    mesh = precompute::quadratic_mesh(mesh);
  }
  const auto half = [](const Vector3& at) {
    return at.x() > 0.5 ? Element{1, kStiff} : Element{0, kSoft};
  };
  const Model model = model_of(mesh, half);
  const SceneRegions regions = scene_regions(model);
  REQUIRE(regions.surface_modulus.size() == static_cast<std::size_t>(model.mesh.triangles.rows()));
  for (Eigen::Index t = 0; t < model.mesh.triangles.rows(); ++t) {
    double x = 0.0;
    for (int c = 0; c < 3; ++c) x += model.mesh.rest_position(model.mesh.triangles(t, c)).x() / 3;
    CHECK(regions.surface_modulus[static_cast<std::size_t>(t)] == (x > 0.5 ? kStiff : kSoft));
  }
  CHECK(regions.faces.rows() == 8);
}

TEST_CASE("a face between regions is the later one's, even if that is softer") {
  const auto layers = [](const Vector3& at) {
    return at.x() > 0.5 ? Element{2, kSoft} : Element{1, kStiff};
  };
  const SceneRegions regions = scene_regions(model_of(grid_mesh(2), layers));
  CHECK(regions.face_modulus == std::vector<float>(8, kSoft));
}

TEST_CASE("within a region a face is shown where one side is more than twice as stiff") {
  const double stiffer = GENERATE(2.0, 2.1);
  const auto values = [&](const Vector3& at) {
    return Element{1, in_the_middle(at) ? stiffer * 1000.0 : 1000.0};
  };
  const SceneRegions regions = scene_regions(model_of(grid_mesh(4), values));
  REQUIRE(regions.regions.size() == 1);
  CHECK(regions.regions[0].youngs_modulus.lowest == 1000.0F);
  CHECK(regions.regions[0].youngs_modulus.highest == static_cast<float>(1000.0 * stiffer));
  CHECK(regions.faces.rows() == (stiffer > 2.0 ? 48 : 0));
  if (stiffer > 2.0) CHECK(enclosed_volume(regions) == Approx(0.125));
}

TEST_CASE("too many regions are listed in part, too many faces left out") {
  int next = 0;
  const auto each_its_own = [&](const Vector3&) { return Element{next++, kSoft}; };
  const SceneRegions regions = scene_regions(model_of(grid_mesh(13), each_its_own));
  CHECK(regions.regions.size() == kMaxRegions);
  CHECK(regions.regions.back().number == kMaxRegions - 1);
  CHECK(regions.some_unlisted);
  CHECK(regions.faces_left_out);
  CHECK(regions.faces.rows() == 0);
  CHECK(regions.nodes.rows() == 0);
  CHECK(regions.face_modulus.empty());
  CHECK(regions.surface_modulus.size() == 13 * 13 * 6 * 2);
}

TEST_CASE("a triangle that no tetrahedron has is of unknown modulus") {
  Model model = test::synthetic_cube(2, 1, 1);
  model.material.elements = {{2000.0}, {0.45}, {1000.0}, {1}};
  const SceneRegions regions = scene_regions(model);
  CHECK(regions.faces.rows() == 0);
  CHECK(std::isnan(regions.surface_modulus.front()));
}
