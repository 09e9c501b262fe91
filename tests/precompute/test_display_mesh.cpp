// The surface that is drawn: where it lies, how it is shaded, and that it moves with the one that
// computes.
#include <cmath>
#include <map>

#include "common/model/model_file.hpp"
#include "common/surface/surface_tree.hpp"
#include "precompute/display/corner_normals.hpp"
#include "precompute/display/make_display_mesh.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/round_mesh.hpp"
#include "precompute/mesh/shaded_surface.hpp"
#include "tests/precompute/mesh_files.hpp"
#include "tests/precompute/program_run.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

ModelMesh computed(const SurfaceMesh& surface) {
  ModelMesh mesh;
  mesh.nodes = surface.nodes;
  mesh.triangles = surface.triangles;
  for (int i = 0; i < static_cast<int>(surface.nodes.rows()); ++i) mesh.surface_nodes.push_back(i);
  return mesh;
}

DisplayConfig parts(int count) {
  DisplayConfig config;
  config.subdivision = count;
  config.crease_angle = 35 * kDegree;
  return config;
}

DisplayConfig config_of(const std::filesystem::path& file) {
  DisplayConfig config;
  config.file = file;
  config.crease_angle = 35 * kDegree;
  return config;
}

Vector3 position(const DisplayMesh& display, Eigen::Index v) {
  return display.positions.row(v).cast<double>().transpose();
}

// How far vertices of a ball's display mesh are off the ball, at most.
double off_the_ball(const DisplayMesh& display) {
  double most = 0.0;
  for (Eigen::Index v = 0; v < display.positions.rows(); ++v) {
    most = std::max(most, std::abs(position(display, v).norm() - 1.0));
  }
  return most;
}

double volume_of(const DisplayMesh& display) {
  double sum = 0.0;
  for (Eigen::Index t = 0; t < display.triangles.rows(); ++t) {
    const auto corner = [&](int i) { return position(display, display.triangles(t, i)); };
    sum += corner(0).dot(corner(1).cross(corner(2))) / 6.0;
  }
  return sum;
}

// Whether every edge has two triangles, places counted once.
bool is_closed(const DisplayMesh& display) {
  const auto place = [&](int v) {
    std::array<long, 3> key{};
    for (int i = 0; i < 3; ++i) {
      key[static_cast<std::size_t>(i)] = std::lround(1e5F * display.positions(v, i));
    }
    return key;
  };
  std::map<std::pair<std::array<long, 3>, std::array<long, 3>>, int> edges;
  for (Eigen::Index t = 0; t < display.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto from = place(display.triangles(t, i));
      const auto to = place(display.triangles(t, (i + 1) % 3));
      edges[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
}

// Displacements that are linear in place come to a vertex as they are where it is bound.
void check_linear(const DisplayMesh& display, const ModelMesh& mesh) {
  const SurfaceTree tree(mesh);
  Matrix3 gradient;
  gradient << 0.1, -0.2, 0.3, 0.05, 0.4, -0.1, 0.2, 0.1, -0.3;
  for (Eigen::Index v = 0; v < display.positions.rows(); ++v) {
    Vector3 moved = Vector3::Zero(), bound = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      const Vector3 node = mesh.rest_position(display.nodes(v, i));
      moved += static_cast<double>(display.weights(v, i)) * (gradient * node);
      bound += static_cast<double>(display.weights(v, i)) * node;
    }
    REQUIRE((moved - gradient * bound).norm() < 1e-6);
    const int nearest = tree.closest_triangle(position(display, v));
    TriangleCorners corners;
    for (int i = 0; i < 3; ++i) {
      corners[static_cast<std::size_t>(i)] = mesh.rest_position(mesh.triangles(nearest, i));
    }
    const Vector3 closest = at(corners, closest_point(corners, position(display, v)));
    // Parts of a curved triangle are bound to where they were cut, which is close to the nearest.
    REQUIRE((bound - position(display, v)).norm() <
            1.05 * (closest - position(display, v)).norm() + 1e-5);
  }
}

// A ball as .obj with normals and, about its axis, texture coordinates with a seam.
std::string ball_obj(int cells, bool inward = false) {
  const SurfaceMesh ball = sphere_surface(cells);
  std::ostringstream text;
  text << std::setprecision(9);
  for (const char* keyword : {"v", "vn"}) {
    for (Eigen::Index i = 0; i < ball.nodes.rows(); ++i) {
      text << keyword << ' ' << ball.nodes(i, 0) << ' ' << ball.nodes(i, 1) << ' '
           << ball.nodes(i, 2) << '\n';
    }
  }
  text << "vt 0 0\nvt 1 0\nvt 0.5 1\n";
  for (Eigen::Index t = 0; t < ball.triangles.rows(); ++t) {
    text << 'f';
    for (const int i : inward ? std::array{2, 1, 0} : std::array{0, 1, 2}) {
      const int node = ball.triangles(t, i) + 1;
      text << ' ' << node << '/' << i + 1 << '/' << node;
    }
    text << '\n';
  }
  return text.str();
}

const std::string kPng("\x89PNG\r\n\x1a\n and more", 17);

}  // namespace

