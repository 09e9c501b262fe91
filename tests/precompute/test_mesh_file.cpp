#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/region.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "tests/precompute/mesh_files.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::content;
using irdm::test::replaced;
using irdm::test::volume;

namespace {

struct MeshFolder : test::MeshFiles {
  // A unit cube, and a point that belongs to nothing, by the gmsh program.
  std::filesystem::path gmsh(const std::string& options) const {
    write("cube.geo",
          "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\nPoint(100) = {5, 5, 5};\n"
          "Mesh.MeshSizeMax = 0.4;\nMesh.SaveAll = 1;\n");
    run("gmsh -3 cube.geo -o cube.msh " + options);
    return path() / "cube.msh";
  }
};

const std::string kMsh22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
    "$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";
const std::string kMsh41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n"
    "0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";

}  // namespace

TEST_CASE("real Gmsh files of both versions give the same sound mesh") {
  const MeshFolder files;
  TetMesh v2 = read_mesh_file(files.gmsh("-format msh22"));
  TetMesh v4 = read_mesh_file(files.gmsh("-format msh41"));
  CHECK(v2.nodes == v4.nodes);
  CHECK(v2.tets == v4.tets);
  CHECK(drop_unused_nodes(v4) == 1);
  CHECK_NOTHROW(check_mesh(v4, "cube.msh"));
  CHECK(volume(v4) == Approx(1.0));
}

TEST_CASE("Gmsh files with parametric coordinates are read") {
  const MeshFolder files;
  TetMesh mesh = read_mesh_file(files.gmsh("-format msh41 -parametric"));
  CHECK(content(files.path() / "cube.msh").find("\n2 1 1 ") != std::string::npos);
  drop_unused_nodes(mesh);
  CHECK_NOTHROW(check_mesh(mesh, "cube.msh"));
  CHECK(volume(mesh) == Approx(1.0));
}

TEST_CASE("physical groups of real Gmsh files become groups of the mesh") {
  const MeshFolder files;
  files.write("cube.geo",
              "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
              "Mesh.MeshSizeMax = 0.4;\nbase() = Surface In BoundingBox{-1, -1, -0.1, 2, 2, 0.1};\n"
              "Physical Surface(\"the base\") = {base()};\nPhysical Volume(7) = {1};\n");
  for (const std::string format : {"msh22", "msh41"}) {
    files.run("gmsh -3 cube.geo -o cube.msh -format " + format);
    const TetMesh mesh = read_mesh_file(files.path() / "cube.msh");
    REQUIRE(mesh.groups.size() == 2);
    CHECK(mesh.groups.at("7").size() == static_cast<std::size_t>(mesh.tet_count()));
    const std::vector<int> base = nodes_in(mesh, GroupRegion{"the base"}, "m");
    CHECK(base == nodes_in(mesh, HalfSpace{}, "m"));
    CHECK(base.size() > 8);
    const TetMesh quadratic = quadratic_mesh(mesh);
    const std::vector<int> more = nodes_in(quadratic, GroupRegion{"the base"}, "m");
    CHECK(more == nodes_in(quadratic, HalfSpace{}, "m"));
    CHECK(more.size() > 3 * base.size());
    CHECK_THROWS_WITH(nodes_in(mesh, GroupRegion{"top"}, "m"),
                      ContainsSubstring("no group 'top'") && ContainsSubstring("'7', 'the base'"));
  }
}

TEST_CASE("Gmsh files that cannot be used are refused with the way out") {
  const MeshFolder files;
  CHECK_THROWS_WITH(read_mesh_file(files.gmsh("-format msh41 -bin")),
                    ContainsSubstring("binary MSH files are not read"));
  CHECK_THROWS_WITH(read_mesh_file(files.gmsh("-format msh22 -bin")),
                    ContainsSubstring("binary MSH files are not read"));
  CHECK_THROWS_WITH(read_mesh_file(files.gmsh("-format msh40")),
                    ContainsSubstring("MSH version 4 ") && ContainsSubstring("msh41"));
}

TEST_CASE("a real Gmsh file that is cut off anywhere is refused") {
  const MeshFolder files;
  for (const char* format : {"-format msh22", "-format msh41"}) {
    const std::string whole = content(files.gmsh(format));
    for (const double share : {0.1, 0.5, 0.99}) {
      const auto path = files.write(
          "cut.msh", whole.substr(0, static_cast<std::size_t>(share * double(whole.size()))));
      CHECK_THROWS_WITH(read_mesh_file(path), ContainsSubstring("cut.msh:"));
    }
  }
}

