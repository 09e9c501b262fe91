// Sound files that programs write in their own ways, and what is said about those that are not
// read.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/region.hpp"
#include "tests/precompute/mesh_files.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

namespace {

// Two tetrahedra on one triangle, volumes 1/6 and 1/3.
const std::string kFormat = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string kNodes = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -2\n$EndNodes\n";
constexpr const char* kMark = "\xEF\xBB\xBF";

std::string elements(const std::string& lines, int count) {
  return "$Elements\n" + std::to_string(count) + "\n" + lines + "$EndElements\n";
}

// Volume group 1 and surface group 1, with names where there are any.
std::string two_dimensions(const std::string& names) {
  return kFormat + names + kNodes +
         elements("1 4 2 1 1 1 2 3 4\n2 4 2 2 2 1 3 2 5\n3 2 2 1 1 1 2 5\n", 3);
}

std::vector<int> nodes_of(const TetMesh& mesh, const std::string& group) {
  return nodes_in(mesh, GroupRegion{group}, "m.msh");
}

// A cube of 1 with an unused vertex.
std::string cube_obj(const std::string& stray) {
  return stray +
         "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "f -8 -5 -6 -7\nf -4 -3 -2 -1\nf -8 -7 -3 -4\nf -7 -6 -2 -3\nf -6 -5 -1 -2\n"
         "f -5 -8 -4 -1\n";
}

}  // namespace

TEST_CASE("a number of physical groups of two dimensions is refused, and both are named") {
  const MeshFiles files;
  const TetMesh mesh = read_mesh_file(files.write("m.msh", two_dimensions("")));
  CHECK_THROWS_WITH(nodes_of(mesh, "1"), ContainsSubstring("several groups '1'") &&
                                             ContainsSubstring("'surface 1' or 'volume 1'"));
  CHECK(nodes_of(mesh, "surface 1") == std::vector<int>{0, 1, 4});
  CHECK(nodes_of(mesh, "volume 1") == std::vector<int>{0, 1, 2, 3});
  CHECK(nodes_of(mesh, "2") == std::vector<int>{0, 1, 2, 4});
}

TEST_CASE("a name of physical groups of two dimensions is refused, and both are named") {
  const MeshFiles files;
  const std::string names =
      "$PhysicalNames\n2\n2 1 \"left  side\"\n3 1 \"left  side\"\n$EndPhysicalNames\n";
  const TetMesh mesh = read_mesh_file(files.write("m.msh", two_dimensions(names)));
  CHECK_THROWS_WITH(nodes_of(mesh, "left  side"),
                    ContainsSubstring("'surface left  side' or 'volume left  side'"));
  CHECK(nodes_of(mesh, "surface left  side").size() == 3);
}

TEST_CASE("a tetrahedron that MSH 2.2 has once for each of its groups is one tetrahedron") {
  const MeshFiles files;
  const std::string lines =
      "1 4 2 1 1 1 2 3 4\n2 4 2 1 2 1 3 2 5\n3 4 2 2 1 1 2 3 4\n";  // the first is in both
  const TetMesh mesh = read_mesh_file(files.write("m.msh", kFormat + kNodes + elements(lines, 3)));
  CHECK(mesh.tet_count() == 2);
  CHECK(volume(mesh) == Approx(0.5));
  CHECK(nodes_of(mesh, "1").size() == 5);
  CHECK(nodes_of(mesh, "2").size() == 4);
}

TEST_CASE("MSH 1 is refused with the command that converts it") {
  const MeshFiles files;
  CHECK_THROWS_WITH(read_mesh_file(files.write("m.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n")),
                    ContainsSubstring("MSH version 1 is not read") &&
                        ContainsSubstring("gmsh -save FILE -format msh41"));
}

TEST_CASE("parametric nodes of MSH 2.2 are nodes") {
  const MeshFiles files;
  const std::string nodes =
      "$ParametricNodes\n5\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n3 0 1 0 2 1 0.5 0.5\n4 0 0 1 3 1\n"
      "5 0 0 -2 3 1\n$EndParametricNodes\n";
  const TetMesh mesh = read_mesh_file(files.write(
      "m.msh", kFormat + nodes + elements("1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 3 2 5\n", 2)));
  CHECK(volume(mesh) == Approx(0.5));
}

