#include "precompute/mesh/tetgen_program.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <set>

#include "common/error.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tetgen_reader.hpp"
#include "precompute/process/child_process.hpp"
#include "precompute/process/temporary_folder.hpp"

namespace irdm::precompute {
namespace {

// Quality 1.1 and no bound on the dihedral angle: with one (-q1.1/18) and a fixed surface the
// program inserts points for ever.
constexpr const char* kFlags = "-pYq1.1";

// TetGen's input: nodes and facets, numbered from 0.
void write_poly(const BoxSurface& surface, const std::filesystem::path& path) {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  file << surface.nodes.rows() << " 3 0 0\n";
  for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
    file << i << ' ' << surface.nodes.row(i) << '\n';
  }
  file << surface.triangles.rows() << " 0\n";
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    file << "1\n3 " << surface.triangles.row(t) << '\n';
  }
  file << "0\n0\n";
  if (!file.flush()) throw Error(path.string(), "cannot be written", "check the space left there");
}

std::set<std::array<int, 3>> sorted_triangles(const Triangles& triangles) {
  std::set<std::array<int, 3>> sorted;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    std::array<int, 3> nodes{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::sort(nodes.begin(), nodes.end());
    sorted.insert(nodes);
  }
  return sorted;
}

bool surface_is_kept(const BoxSurface& surface, const TetMesh& mesh) {
  const Eigen::Index n = surface.nodes.rows();
  if (mesh.node_count() < n) return false;
  const double tolerance = 1e-9 * surface.nodes.cwiseAbs().maxCoeff();
  return (mesh.nodes.topRows(n) - surface.nodes).cwiseAbs().maxCoeff() <= tolerance &&
         sorted_triangles(boundary_faces(mesh, "tetgen")) == sorted_triangles(surface.triangles);
}

}  // namespace

TetMesh tetrahedralise(const BoxSurface& surface, const std::string& program, double time_limit_s) {
  const TemporaryFolder folder("irdm-tetgen");
  write_poly(surface, folder.path() / "box.poly");
  switch (run_child(program, {kFlags, "box.poly"}, folder.path(), folder.path() / "log",
                    time_limit_s)) {
    case ChildEnd::kSuccess:
      break;
    case ChildEnd::kNotFound:
      throw Error(program, "the program cannot be started", "install the package tetgen");
    case ChildEnd::kTimeout:
      throw Error(program,
                  "is not done after " + std::to_string(static_cast<int>(time_limit_s)) +
                      " s with this box",
                  "use fewer cells or cells that are closer to cubes");
    case ChildEnd::kFailure:
      throw Error(program, "failed with this box",
                  "use cells that are closer to cubes or give a mesh file");
  }
  TetMesh mesh = read_tetgen(folder.path() / "box.1.node");
  if (!surface_is_kept(surface, mesh)) {
    throw Error(program, "did not keep the surface of the box", "use TetGen 1.5 or newer");
  }
  mesh.nodes.topRows(surface.nodes.rows()) = surface.nodes;  // undo the rounding of its text files
  return mesh;
}

}  // namespace irdm::precompute