TEST_CASE("display: a subdivided ball is rounder by far than the one that computes") {
  const ModelMesh mesh = computed(sphere_surface(4));
  // The middle of a facet's edge lies this far inside.
  double sagitta = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Vector3 a = mesh.rest_position(mesh.triangles(t, 0));
    const Vector3 b = mesh.rest_position(mesh.triangles(t, 1));
    sagitta = std::max(sagitta, 1.0 - (0.5 * (a + b)).norm());
  }
  const DisplayMesh display = make_display_mesh(parts(5), mesh);
  CHECK(display.triangles.rows() == 25 * mesh.triangles.rows());
  CHECK(off_the_ball(display) < 0.1 * sagitta);
  CHECK(is_closed(display));
  for (Eigen::Index v = 0; v < display.positions.rows(); ++v) {
    REQUIRE(
        position(display, v).normalized().dot(display.normals.row(v).cast<double>().transpose()) >
        std::cos(3 * kDegree));
  }
  check_linear(display, mesh);
  // A curve of third order through corners and tangents: its error falls with the fourth power.
  const double finer = off_the_ball(make_display_mesh(parts(5), computed(sphere_surface(8))));
  CHECK(finer < off_the_ball(display) / 8.0);
}

TEST_CASE("display: a subdivided box stays a box, with its own normal on each side of an edge") {
  SurfaceMesh box = box_surface({2, 3, 4}, {2, 3, 3});
  box.nodes.rowwise() -= Eigen::RowVector3d(1, 1.5, 2);
  const ModelMesh mesh = computed(box);
  const DisplayMesh display = make_display_mesh(parts(3), mesh);
  CHECK(volume_of(display) == Approx(24.0).epsilon(1e-6));
  CHECK(is_closed(display));
  CHECK((display.normals.cwiseAbs().rowwise().maxCoeff().array() - 1.0F).abs().maxCoeff() < 1e-6F);
  check_linear(display, mesh);
  SECTION("unless its edges are to be smooth") {
    DisplayConfig config = parts(3);
    config.crease_angle = 100 * kDegree;
    const DisplayMesh smooth = make_display_mesh(config, mesh);
    CHECK(smooth.positions.rows() < display.positions.rows());
    CHECK(volume_of(smooth) > 0.9 * 24.0);
    CHECK(is_closed(smooth));
  }
}

TEST_CASE("display: a crease is a line without an end") {
  // A roof whose ridge, from one side of the sheet on, becomes flat in its middle.
  constexpr int kCells = 8;
  SurfaceMesh sheet;
  sheet.nodes.resize((kCells + 1) * (kCells + 1), 3);
  sheet.triangles.resize(2 * kCells * kCells, 3);
  const auto node = [](int x, int y) { return x * (kCells + 1) + y; };
  for (int x = 0; x <= kCells; ++x) {
    for (int y = 0; y <= kCells; ++y) {
      const double slope = std::max(0.0, 1.0 - x / 5.0);
      sheet.nodes.row(node(x, y)) << x, y, -slope * std::abs(y - kCells / 2);
    }
  }
  for (int x = 0, t = 0; x < kCells; ++x) {
    for (int y = 0; y < kCells; ++y) {
      sheet.triangles.row(t++) << node(x, y), node(x + 1, y), node(x + 1, y + 1);
      sheet.triangles.row(t++) << node(x, y), node(x + 1, y + 1), node(x, y + 1);
    }
  }
  // What stays sharp is the bound of the sheet.
  CHECK(smooth_shading(sheet, 35 * kDegree).creases.size() == 4 * kCells);
  // With a ridge that goes on to the other side it is a line from bound to bound.
  for (Eigen::Index i = 0; i < sheet.nodes.rows(); ++i) {
    sheet.nodes(i, 2) = -std::abs(sheet.nodes(i, 1) - kCells / 2);
  }
  CHECK(smooth_shading(sheet, 35 * kDegree).creases.size() == 5 * kCells);
}

TEST_CASE(
    "display: a file's normals and texture coordinates are kept, and it follows the surface") {
  const MeshFiles files;
  const ModelMesh mesh = computed(sphere_surface(3));
  DisplayConfig config = config_of(files.write("ball.obj", ball_obj(8)));
  config.texture = files.write("ball.png", kPng);
  const DisplayMesh display = make_display_mesh(config, mesh);
  CHECK(display.triangles.rows() == sphere_surface(8).triangles.rows());
  CHECK(off_the_ball(display) < 1e-6);
  CHECK(display.texture == std::vector<std::uint8_t>(kPng.begin(), kPng.end()));
  CHECK((display.positions - display.normals).cwiseAbs().maxCoeff() < 1e-5F);
  for (Eigen::Index t = 0; t < display.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto place = display.texture_coordinates.row(display.triangles(t, i));
      REQUIRE(place(0) == Approx(i == 0 ? 0.0 : i == 1 ? 1.0 : 0.5));
    }
  }
  check_linear(display, mesh);
}

