#include "precompute/mesh/gmsh_program.hpp"

#include <cmath>
#include <fstream>
#include <limits>

#include "common/config/input_file.hpp"
#include "common/error.hpp"
#include "common/process/child_program.hpp"
#include "common/process/temporary_files.hpp"
#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/mesh_check.hpp"

namespace irdm::precompute {
namespace {

constexpr double kMaxVolumeChange = 0.1;  // share of the volume

// Angle of edges that stay: 40 degrees. The patches between them are cut until each has a map into
// the plane (1, 1), and curves are cut nowhere (Pi).
constexpr const char* kRemesh =
    "Merge \"surface.stl\";\n"
    "ClassifySurfaces{40 * Pi / 180, 1, 1, Pi};\n"
    "CreateGeometry;\n"
    "Surface Loop(1) = Surface{:};\n"
    "Volume(1) = {1};\n"
    "Mesh.MeshSizeExtendFromBoundary = 0;\n";

// What gmsh complained of first.
std::string first_error(const std::filesystem::path& log) {
  std::ifstream file(log);
  const std::string mark = "Error   : ";
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(mark)) return line.substr(mark.size());
  }
  return "it does not say why";
}

struct Job {
  std::filesystem::path script;
  std::string name;    // stands for the input in messages
  std::string remedy;  // what to do when gmsh cannot
};

TetMesh run_gmsh(const Job& job, const TemporaryFolder& folder, const std::string& program,
                 double time_limit_s) {
  const std::filesystem::path log = folder.path() / "log";
  const std::filesystem::path output = folder.path() / "mesh.msh";
  const ChildEnd end =
      run_child(program,
                {std::filesystem::absolute(job.script).string(), "-3", "-format", "msh41", "-o",
                 output.string(), "-setnumber", "General.AbortOnError", "2"},
                folder.path(), log, time_limit_s);
  folder.require_space();
  if (end == ChildEnd::kNotFound) {
    throw Error(program, "the program cannot be started", "install the package gmsh");
  }
  if (end == ChildEnd::kTimeout) {
    throw Error(
        job.name,
        program + " is not done after " + std::to_string(static_cast<int>(time_limit_s)) + " s",
        job.remedy);
  }
  if (end == ChildEnd::kFailure) {
    throw Error(job.name, program + " cannot mesh it (" + first_error(log) + ")", job.remedy);
  }
  if (!std::filesystem::exists(output)) {
    throw Error(job.name, program + " made no mesh of it", job.remedy);
  }
  return read_gmsh(output);
}

void write_stl(const SurfaceMesh& surface, const std::filesystem::path& path) {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  file << "solid surface\n";
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    file << "facet normal 0 0 0\nouter loop\n";
    for (int i = 0; i < 3; ++i) {
      file << "vertex " << surface.nodes.row(surface.triangles(t, i)) << '\n';
    }
    file << "endloop\nendfacet\n";
  }
  file << "endsolid surface\n";
  if (!file.flush()) throw Error(path.string(), "cannot be written", "check the space left there");
}

// Very thin triangles, as of marching cubes, lead gmsh to flat tetrahedra.
void check_remeshed(const TetMesh& mesh, const SurfaceMesh& surface, const std::string& name) {
  double volume = 0.0;
  int flat = 0;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    volume += std::abs(signed_volume(mesh, e));
    flat += mean_ratio(mesh, e) > kFlatMeanRatio ? 0 : 1;
  }
  if (flat > 0) {
    throw Error(name,
                "with this mesh.edge_length gmsh makes " + std::to_string(flat) +
                    " flat tetrahedra, mostly because the surface has very thin triangles",
                "give it evenly shaped triangles (isotropic remeshing), or leave "
                "mesh.edge_length out");
  }
  const double change = volume / enclosed_volume(surface) - 1.0;
  if (std::abs(change) > kMaxVolumeChange) {
    throw Error(name,
                "with this mesh.edge_length the body changes its volume by " +
                    std::to_string(std::lround(100.0 * change)) + " %",
                "make mesh.edge_length smaller");
  }
}

}  // namespace

TetMesh mesh_geometry(const std::filesystem::path& script, const std::string& program,
                      double time_limit_s) {
  require_file(script);
  const TemporaryFolder folder("irdm-gmsh");
  return run_gmsh({script, script.string(), "try it with gmsh -3"}, folder, program, time_limit_s);
}

TetMesh remesh_surface(const SurfaceMesh& surface, double edge_length, const std::string& name,
                       const std::string& program, double time_limit_s) {
  const TemporaryFolder folder("irdm-gmsh");
  write_stl(surface, folder.path() / "surface.stl");
  const std::filesystem::path script = folder.path() / "remesh.geo";
  std::ofstream file(script);
  file.precision(std::numeric_limits<double>::max_digits10);
  file << kRemesh << "Mesh.MeshSizeMin = " << edge_length << ";\nMesh.MeshSizeMax = " << edge_length
       << ";\n";
  file.close();
  TetMesh mesh = run_gmsh({script, name,
                           "try another mesh.edge_length, leave it out to keep the surface's own "
                           "triangles, or give a smoother surface"},
                          folder, program, time_limit_s);
  check_remeshed(mesh, surface, name);
  return mesh;
}

}  // namespace irdm::precompute
