#include <sstream>

#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/gmsh_program.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "tests/precompute/mesh_files.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using namespace irdm::test;

namespace {

// A cube with edge 1 of quadrilaterals that all face outward.
const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

// A tetrahedron at `origin`, whose vertices are numbered from `first`.
std::string tetrahedron(double origin, int first) {
  std::ostringstream text;
  for (const auto& [x, y, z] : {std::array{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}) {
    text << "v " << x + origin << ' ' << y + origin << ' ' << z + origin << '\n';
  }
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    text << "f " << a + first << ' ' << b + first << ' ' << c + first << '\n';
  }
  return text.str();
}

// A ball of radius 5 whose surface has edges of about 1, as STL.
std::filesystem::path ball(const MeshFiles& files) {
  files.write("ball.geo",
              "SetFactory(\"OpenCASCADE\");\nSphere(1) = {7, 0, 0, 5};\nMesh.MeshSizeMax = 1;\n");
  files.run("gmsh -2 ball.geo -o ball.stl -bin");
  return files.path() / "ball.stl";
}

double mean_edge(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh, "m");
  return mean_edge(SurfaceMesh{mesh.nodes(surface.nodes, Eigen::all), surface.triangles});
}

}  // namespace

TEST_CASE("surfaces written by meshio are filled and keep their triangles") {
  for (const std::string name : {"meshio.stl", "meshio.obj", "meshio.ply", "meshio-ascii.ply"}) {
    CAPTURE(name);
    const TetMesh mesh = read_mesh_file(sample(name));
    CHECK_NOTHROW(check_mesh(mesh, name));
    CHECK(volume(mesh) == Approx(6.0));
    CHECK(extract_surface(mesh, name).triangles.rows() == 64);
  }
}

TEST_CASE("a surface is filled whatever its unit is") {
  const MeshFiles files;
  for (const double unit : {1e-7, 1e-4, 1e6}) {
    CAPTURE(unit);
    SurfaceMesh cube = checked_surface(weld(read_obj(files.write("c.obj", kCube))), "c");
    cube.nodes *= unit;
    const TetMesh mesh = fill_surface(cube, "c", "tetgen", 120.0, "");
    CHECK_NOTHROW(check_mesh(mesh, "c"));
    CHECK(volume(mesh) == Approx(unit * unit * unit));
    CHECK(mesh.nodes.topRows(8) == cube.nodes);
  }
}

TEST_CASE("surfaces written by Gmsh are filled with tetrahedra of the size of their triangles") {
  const MeshFiles files;
  const TetMesh binary = read_mesh_file(ball(files));
  files.run("gmsh -2 ball.geo -o ball.stl");
  const TetMesh ascii = read_mesh_file(files.path() / "ball.stl");
  CHECK(extract_surface(binary, "b").triangles.rows() ==
        extract_surface(ascii, "a").triangles.rows());
  CHECK_NOTHROW(check_mesh(ascii, "ball"));
  const double exact = 4.0 / 3.0 * std::acos(-1.0) * 125.0;
  CHECK(volume(ascii) < exact);
  CHECK(volume(ascii) > 0.97 * exact);
  // Regular tetrahedra with edge 1 would be 4400.
  CHECK(ascii.tet_count() > 2200);
  CHECK(ascii.tet_count() < 8800);
  CHECK(report_mesh(ascii).median_quality > 0.6);
}

TEST_CASE("a surface gets new triangles of the edge length that is asked for") {
  const MeshFiles files;
  const auto path = ball(files);
  const double exact = 4.0 / 3.0 * std::acos(-1.0) * 125.0;
  for (const double length : {0.7, 1.0, 2.0}) {
    const TetMesh mesh = read_mesh_file(path, length);
    CHECK_NOTHROW(check_mesh(mesh, "ball"));
    CHECK(mean_edge(mesh) == Approx(length).epsilon(0.15));
    CHECK(volume(mesh) == Approx(exact).epsilon(0.1));
  }
}

TEST_CASE("new triangles keep sharp edges") {
  const MeshFiles files;
  const TetMesh mesh = read_mesh_file(files.write("cube.OBJ", kCube), 0.25);
  CHECK_NOTHROW(check_mesh(mesh, "cube"));
  CHECK(volume(mesh) == Approx(1.0));
  CHECK(mean_edge(mesh) == Approx(0.25).epsilon(0.2));
}