TEST_CASE("display: a file in its own unit and about the mesh's own place, turned inside out") {
  const MeshFiles files;
  DisplayConfig config = config_of(files.write("ball.obj", ball_obj(6, true)));
  config.unit = 0.01;
  SurfaceMesh small = sphere_surface(3);
  small.nodes *= 0.01;
  ModelMesh mesh = computed(small);
  mesh.com_offset = Vector3(0.001, 0.0, 0.0);
  const DisplayMesh display = make_display_mesh(config, mesh);
  CHECK(volume_of(display) > 0.0);
  double nearest = 1.0;  // to the place of a node of the file
  const Vector3 place = 0.01 * sphere_surface(6).nodes.row(7).transpose() - mesh.com_offset;
  for (Eigen::Index v = 0; v < display.positions.rows(); ++v) {
    nearest = std::min(nearest, (position(display, v) - place).norm());
  }
  CHECK(nearest < 1e-8);
}

TEST_CASE("display: a vertex beside a thin wall is bound to the side that it faces like") {
  SurfaceMesh plate = box_surface({1, 1, 0.02}, {4, 4, 1});
  const ModelMesh mesh = computed(plate);
  const MeshFiles files;
  // A sheet that faces up and lies nearer to the lower side.
  const DisplayMesh display =
      make_display_mesh(config_of(files.write("sheet.obj",
                                              "v 0.2 0.2 0.004\nv 0.8 0.2 0.004\nv 0.8 0.8 0.004\n"
                                              "vn 0 0 1\nf 1//1 2//1 3//1\n")),
                        mesh);
  for (Eigen::Index v = 0; v < 3; ++v) {
    for (int i = 0; i < 3; ++i) CHECK(mesh.rest_position(display.nodes(v, i)).z() == 0.02);
  }
}

TEST_CASE("display: what cannot be one is refused with what to do") {
  const MeshFiles files;
  const ModelMesh mesh = computed(sphere_surface(3));
  const auto refused = [&](const DisplayConfig& config, const std::string& what) {
    CHECK_THROWS_WITH(make_display_mesh(config, mesh), ContainsSubstring(what));
  };
  DisplayConfig ball = config_of(files.write("ball.obj", ball_obj(4)));
  ball.texture = files.write("ball.gif", "GIF89a");
  refused(ball, "ball.gif: is no PNG or JPEG file");
  ball.texture = files.path() / "missing.png";
  refused(ball, "missing.png");
  ball.texture.reset();
  ball.unit = 0.001;
  refused(ball, "off the mesh, which is");
  DisplayConfig bare = config_of(files.write("bare.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n"));
  bare.texture = files.write("ball.png", kPng);
  refused(bare, "not every corner of display.file has texture coordinates");
  refused(config_of(files.write("empty.obj", "v 1 0 0\n")), "has no triangles");
  refused(
      config_of(files.write("odd.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//2\n")),
      "normal '2' of a face does not exist");
  const ModelMesh fine = computed(sphere_surface(40));
  CHECK_THROWS_WITH(make_display_mesh(parts(8), fine), ContainsSubstring("set it to"));
}

TEST_CASE("display: the model file has it, compress keeps it, and damage is refused", "[slow]") {
  ProgramRun run;
  run.write("c.toml", kBox + kProgramMaterial + "[response]\nstorage = \"both\"\nsteps = 300\n" +
                          "[display]\nsubdivision = 3\n");
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("display mesh: ") &&
                          ContainsSubstring("at most 0 mm off the surface"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  REQUIRE_FALSE(model.display.empty());
  run.start("compress made/model.h5 -o made/small.h5");
  REQUIRE(run.status == 0);
  const Model small = read_model(run.path() / "made/small.h5", ResponseKind::kCompressed);
  CHECK(small.display.positions == model.display.positions);
  CHECK(small.display.weights == model.display.weights);
  CHECK(small.display.triangles == model.display.triangles);
}

TEST_CASE("display: keys that do not belong are refused") {
  const auto refused = [](const std::string& text, const std::string& what) {
    CHECK_THROWS_WITH(read_display_config(TomlTable::parse_text(text, "c.toml"), 1.0),
                      ContainsSubstring(what));
  };
  refused("", "has not exactly one of file and subdivision");
  refused("file = \"a.obj\"\nsubdivision = 3", "has not exactly one of file and subdivision");
  refused("subdivision = 1", "subdivision");
  refused("subdivision = 3\nunit = \"mm\"", "belongs to a file");
  refused("subdivision = 3\ntexture = \"a.png\"", "belongs to a file");
  refused("file = \"a.msh\"", "is no .obj, .stl or .ply");
  refused("file = \"a.stl\"\nunit = \"ft\"", "unit");
  refused("file = \"a.stl\"\ncrease_angle = 200", "crease_angle");
  refused("subdivision = 3\ncolour = 1", "colour");
  CHECK(read_display_config(TomlTable::parse_text("file = \"a.stl\"", "c.toml"), 0.01).unit ==
        0.01);
}