TEST_CASE("damaged Gmsh files are refused with file, line and fault") {
  const MeshFolder files;
  const auto refuse = [&](const std::string& text, const std::string& message) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read_mesh_file(files.write("m.msh", text)), ContainsSubstring(message));
  };
  CHECK_NOTHROW(read_mesh_file(files.write("m.msh", kMsh22)));
  CHECK_NOTHROW(read_mesh_file(files.write("m.msh", kMsh41)));
  refuse("", "m.msh: is empty");
  refuse("hello", "is not a Gmsh file");
  for (const std::string& text : {kMsh22, kMsh41}) {
    refuse(replaced(text, "1 0 0\n", "1 zero 0\n"), "'zero' is not a number");
    refuse(replaced(text, "1 2 3 4\n$EndE", "1 2 3 9\n$EndE"), "node 9 does not exist");
    refuse(replaced(text, "1 2 3 4\n$EndE", "1 2 3 x\n$EndE"), "'x' is not a whole number");
    refuse(replaced(text, "$EndElements", "$EndNodes"), "stands where $EndElements should");
    refuse(text.substr(0, text.find("$Elements")), "has no $Nodes or no $Elements");
    refuse(text.substr(0, text.find("$EndE") - 4), "the file ends too early");
  }
  refuse(replaced(kMsh22, "4\n1 0 0 0", "-4\n1 0 0 0"), "number of nodes is -4");
  refuse(replaced(kMsh22, "2 1 0 0", "1 1 0 0"), "node 1 is there twice");
  refuse(replaced(kMsh22, "1 4 2 0 1", "1 5 2 0 1"), "hexahedron");
  refuse(replaced(kMsh22, "1 4 2 0 1", "1 77 2 0 1"), "element type 77");
  CHECK_THROWS_WITH(
      check_mesh(read_mesh_file(files.write("m.msh", replaced(kMsh41, "1 0 0\n", "1 nan 0\n"))),
                 "m.msh"),
      ContainsSubstring("not finite"));
}

TEST_CASE("real TetGen files are read, whichever of the two is named") {
  const MeshFolder files;
  files.write("box.poly",
              "8 3 0 0\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
              "6 0\n1\n4 1 2 3 4\n1\n4 5 6 7 8\n1\n4 1 2 6 5\n1\n4 2 3 7 6\n1\n4 3 4 8 7\n1\n"
              "4 4 1 5 8\n0\n0\n");
  for (const std::string flags : {"-pq1.2a0.02", "-zpq1.2a0.02"}) {  // numbered from 1, from 0
    files.run("tetgen " + flags + " box.poly");
    const TetMesh mesh = read_mesh_file(files.path() / "box.1.node");
    CHECK(mesh.tets == read_mesh_file(files.path() / "box.1.ele").tets);
    CHECK_NOTHROW(check_mesh(mesh, "box"));
    CHECK(mesh.tet_count() > 50);
    CHECK(volume(mesh) == Approx(1.0));
  }
  files.run("tetgen -po2 box.poly");
  CHECK_THROWS_WITH(read_mesh_file(files.path() / "box.1.ele"), ContainsSubstring("second order"));
}

TEST_CASE("damaged TetGen files are refused with file, line and fault") {
  const MeshFolder files;
  const std::string node = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
  const std::string ele = "1 4 0\n1 1 2 3 4\n# comment\n";
  const auto refuse = [&](const std::string& nodes, const std::string& tets,
                          const std::string& message) {
    files.write("m.node", nodes);
    files.write("m.ele", tets);
    CHECK_THROWS_WITH(read_mesh_file(files.path() / "m.ele"), ContainsSubstring(message));
  };
  files.write("m.node", node);
  CHECK_THROWS_WITH(read_mesh_file(files.path() / "m.node"),
                    ContainsSubstring("m.ele: no such file"));
  files.write("m.ele", ele);
  CHECK_NOTHROW(read_mesh_file(files.path() / "m.node"));
  refuse("", ele, "m.node: is empty");
  refuse("# only a comment\n", ele, "m.node: is empty");
  refuse(node.substr(0, 30), ele, "m.node:4: the file ends too early");
  refuse(replaced(node, "4 3", "4 2"), ele, "dimension is 2");
  refuse(replaced(node, "2 1 0 0", "7 1 0 0"), ele, "number of the node is 7");
  refuse(node, replaced(ele, "2 3 4", "2 3 5"), "node of a tetrahedron is 5");
  refuse(node, replaced(ele, "1 4 0", "2 4 0"), "m.ele:4: the file ends too early");
  refuse(node, replaced(ele, "2 3 4", "2 3 4.5"), "'4.5' is not a whole number");
}

TEST_CASE("mesh files that are missing or of an unknown kind are refused") {
  CHECK_THROWS_WITH(read_mesh_file("no-such.msh"), ContainsSubstring("no-such.msh: no such file"));
  CHECK_THROWS_WITH(read_mesh_file("liver.stp"),
                    ContainsSubstring("mesh format '.stp' is not known"));
}
