// Mesh files, one harness a format. What was read is looked at by check_mesh() as every mesh is.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/error.hpp"
#include "precompute/display/make_display_mesh.hpp"
#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/round_mesh.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {
namespace {

using namespace precompute;

template <typename Read>
void read_mesh(Input input, const char* name, const Read& read) {
  try {
    const TetMesh mesh = read(scratch_file(name, text_of(input)));
    check_mesh(mesh, name);
    for (int e = 0; e < mesh.tet_count(); ++e) {
      expect(signed_volume(mesh, e) > 0.0, "a mesh that passes the checks has no empty element");
    }
  } catch (const Error&) {
  }
}

template <typename Read>
void read_surface(Input input, const char* name, const Read& read) {
  try {
    const SurfaceMesh mesh = checked_surface(read(scratch_file(name, text_of(input))), name);
    for (Eigen::Index i = 0; i < mesh.triangles.rows(); ++i) {
      for (const int node : mesh.triangles.row(i)) {
        expect(node >= 0 && node < mesh.nodes.rows(), "a surface has the nodes of its triangles");
      }
    }
  } catch (const Error&) {
  }
}

// The surface of a ball that a display mesh is bound to.
const ModelMesh& ball() {
  static const ModelMesh mesh = [] {
    const SurfaceMesh surface = sphere_surface(2);
    ModelMesh made;
    made.nodes = surface.nodes;
    made.triangles = surface.triangles;
    for (int i = 0; i < static_cast<int>(made.nodes.rows()); ++i) made.surface_nodes.push_back(i);
    return made;
  }();
  return mesh;
}

void make_display(Input input) {
  DisplayConfig config;
  config.file = scratch_file("it.obj", text_of(input));
  try {
    const DisplayMesh display = make_display_mesh(config, ball());
    expect(!display_fault(display, ball().surface_node_count()), "a display mesh can be read");
  } catch (const Error&) {
  }
}

}  // namespace

void mesh_msh(Input input) {
  read_mesh(input, "it.msh", read_gmsh);
}
void mesh_medit(Input input) {
  read_mesh(input, "it.mesh", read_medit);
}
void mesh_vtk(Input input) {
  read_mesh(input, "it.vtk", read_vtk);
}
void mesh_vtu(Input input) {
  read_mesh(input, "it.vtu", read_vtu);
}
void mesh_stl(Input input) {
  read_surface(input, "it.stl", read_stl);
}
void mesh_obj(Input input) {
  read_surface(input, "it.obj", read_obj);
  make_display(input);
}
void mesh_ply(Input input) {
  read_surface(input, "it.ply", read_ply);
}

void mesh_tetgen(Input input) {
  const std::string_view text = text_of(input);
  const std::size_t end = std::min(text.find('%'), text.size());
  scratch_file("it.ele", text.substr(std::min(end + 1, text.size())));
  const std::string nodes(text.substr(0, end));
  read_mesh({reinterpret_cast<const std::uint8_t*>(nodes.data()), nodes.size()}, "it.node",
            read_tetgen);
}

}  // namespace irdm::fuzz
