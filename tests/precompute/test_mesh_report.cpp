#include <cmath>

#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

TEST_CASE("mean ratio is one for a regular tetrahedron of any size and falls as it flattens") {
  TetMesh mesh = test::one_tet();
  mesh.nodes << 1, 1, 1, -1, 1, -1, 1, -1, -1, -1, -1, 1;
  REQUIRE(signed_volume(mesh, 0) > 0.0);
  CHECK(mean_ratio(mesh, 0) == Approx(1.0));
  mesh.nodes *= 1e-3;
  CHECK(mean_ratio(mesh, 0) == Approx(1.0));
  double last = 1.0;
  for (const double height : {0.5, 0.1, 0.01}) {
    TetMesh flat = mesh;
    flat.nodes.col(2) *= height;
    CHECK(mean_ratio(flat, 0) < last);
    last = mean_ratio(flat, 0);
  }
  CHECK(last < 0.1);
  // Corner of a cube with edge 1: V = 1/6, edges 1, 1, 1, sqrt 2, sqrt 2, sqrt 2.
  CHECK(mean_ratio(test::one_tet(), 0) == Approx(12.0 * std::pow(0.5, 2.0 / 3.0) / 9.0));
}

TEST_CASE("mesh report has the bounding box and the worst and median quality, for either order") {
  TetMesh mesh = test::box_mesh(Vector3(0.12, 0.1, 0.08), {3, 2, 2});
  mesh.nodes.rowwise() += Eigen::RowVector3d(5, -3, 1);
  const MeshReport report = report_mesh(mesh);
  CHECK((report.extent - Vector3(0.12, 0.1, 0.08)).norm() < 1e-12);
  CHECK(report.worst_quality > 0.0);
  CHECK(report.worst_quality < report.median_quality);
  CHECK(report.median_quality < 1.0);
  CHECK(report_mesh(quadratic_mesh(mesh)).median_quality == report.median_quality);
}

TEST_CASE("sizes that no hand-held object has are met with a hint about the unit") {
  CHECK(!unit_hint(Vector3(0.12, 0.12, 0.12)));
  CHECK(!unit_hint(Vector3(10.0, 1e-5, 1e-5)));
  CHECK_THAT(*unit_hint(Vector3(120, 80, 60)),
             ContainsSubstring("120 x 80 x 60 m") && ContainsSubstring("mesh.unit = \"mm\""));
  CHECK_THAT(*unit_hint(Vector3(1e-5, 8e-5, 6e-5)),
             ContainsSubstring("8e-05") && ContainsSubstring("mesh.unit"));
}
