#include <map>

#include "common/process/temporary_files.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

double enclosed_volume(const Points& nodes, const Triangles& triangles) {
  double volume = 0.0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Vector3 a = nodes.row(triangles(t, 0)).transpose();
    const Vector3 b = nodes.row(triangles(t, 1)).transpose();
    const Vector3 c = nodes.row(triangles(t, 2)).transpose();
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

}  // namespace

TEST_CASE("box surface is a closed regular grid, outward") {
  const SurfaceMesh cube = box_surface(Vector3(0.12, 0.12, 0.12), {12, 12, 12});
  CHECK(cube.nodes.rows() == 866);
  CHECK(cube.triangles.rows() == 1728);
  CHECK(enclosed_volume(cube.nodes, cube.triangles) == Approx(0.12 * 0.12 * 0.12));

  const SurfaceMesh box = box_surface(Vector3(1, 2, 3), {2, 1, 4});
  CHECK(box.triangles.rows() == 2 * 2 * (2 * 1 + 1 * 4 + 4 * 2));
  CHECK(enclosed_volume(box.nodes, box.triangles) == Approx(6.0));
}

TEST_CASE("diagonals of neighbouring cells alternate") {
  // Inside a face every second node then has eight triangles and the others four.
  const SurfaceMesh box = box_surface(Vector3(4, 4, 4), {4, 4, 4});
  std::map<int, int> triangles_of_node;
  for (Eigen::Index i = 0; i < box.triangles.size(); ++i) {
    ++triangles_of_node[box.triangles.data()[i]];
  }
  for (Eigen::Index i = 0; i < box.nodes.rows(); ++i) {
    const auto inner = (box.nodes.row(i).array() > 0 && box.nodes.row(i).array() < 4).count();
    if (inner != 2) continue;
    const int count = triangles_of_node[static_cast<int>(i)];
    CHECK((count == 4 || count == 8));
  }
}

TEST_CASE("TetGen fills a box and keeps its surface as it is") {
  for (const std::array<int, 3>& cells :
       {std::array{1, 1, 1}, std::array{6, 6, 6}, std::array{8, 1, 3}}) {
    const SurfaceMesh surface = box_surface(Vector3(0.12, 0.07, 0.05), cells);
    const TetMesh mesh = tetrahedralise(surface);
    CHECK_NOTHROW(check_mesh(mesh, "box"));
    CHECK(mesh.nodes.topRows(surface.nodes.rows()) == surface.nodes);
    const Surface found = extract_surface(mesh, "box");
    CHECK(found.nodes.size() == static_cast<std::size_t>(surface.nodes.rows()));
    CHECK(found.triangles.rows() == surface.triangles.rows());
    CHECK(enclosed_volume(surface.nodes, found.triangles) == Approx(0.12 * 0.07 * 0.05));
  }
}

TEST_CASE("the paper's cube has the size that the paper gives") {
  const TetMesh mesh = tetrahedralise(box_surface(Vector3(0.12, 0.12, 0.12), {12, 12, 12}));
  CHECK(mesh.tet_count() >= 5300);
  CHECK(mesh.tet_count() <= 5700);
  CHECK(mesh.node_count() - 866 == Approx(490).margin(20));
}

TEST_CASE("a missing, failing or endless mesh program is told by name") {
  const SurfaceMesh surface = box_surface(Vector3(1, 1, 1), {1, 1, 1});
  CHECK_THROWS_WITH(
      tetrahedralise(surface, "no-such-tetgen"),
      ContainsSubstring("no-such-tetgen") && ContainsSubstring("install the package tetgen"));
  CHECK_THROWS_WITH(tetrahedralise(surface, "false"), ContainsSubstring("false: failed"));
  CHECK_THROWS_WITH(tetrahedralise(surface, "true"), ContainsSubstring("no such file"));
  const TemporaryFolder folder("irdm-test");
  const auto script = folder.path() / "endless";
  {
    FILE* file = std::fopen(script.c_str(), "w");
    std::fputs("#!/bin/sh\nexec sleep 100\n", file);
    std::fclose(file);
  }
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  CHECK_THROWS_WITH(tetrahedralise(surface, script.string(), 0.2),
                    ContainsSubstring("is not done after"));
}
