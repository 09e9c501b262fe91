#include <cmath>
#include <limits>

#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/surface.hpp"
#include "tests/precompute/meshes.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

TEST_CASE("sound meshes pass the check") {
  CHECK_NOTHROW(check_mesh(one_tet(), "m"));
  CHECK_NOTHROW(check_mesh(two_tets(), "m"));
}

TEST_CASE("surface of two joined tetrahedra leaves out the common face") {
  const Surface surface = extract_surface(two_tets(), "m");
  CHECK(surface.nodes == std::vector<int>{0, 1, 2, 3, 4});
  CHECK(surface.triangles.rows() == 6);
}

TEST_CASE("surface nodes are numbered without the nodes inside") {
  // A tetrahedron around a middle node, which comes first.
  TetMesh mesh;
  mesh.nodes.resize(5, 3);
  mesh.nodes << 0.2, 0.2, 0.2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.tets.resize(4, 4);
  mesh.tets << 0, 2, 3, 4, 1, 0, 3, 4, 1, 2, 0, 4, 1, 2, 3, 0;
  CHECK_NOTHROW(check_mesh(mesh, "m"));
  const Surface surface = extract_surface(mesh, "m");
  CHECK(surface.nodes == std::vector<int>{1, 2, 3, 4});
  CHECK(surface.triangles.rows() == 4);
  CHECK(surface.triangles.maxCoeff() == 3);
}

TEST_CASE("mesh check names each fault") {
  TetMesh mesh = two_tets();
  SECTION("empty") {
    mesh.tets.resize(0, 4);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("m: there are no tetrahedra"));
  }
  SECTION("not a number") {
    mesh.nodes(2, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("the node at (") &&
                                                 ContainsSubstring("nan") &&
                                                 ContainsSubstring("not finite"));
  }
  SECTION("infinite") {
    mesh.nodes(4, 0) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("the node at (inf, ") && ContainsSubstring("not finite"));
  }
  SECTION("index too large") {
    mesh.tets(1, 2) = 5;
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("tetrahedron 2 uses a node that does not exist"));
  }
  SECTION("negative index") {
    mesh.tets(0, 0) = -1;
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("tetrahedron 1 uses a node that does not exist"));
  }
  SECTION("node twice in an element") {
    mesh.tets(1, 3) = mesh.tets(1, 0);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("a tetrahedron uses the node at (1, 0, 0) twice"));
  }
  SECTION("unused node") {
    mesh.tets.conservativeResize(1, 4);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("the node at (1, 1, 1) belongs to no tetrahedron"));
  }
  SECTION("one inverted") {
    std::swap(mesh.tets(1, 0), mesh.tets(1, 1));
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("1 of 2 tetrahedra are inverted") &&
                                                 ContainsSubstring("around (0.5, 0.5, 0.5)"));
  }
  SECTION("all inverted") {
    mesh.tets.col(0).swap(mesh.tets.col(1));
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("all 2 tetrahedra are inverted") &&
                                                 ContainsSubstring("orders the nodes"));
  }
  SECTION("zero volume") {
    mesh.nodes.row(4) << 0.25, 0.25, 0.5;
    CHECK_THROWS_WITH(
        check_mesh(mesh, "m"),
        ContainsSubstring("the tetrahedron around (0.3125, 0.3125, 0.375) has zero volume"));
  }
  SECTION("disconnected") {
    CHECK_THROWS_WITH(check_mesh(together(one_tet(), one_tet()), "m"),
                      ContainsSubstring("2 pieces"));
  }
  SECTION("joined in one node only") {
    mesh = together(one_tet(), one_tet());
    mesh.nodes.bottomRows(4).rowwise() += Eigen::RowVector3d(0, 0, 1);
    mesh.tets(1, 0) = 3;
    drop_unused_nodes(mesh);
    CHECK(mesh.node_count() == 7);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("2 pieces"));
  }
  SECTION("the same element twice") {
    mesh.tets.row(1) = mesh.tets.row(0);
    drop_unused_nodes(mesh);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("same side of a common face"));
  }
  SECTION("a face of three elements") {
    mesh.tets.conservativeResize(3, 4);
    mesh.tets.row(2) = mesh.tets.row(1);
    CHECK_THROWS_WITH(check_mesh(mesh, "m"), ContainsSubstring("belongs to 3 tetrahedra"));
  }
  SECTION("an edge of four triangles") {
    // Four of the six wedges around the edge 1-2, in two opposite pairs; the fans below all six,
    // with node 9 as their tip, join the pairs.
    mesh.nodes.resize(9, 3);
    mesh.nodes.row(0) << 0, 0, 0;
    mesh.nodes.row(1) << 0, 0, 1;
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::acos(-1.0) / 3.0;
      mesh.nodes.row(2 + k) << std::cos(angle), std::sin(angle), 0.5;
    }
    mesh.nodes.row(8) << 0, 0, -2;
    mesh.tets.resize(10, 4);
    int e = 0;
    for (const int k : {0, 1, 3, 4}) mesh.tets.row(e++) << 0, 2 + k, 2 + (k + 1) % 6, 1;
    for (int k = 0; k < 6; ++k) mesh.tets.row(e++) << 8, 2 + k, 2 + (k + 1) % 6, 0;
    CHECK_THROWS_WITH(check_mesh(mesh, "m"),
                      ContainsSubstring("more than two triangles meet at 1 edge, for instance from "
                                        "(0, 0, 0) to (0, 0, 1)"));
  }
}

TEST_CASE("a flat tetrahedron is named by its place and its mean ratio") {
  CHECK_FALSE(flattest_element(two_tets()).has_value());
  TetMesh flat = two_tets();
  flat.nodes.row(4) << 0.5, 0.5, 1e-6;
  CHECK(flattest_element(flat) ==
        "the tetrahedron around (0.375, 0.375, 0.25) m, which is flat (mean ratio 8.9e-05)");
}
