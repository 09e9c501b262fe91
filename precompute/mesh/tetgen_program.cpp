#include "precompute/mesh/tetgen_program.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>

#include "common/error.hpp"
#include "common/process/child_program.hpp"
#include "common/process/temporary_files.hpp"
#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/surface.hpp"

namespace irdm::precompute {
namespace {

// Quality 1.1 and no bound on the dihedral angle: with one (-q1.1/18) and a fixed surface the
// program inserts points for ever.
constexpr const char* kFlags = "-pYq1.1";

// Largest volume inside a surface, in regular tetrahedra with the mean edge of its triangles: what
// is between leaves TetGen room.
constexpr double kInnerSize = 2.0;

// Mean edges for which the largest volume is written with few digits, and enough of them.
constexpr double kSmallestEdge = 1e-5;
constexpr double kLargestEdge = 1e5;

// TetGen's input: nodes and facets, numbered from 0.
void write_poly(const SurfaceMesh& surface, const std::filesystem::path& path) {
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

bool surface_is_kept(const SurfaceMesh& surface, const TetMesh& mesh) {
  const Eigen::Index n = surface.nodes.rows();
  if (mesh.node_count() < n) return false;
  const double tolerance = 1e-9 * surface.nodes.cwiseAbs().maxCoeff();
  return (mesh.nodes.topRows(n) - surface.nodes).cwiseAbs().maxCoeff() <= tolerance &&
         sorted_triangles(boundary_faces(mesh, "tetgen")) == sorted_triangles(surface.triangles);
}

// Runs the program on the surface; its files are surface.1.*. `subject` and `remedy` are for
// messages.
void run_tetgen(const SurfaceMesh& surface, const std::string& flags, const TemporaryFolder& folder,
                const std::string& program, double time_limit_s, const std::string& subject,
                const std::string& remedy) {
  write_poly(surface, folder.path() / "surface.poly");
  const ChildEnd end = run_child(program, {flags, "surface.poly"}, folder.path(),
                                 folder.path() / "log", time_limit_s);
  folder.require_space();
  switch (end) {
    case ChildEnd::kSuccess:
      return;
    case ChildEnd::kNotFound:
      throw Error(program, "the program cannot be started", "install the package tetgen");
    case ChildEnd::kTimeout:
      throw Error(program,
                  "is not done after " + std::to_string(static_cast<int>(time_limit_s)) +
                      " s with " + subject,
                  remedy);
    case ChildEnd::kFailure:
      throw Error(program, "failed with " + subject, remedy);
  }
}

TetMesh read_filled(const SurfaceMesh& surface, const TemporaryFolder& folder,
                    const std::string& program, const std::string& subject) {
  TetMesh mesh = read_tetgen(folder.path() / "surface.1.node");
  if (!surface_is_kept(surface, mesh)) {
    throw Error(program, "did not keep the surface of " + subject, "use TetGen 1.5 or newer");
  }
  mesh.nodes.topRows(surface.nodes.rows()) = surface.nodes;  // undo the rounding of its text files
  return mesh;
}

}  // namespace

TetMesh tetrahedralise(const SurfaceMesh& surface, const std::string& program,
                       double time_limit_s) {
  const TemporaryFolder folder("irdm-tetgen");
  run_tetgen(surface, kFlags, folder, program, time_limit_s, "this box",
             "use fewer cells or cells that are closer to cubes");
  return read_filled(surface, folder, program, "the box");
}

TetMesh fill_surface(const SurfaceMesh& surface, const std::string& name,
                     const std::string& program, double time_limit_s, const std::string& remedy) {
  const double own_edge = mean_edge(surface);
  const bool in_range = own_edge > kSmallestEdge && own_edge < kLargestEdge;
  const double unit = in_range ? 1.0 : std::exp2(std::ilogb(own_edge));  // changes no digit
  const SurfaceMesh scaled{surface.nodes / unit, surface.triangles};
  const double edge = mean_edge(scaled);
  char size[32];  // without an exponent, which the program would take for another flag
  std::snprintf(size, sizeof size, "a%.20f",
                kInnerSize * edge * edge * edge / (6.0 * std::sqrt(2.0)));
  const TemporaryFolder folder("irdm-tetgen");
  run_tetgen(scaled, kFlags + std::string(size), folder, program, time_limit_s, name, remedy);
  TetMesh mesh = read_filled(scaled, folder, program, name);
  mesh.nodes *= unit;
  return mesh;
}

void check_self_intersection(const SurfaceMesh& surface, const std::string& name,
                             const std::string& program, double time_limit_s) {
  const TemporaryFolder folder("irdm-tetgen");
  run_tetgen(surface, "-d", folder, program, time_limit_s, name,
             "repair the surface with the program that made it");
  // The log has "(a, b, c) and (d, e, f)" for each pair, and their number at the end.
  std::ifstream log(folder.path() / "log");
  int node = -1;
  int pairs = 0;
  for (std::string line; std::getline(log, line);) {
    if (node < 0) std::sscanf(line.c_str(), " ( %d,", &node);
    std::sscanf(line.c_str(), "!! Found %d pairs", &pairs);
  }
  if (pairs == 0 && node < 0) return;
  const bool known = node >= 0 && node < surface.nodes.rows();
  throw Error(name,
              "the surface cuts or touches itself: " + std::to_string(pairs) +
                  " pairs of triangles" +
                  (known ? ", for instance at " + place(surface, node) : ""),
              "repair it with the program that made it");
}

}  // namespace irdm::precompute