TEST_CASE("an edge length that does not fit the body is refused") {
  const MeshFiles files;
  const auto path = files.write("cube.obj", kCube);
  CHECK_THROWS_WITH(read_mesh_file(path, 250.0), ContainsSubstring("mind mesh.unit"));
  CHECK_THROWS_WITH(read_mesh_file(path, 0.25e-3), ContainsSubstring("millions of tetrahedra") &&
                                                       ContainsSubstring("mind mesh.unit"));
  // Gmsh 4.8 meshes it, 4.13 does not.
  CHECK_THROWS_WITH(read_mesh_file(ball(files), 9.0),
                    ContainsSubstring("changes its volume by") ||
                        ContainsSubstring("try another mesh.edge_length"));
}

TEST_CASE("triangles that are turned wrongly, double vertices and left-over ones do no harm") {
  const MeshFiles files;
  const SurfaceMesh cube = checked_surface(weld(read_obj(files.write("c.obj", kCube))), "c");
  for (const std::string& changed :
       {replaced(kCube, "f 1 2 6 5", "f 5 6 2 1"), kCube + "v 9 9 9\n",
        replaced(replaced(kCube, "f 4 3", "v 1e-9 0 0\nf 4 3"), "f 1 2 6 5", "f 9 2 6 5") +
            "f 1 9 4\n",
        replaced(kCube, "f 1 2 6 5", "f -8/1 -7/2 -3/3/3 -4//4")}) {
    CAPTURE(changed);
    const SurfaceMesh surface = checked_surface(weld(read_obj(files.write("c.obj", changed))), "c");
    CHECK(surface.nodes.rows() == 8);
    CHECK(enclosed_volume(surface) == Approx(1.0));
    CHECK(volume(read_mesh_file(files.path() / "c.obj")) == Approx(1.0));
  }
  CHECK(enclosed_volume(cube) == Approx(1.0));
}

TEST_CASE("a surface that is open is refused with the place") {
  const MeshFiles files;
  CHECK_THROWS_WITH(
      read_mesh_file(files.write("c.obj", replaced(kCube, "f 5 6 7 8\n", ""))),
      ContainsSubstring("c.obj: the surface is open at 4 edges, for instance from (1, 0, 1) "
                        "to (0, 0, 1)") &&
          ContainsSubstring("close the hole"));
  // A facet of the real thing left out.
  ball(files);
  files.run("gmsh -2 ball.geo -o ball.stl");
  std::string text = content(files.path() / "ball.stl");
  const std::size_t facet = text.find("\nfacet", text.size() / 2) + 1;
  text.erase(facet, text.find("endfacet", facet) + 9 - facet);
  CHECK_THROWS_WITH(read_mesh_file(files.write("open.stl", text)),
                    ContainsSubstring("open at 3 edges"));
}

TEST_CASE("a surface that is not manifold is refused with the place") {
  const MeshFiles files;
  const std::string fin = kCube + "v 0 0 -1\nf 1 2 9\nf 2 1 9\n";
  CHECK_THROWS_WITH(read_mesh_file(files.write("c.obj", fin)),
                    ContainsSubstring("more than two triangles meet at 1 edge,") &&
                        ContainsSubstring("from (1, 0, 0) to (0, 0, 0)"));
  CHECK_THROWS_WITH(read_mesh_file(files.write("c.obj", kCube + "f 5 6 7\nf 7 6 5\n")),
                    ContainsSubstring("more than two triangles meet at 3 edges"));
}

TEST_CASE("a surface in several pieces is refused with their places") {
  const MeshFiles files;
  CHECK_THROWS_WITH(
      read_mesh_file(files.write("c.obj", tetrahedron(0.0, 1) + tetrahedron(4.0, 5))),
      ContainsSubstring("more than one piece: (0, 0, 0) and (4, 4, 4) are not connected"));
}

TEST_CASE("a surface that cuts itself is refused with the place") {
  const MeshFiles files;
  // The tip of a pyramid pulled through its base.
  const std::string text =
      replaced(kCube, "f 5 6 7 8\n", "v 0.5 0.5 -0.5\nf 5 6 9\nf 6 7 9\nf 7 8 9\nf 8 5 9\n");
  CHECK_THROWS_WITH(read_mesh_file(files.write("c.obj", text)),
                    ContainsSubstring("c.obj: the surface cuts or touches itself: ") &&
                        ContainsSubstring("pairs of triangles, for instance at ("));
  CHECK_THROWS_WITH(read_mesh_file(files.path() / "c.obj", 0.25),
                    ContainsSubstring("cuts or touches itself"));
}

