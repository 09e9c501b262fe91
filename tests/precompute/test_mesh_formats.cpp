#include <array>

#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/region.hpp"
#include "tests/precompute/mesh_files.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

namespace {

// A block of 1 x 2 x 3 whose base and body are groups where the format has them.
const std::string kBlock =
    "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 2, 3};\nMesh.MeshSizeMax = 1;\n"
    "Mesh.SaveAll = 1;\n";

void check_block(const TetMesh& mesh) {
  CHECK_NOTHROW(check_mesh(mesh, "block"));
  CHECK(volume(mesh) == Approx(6.0));
}

void check_refused(const std::filesystem::path& path, const std::string& message) {
  CHECK_THROWS_WITH(read_mesh_file(path),
                    ContainsSubstring(message) && ContainsSubstring(path.string()));
}

}  // namespace

TEST_CASE("VTK, VTU and Medit files of meshio and VTK hold the mesh that was written") {
  const TetMesh expected = read_mesh_file(sample("vtk-ascii.vtu"));
  CHECK(expected.tet_count() == 78);
  CHECK(expected.node_count() == 34);
  for (const std::string name : {"meshio.vtk", "meshio.vtu", "meshio.mesh", "vtk51-ascii.vtk",
                                 "vtk51-binary.vtk", "vtk-appended-zlib.vtu", "vtk-raw-zlib.vtu",
                                 "vtk-raw.vtu", "vtk-ascii.vtu", "vtk-inline-big-endian.vtu"}) {
    CAPTURE(name);
    const TetMesh mesh = read_mesh_file(sample(name));
    check_block(mesh);
    CHECK(mesh.tets == expected.tets);
    CHECK((mesh.nodes - expected.nodes).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("base64 of a .vtu whose length is padded on its own is read") {
  const MeshFiles files;
  std::string wide = replaced(content(sample("split-header-inline.vtu")), "UInt32", "UInt64");
  for (std::size_t at = wide.find("AA=="); at != std::string::npos; at = wide.find("AA==")) {
    wide.replace(at, 4, "AAAAAAA=");  // eight bytes
  }
  for (const auto& path : {sample("split-header-inline.vtu"), sample("split-header-appended.vtu"),
                           files.write("wide.vtu", wide)}) {
    CAPTURE(path);
    const TetMesh mesh = read_mesh_file(path);
    CHECK(mesh.node_count() == 27);
    CHECK(mesh.tet_count() == 48);
    CHECK(volume(mesh) == Approx(1e-3));
    CHECK_NOTHROW(check_mesh(mesh, "cube"));
  }
}

TEST_CASE("second-order tetrahedra of Medit are named, whatever comes before them") {
  const MeshFiles files;
  files.write("block.geo", kBlock);
  files.run("gmsh -3 -order 2 block.geo -o m.mesh");
  REQUIRE_THAT(content(files.path() / "m.mesh"), ContainsSubstring("EdgesP2"));
  check_refused(files.path() / "m.mesh", "second-order tetrahedra");
  const std::string linear = content(sample("meshio.mesh"));
  const std::string edges = "EdgesP2\n1\n1 2 3 0\nTrianglesP2\n1\n1 2 3 4 5 6 0\n";
  check_block(read_mesh_file(
      files.write("e.mesh", replaced(linear, "\nTetrahedra", "\n" + edges + "Tetrahedra"))));
}

TEST_CASE("groups of a Gmsh file in partitions are those of the whole") {
  const MeshFiles files;
  files.write("block.geo", kBlock +
                               "Mesh.SaveAll = 0;\n"  // MSH 2.2 would have no groups
                               "Physical Volume(\"body\") = {1};\n"
                               "Physical Surface(\"base\") = {5};\n");
  for (const std::string format : {"msh41", "msh22"}) {
    CAPTURE(format);
    files.run("gmsh -3 block.geo -format " + format + " -o whole.msh");
    files.run("gmsh -3 -part 2 block.geo -format " + format + " -o parts.msh");
    const TetMesh whole = read_mesh_file(files.path() / "whole.msh");
    const TetMesh parts = read_mesh_file(files.path() / "parts.msh");
    CHECK(parts.tet_count() == whole.tet_count());
    for (const std::string name : {"body", "base"}) {
      CAPTURE(name);
      const auto nodes = nodes_in(parts, GroupRegion{name}, "m");
      CHECK(nodes.size() == nodes_in(whole, GroupRegion{name}, "m").size());
      for (const int node : nodes) CHECK((name == "body" || parts.nodes(node, 2) == 0.0));
    }
  }
}

TEST_CASE("VTK and Medit files of Gmsh are read") {
  const MeshFiles files;
  files.write("block.geo", kBlock);
  files.run("gmsh -3 block.geo -o block.msh");
  const TetMesh expected = read_mesh_file(files.path() / "block.msh");
  for (const std::string options : {"-o m.vtk", "-o m.vtk -bin", "-o m.mesh"}) {
    CAPTURE(options);
    files.run("gmsh -3 block.geo " + options);
    const TetMesh mesh = read_mesh_file(files.path() / options.substr(3, options.find(' ', 3) - 3));
    check_block(mesh);
    CHECK(mesh.tet_count() == expected.tet_count());
  }
}

TEST_CASE("references of a Medit file become groups") {
  const MeshFiles files;
  files.write("block.geo", kBlock);
  files.run("gmsh -3 block.geo -o block.mesh");
  const TetMesh mesh = read_mesh_file(files.path() / "block.mesh");
  CHECK(mesh.groups.at("tetrahedra 1").size() == static_cast<std::size_t>(mesh.tet_count()));
  // Gmsh numbers the faces of a box: low x, high x, low y, high y, low z, high z.
  CHECK(nodes_in(mesh, GroupRegion{"triangles 5"}, "m") == nodes_in(mesh, HalfSpace{}, "m"));
  CHECK_THROWS_WITH(
      nodes_in(mesh, GroupRegion{"triangles 9"}, "m"),
      ContainsSubstring("no group 'triangles 9'") && ContainsSubstring("'triangles 6'"));
}

TEST_CASE("a geometry script is meshed with its own sizes and groups") {
  const MeshFiles files;
  const auto path = files.write("block.geo", kBlock + "Physical Surface(\"base\") = {5};\n");
  const TetMesh mesh = read_mesh_file(path);
  check_block(mesh);
  CHECK(nodes_in(mesh, GroupRegion{"base"}, "m") == nodes_in(mesh, HalfSpace{}, "m"));
}

TEST_CASE("a geometry script that cannot be meshed is refused with what gmsh says") {
  const MeshFiles files;
  check_refused(files.write("a.geo", "Sphere(1) = {0, 0, 0, 1}"), "syntax error");
  check_refused(files.write("b.geo", "Point(1) = {0, 0, 0};\nError(\"no luck\");\n"), "no luck");
  check_refused(files.path() / "none.geo", "no such file");
  CHECK_THROWS_WITH(
      check_mesh(read_mesh_file(files.write("c.geo", "Point(1) = {0, 0, 0};\n")), "c"),
      ContainsSubstring("there are no tetrahedra"));
}

TEST_CASE("other volume elements are refused with their kind and number") {
  const MeshFiles files;
  files.write("layers.geo",
              "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\n"
              "Transfinite Curve{:} = 3;\nTransfinite Surface{1};\nRecombine Surface{1};\n"
              "Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; }\nMesh.SaveAll = 1;\n");
  for (const std::string name : {"m.vtk", "m.mesh"}) {
    files.run("gmsh -3 layers.geo -o " + name);
    CHECK_THROWS_WITH(read_mesh_file(files.path() / name),
                      ContainsSubstring("there are 8 hexahedra") &&
                          ContainsSubstring("write linear tetrahedra only"));
  }
  files.run("gmsh -3 layers.geo -o m.msh");
  check_refused(files.path() / "m.msh", "there is a hexahedron");
  files.write("block.geo", kBlock);
  files.run("gmsh -3 -order 2 block.geo -o m.vtk");
  check_refused(files.path() / "m.vtk", "second-order tetrahedra");
  const std::string vtu = content(sample("vtk-ascii.vtu"));
  const std::size_t types = vtu.find("Name=\"types\"");
  const std::size_t tet = vtu.find("10", vtu.find("5 5 5", types));
  check_refused(files.write("m.vtu", std::string(vtu).replace(tet, 2, "12")),
                "there are 1 hexahedra");
}

TEST_CASE("files that are cut off anywhere are refused") {
  const MeshFiles files;
  for (const std::string name :
       {"meshio.vtk", "meshio.vtu", "meshio.mesh", "vtk51-ascii.vtk", "vtk-appended-zlib.vtu",
        "vtk-raw-zlib.vtu", "vtk-raw.vtu", "vtk-ascii.vtu"}) {
    const std::string whole = content(sample(name));
    // What follows the cells of a legacy file is not needed.
    for (const double share : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9}) {
      CAPTURE(name, share);
      const auto length = static_cast<std::size_t>(share * double(whole.size()));
      CHECK_THROWS_WITH(read_mesh_file(files.write(name, whole.substr(0, length))),
                        ContainsSubstring(name));
    }
  }
}

TEST_CASE("files of random bytes are refused in printable words") {
  const MeshFiles files;
  std::string noise;
  for (unsigned i = 0, x = 1; i < 3000; ++i)
    noise += static_cast<char>((x = x * 1103515245 + 12345) >> 16);
  for (const std::string name :
       {"m.msh", "m.node", "m.vtk", "m.vtu", "m.mesh", "m.stl", "m.obj", "m.ply", "m.geo"}) {
    CAPTURE(name);
    try {
      read_mesh_file(files.write(name, noise));
      FAIL("was read");
    } catch (const std::exception& error) {
      const std::string text = error.what();
      CHECK_THAT(text, ContainsSubstring(name));
      CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
    }
  }
}

TEST_CASE("damaged VTK files are refused with the fault") {
  const MeshFiles files;
  const std::string text = content(sample("vtk51-ascii.vtk"));
  const auto refuse = [&](const std::string& changed, const std::string& message) {
    check_refused(files.write("m.vtk", changed), message);
  };
  refuse("hello", "is not a VTK file");
  refuse(replaced(text, "UNSTRUCTURED_GRID", "POLYDATA"), "data set is 'POLYDATA'");
  refuse(replaced(text, "ASCII", "OTHER"), "'OTHER' stands where ASCII or BINARY");
  refuse(replaced(text, "double", "string"), "numbers of type 'string'");
  refuse(replaced(text, "OFFSETS", "OFFSET"), "'OFFSET' stands where OFFSETS");
  refuse(replaced(text, "CELL_TYPES 142", "CELL_TYPES 141"), "142 cells but types of 141");
  refuse(replaced(text, "POINTS 34", "POINTS 33"), "stands where a section should begin");
  refuse(replaced(text, "POINTS 34", "POINTS -3"), "number of points is -3");
}

TEST_CASE("damaged VTU files are refused with the fault") {
  const MeshFiles files;
  const std::string text = content(sample("vtk-ascii.vtu"));
  const std::string packed = content(sample("vtk-appended-zlib.vtu"));
  const auto refuse = [&](const std::string& changed, const std::string& message) {
    check_refused(files.write("m.vtu", changed), message);
  };
  refuse("", "is empty");
  refuse("hello", "is not well-formed XML");
  refuse(replaced(text, "type=\"UnstructuredGrid\"", "type=\"PolyData\""), "unstructured grid");
  refuse(replaced(text, "<Points>", "<Dots>"), "has no array Points");
  refuse(replaced(text, "Name=\"offsets\"", "Name=\"offset\""), "no array Cells offsets");
  refuse(replaced(text, "type=\"Float64\" Name=\"Points\"", "type=\"String\" Name=\"Points\""),
         "array Points has numbers of an unknown type");
  refuse(replaced(packed, "vtkZLibDataCompressor", "vtkLZMADataCompressor"),
         "compressed by vtkLZMADataCompressor");
  check_refused(sample("vtk-lz4.vtu"), "compressed by vtkLZ4DataCompressor");
  const std::size_t data = packed.find('_', packed.find("<AppendedData")) + 1;
  std::string changed = packed;
  changed.replace(data + 40, 4, "AAAA");
  refuse(changed, "a compressed block is damaged");
  changed = packed;
  changed.replace(data, 4, "////");
  refuse(changed, "its data end too early");
  changed.replace(data, 4, "*?*?");
  refuse(changed, "not base64");
}

TEST_CASE("damaged Medit files are refused with file, line and fault") {
  const MeshFiles files;
  const std::string text =
      "MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
      "# a comment\nTetrahedra 1\n1 2 3 4 0\nEnd\n";
  const auto refuse = [&](const std::string& changed, const std::string& message) {
    check_refused(files.write("m.mesh", changed), message);
  };
  const TetMesh mesh = read_mesh_file(files.write("m.mesh", text));
  CHECK(mesh.tet_count() == 1);
  CHECK(mesh.groups.empty());
  refuse("", "is empty");
  refuse("hello", "is not a Medit file in ASCII");
  refuse(replaced(text, "1 2 3 4 0", "1 2 3 5 0"), "m.mesh:10: vertex is 5");
  refuse(replaced(text, "1 2 3 4 0", "1 2 3 x 0"), "m.mesh:10: 'x' is not a whole number");
  refuse(replaced(text, "Dimension 3", "Dimension 2"), "dimension is 2");
  refuse(replaced(text, "# a comment", "Cubes 3"), "'Cubes' is not a known section");
  refuse(replaced(text, "# a comment", "Hexahedra 3"), "there are 3 hexahedra");
  refuse(text.substr(0, text.find("Tetra")), "has no Tetrahedra");
}