TEST_CASE("a byte order mark before the text of a mesh is passed over") {
  const MeshFiles files;
  const std::string msh = kFormat + kNodes + elements("1 4 2 1 1 1 2 3 4\n", 1);
  CHECK(read_mesh_file(files.write("m.msh", kMark + msh)).tet_count() == 1);
  CHECK(volume(read_mesh_file(files.write("m.obj", kMark + cube_obj("")))) == Approx(1.0));
  for (const char* name : {"vtk-ascii.vtu", "meshio.vtk", "meshio.mesh"}) {
    CAPTURE(name);
    const TetMesh plain = read_mesh_file(sample(name));
    CHECK(read_mesh_file(files.write(name, kMark + content(sample(name)))).tets == plain.tets);
  }
}

TEST_CASE("VTK's two formats are told apart by what they hold, not by their name") {
  const MeshFiles files;
  const TetMesh mesh = read_mesh_file(sample("vtk-ascii.vtu"));
  CHECK(read_mesh_file(files.write("m.vtk", content(sample("vtk-ascii.vtu")))).tets == mesh.tets);
  CHECK(read_mesh_file(files.write("m.vtu", content(sample("meshio.vtk")))).tets == mesh.tets);
}

TEST_CASE("lines of a surface may end with CR alone, and messages count them") {
  const MeshFiles files;
  std::string text = cube_obj("# a cube\n");
  std::ranges::replace(text, '\n', '\r');
  CHECK(volume(read_mesh_file(files.write("m.obj", text))) == Approx(1.0));
  CHECK_THROWS_WITH(read_mesh_file(files.write("m.obj", "v 0 0 0\rv 1 0 0\rx\r")),
                    ContainsSubstring("m.obj:3"));
  const std::string facet =
      "facet normal 0 0 0\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 0\rendloop\r"
      "endfacet\r";
  CHECK_THROWS_WITH(read_mesh_file(files.write("m.stl", "solid a b\r" + facet + "endsolid a b\r")),
                    !ContainsSubstring("ends too early"));
}

TEST_CASE("concave polygons of an .obj and a .ply enclose their volume, from whatever corner") {
  const MeshFiles files;
  // Outlines counter-clockwise: L, U, a star of five points.
  const std::vector<std::pair<std::vector<std::array<double, 2>>, double>> outlines{
      {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3.0},
      {{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 5.0},
      {{{0, 3},
        {-0.7, 1},
        {-3, 1},
        {-1.1, -0.4},
        {-1.8, -2.5},
        {0, -1.2},
        {1.8, -2.5},
        {1.1, -0.4},
        {3, 1},
        {0.7, 1}},
       10.89}};
  for (const auto& [outline, area] : outlines) {
    const int n = static_cast<int>(outline.size());
    for (int first = 0; first < n; ++first) {
      CAPTURE(n, first);
      std::string text;
      for (const int z : {0, 1}) {
        for (const auto& [x, y] : outline) {
          text +=
              "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
        }
      }
      std::string top = "f";
      std::string bottom = "f";
      for (int i = 0; i < n; ++i) {
        top += " " + std::to_string(n + 1 + (first + i) % n);
        bottom += " " + std::to_string(1 + (first + n - i) % n);
        const int next = (i + 1) % n;
        text += "f " + std::to_string(i + 1) + " " + std::to_string(next + 1) + " " +
                std::to_string(n + next + 1) + " \\\n" + std::to_string(n + i + 1) + "\n";
      }
      const TetMesh mesh = read_mesh_file(files.write("m.obj", text + top + "\n" + bottom + "\n"));
      CHECK(volume(mesh) == Approx(area).epsilon(1e-6));
    }
  }
}

TEST_CASE("a .vtu of deeply nested elements is refused") {
  const MeshFiles files;
  std::string text = "<?xml version=\"1.0\"?>\n";
  for (int i = 0; i < 200'000; ++i) text += "<a>";
  CHECK_THROWS_WITH(read_mesh_file(files.write("m.vtu", text)), ContainsSubstring("nested"));
}

TEST_CASE("an unused vertex far away does not change a surface") {
  const MeshFiles files;
  for (const char* stray : {"v 1e5 0 0\n", "v 1e6 1e6 1e6\n"}) {
    CAPTURE(stray);
    CHECK(volume(read_mesh_file(files.write("m.obj", cube_obj(stray)))) == Approx(1.0));
  }
}

TEST_CASE("meshing works in a temporary folder that is named relative to the present one") {
  const MeshFiles files;
  files.write("m.obj", cube_obj(""));
  files.write("m.toml",
              "[mesh]\nfile = \"m.obj\"\nedge_length = 0.5\n[material]\nyoungs_modulus = 1000.0\n"
              "poisson_ratio = 0.3\ndensity = 1000.0\n[response]\ndt = 0.002\nsteps = 100\n");
  files.run("TMPDIR=. '" IRDM_PROGRAM "' m.toml -o m.h5");
}