TEST_CASE("damaged surface files are refused with the fault") {
  const MeshFiles files;
  const auto refuse = [&](const std::string& name, const std::string& text,
                          const std::string& message) {
    CAPTURE(name, text.substr(0, 100));
    CHECK_THROWS_WITH(read_mesh_file(files.write(name, text)),
                      ContainsSubstring(name) && ContainsSubstring(message));
  };
  refuse("c.obj", "", "is empty");
  refuse("c.obj", "# nothing\n", "is empty");
  refuse("c.obj", "v 0 0 0\n", "has 0 triangles");
  refuse("c.obj", replaced(kCube, "v 1 1 0", "v 1 one 0"), "c.obj:3: 'one' is not a number");
  refuse("c.obj", replaced(kCube, "v 1 1 0", "v 1 nan 0"), "not finite");
  refuse("c.obj", replaced(kCube, "f 5 6 7 8", "f 5 6 7 9"), "vertex '9' of a face does not exist");
  refuse("c.obj", replaced(kCube, "f 5 6 7 8", "f 5 6"), "less than three corners");
  refuse("c.obj", "hello\n", "'hello' stands where v or f should");

  const std::string ply = content(sample("meshio-ascii.ply"));
  refuse("c.ply", "hello", "is not a PLY file");
  refuse("c.ply", replaced(ply, "ascii", "other"), "format 'other' is not known");
  refuse("c.ply", replaced(ply, "property double x", "property double a"), "has not x, y and z");
  refuse("c.ply", replaced(ply, "double", "string"), "numbers of type 'string' are not known");
  refuse("c.ply", replaced(ply, "vertex 34", "vertex 20"), "must be whole");
  refuse("c.ply", ply.substr(0, ply.rfind('\n', ply.size() - 2) + 1) + "3 0 1 99\n",
         "vertex of a face is 99");
  const std::string binary = content(sample("meshio.ply"));
  const std::string stl = content(sample("meshio.stl"));
  for (const double share : {0.05, 0.4, 0.99}) {
    const auto cut = [&](const std::string& text) {
      return text.substr(0, static_cast<std::size_t>(share * double(text.size())));
    };
    refuse("c.ply", cut(ply), "truncated");
    refuse("c.ply", cut(binary), "truncated");
    refuse("c.stl", cut(stl), "truncated");
  }
  ball(files);
  files.run("gmsh -2 ball.geo -o ball.stl");
  const std::string ascii = content(files.path() / "ball.stl");
  refuse("c.stl", ascii.substr(0, ascii.find("vertex", ascii.size() / 2)), "truncated");
  refuse("c.stl", replaced(ascii, "endloop", "endlop"), "'endlop' stands where endloop should");
}

TEST_CASE("flat tetrahedra where the surface is remeshed are refused") {
  // A program in the place of gmsh, whose mesh has a flat tetrahedron below the body.
  const MeshFiles files;
  const SurfaceMesh body =
      checked_surface(weld(read_obj(files.write("t.obj", tetrahedron(0, 1)))), "t");
  files.write("flat.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
              "4 0 0 1\n5 0.3 0.3 -1e-7\n$EndNodes\n$Elements\n2\n1 4 2 0 1 1 2 3 4\n"
              "2 4 2 0 1 1 3 2 5\n$EndElements\n");
  const auto program =
      files.write("gmsh", "#!/bin/sh\ncp '" + (files.path() / "flat.msh").string() + "' \"$6\"\n");
  files.run("chmod +x gmsh");
  CHECK_THROWS_WITH(
      remesh_surface(body, 0.5, "t.obj", program.string()),
      ContainsSubstring("t.obj: with this mesh.edge_length gmsh makes 1 flat tetrahedra"));
}

TEST_CASE("missing or failing programs are told") {
  const MeshFiles files;
  const SurfaceMesh cube = checked_surface(weld(read_obj(files.write("c.obj", kCube))), "c");
  const auto script = files.write("a.geo", "Point(1) = {0, 0, 0};\n");
  CHECK_THROWS_WITH(
      mesh_geometry(script, "no-such-gmsh"),
      ContainsSubstring("no-such-gmsh: the program cannot be started; install the package"));
  CHECK_THROWS_WITH(mesh_geometry(script, "false"), ContainsSubstring("false cannot mesh it"));
  CHECK_THROWS_WITH(mesh_geometry(script, "true"), ContainsSubstring("true made no mesh of it"));
  CHECK_THROWS_WITH(remesh_surface(cube, 0.5, "c", "no-such-gmsh"),
                    ContainsSubstring("cannot be started"));
  CHECK_THROWS_WITH(fill_surface(cube, "c", "no-such-tetgen"),
                    ContainsSubstring("cannot be started"));
  CHECK_THROWS_WITH(
      fill_surface(cube, "c.obj", "false"),
      ContainsSubstring("false: failed with c.obj") && ContainsSubstring("set mesh.edge_length"));
  CHECK_THROWS_WITH(check_self_intersection(cube, "c", "no-such-tetgen"),
                    ContainsSubstring("cannot be started"));
}
