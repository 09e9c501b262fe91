#include "precompute/mesh/mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

#include "common/error.hpp"
#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/format/token_reader.hpp"
#include "precompute/mesh/gmsh_program.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/shaded_surface.hpp"
#include "precompute/mesh/tetgen_program.hpp"

namespace irdm::precompute {
namespace {

struct Format {
  TetMesh (*read_mesh)(const std::filesystem::path&) = nullptr;
  SurfaceMesh (*read_surface)(const std::filesystem::path&) = nullptr;
};

TetMesh read_geometry(const std::filesystem::path& path) {
  return mesh_geometry(path);
}

std::string extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Both of VTK's formats are found under either name. What is neither is judged by its name.
TetMesh read_any_vtk(const std::filesystem::path& path) {
  const std::string text = text_content(path);
  const std::string begin = text.substr(0, text.find_first_of("\r\n"));
  if (begin.starts_with("<?xml") || begin.starts_with("<VTKFile")) return read_vtu(path);
  if (begin.starts_with("# vtk")) return read_vtk(path);
  return extension(path) == ".vtu" ? read_vtu(path) : read_vtk(path);
}

const std::map<std::string, Format> kFormats{
    {".msh", {.read_mesh = read_gmsh}},     {".node", {.read_mesh = read_tetgen}},
    {".ele", {.read_mesh = read_tetgen}},   {".vtk", {.read_mesh = read_any_vtk}},
    {".vtu", {.read_mesh = read_any_vtk}},  {".mesh", {.read_mesh = read_medit}},
    {".geo", {.read_mesh = read_geometry}}, {".stl", {.read_surface = read_stl}},
    {".obj", {.read_surface = read_obj}},   {".ply", {.read_surface = read_ply}}};

// More tetrahedra than any way to R takes; gmsh would work on them for hours.
constexpr double kMaxTetrahedra = 2e6;

void check_edge_length(const SurfaceMesh& surface, double length, const std::string& name) {
  const double size = diagonal(surface);
  // A regular tetrahedron with edge a has the volume a^3 / (6 sqrt 2).
  const double count = enclosed_volume(surface) * 6.0 * std::sqrt(2.0) / std::pow(length, 3);
  const std::string compared =
      "mesh.edge_length is " + std::to_string(length / size) + " of the size of the body";
  if (length > size) {
    throw Error(name, compared, "make it smaller, or mind mesh.unit: it is given in metres");
  }
  if (count > kMaxTetrahedra) {
    throw Error(name, compared + ": that makes millions of tetrahedra",
                "make it larger, or mind mesh.unit: it is given in metres");
  }
}

TetMesh fill(const SurfaceMesh& raw, const std::string& name, std::optional<double> edge_length) {
  if (!raw.nodes.allFinite()) {
    throw Error(name, "there is a coordinate that is not finite", "write the surface again");
  }
  const SurfaceMesh surface = checked_surface(weld(raw), name);
  check_self_intersection(surface, name);
  if (!edge_length) return fill_surface(surface, name);
  check_edge_length(surface, *edge_length, name);
  return remesh_surface(surface, *edge_length, name);
}

}  // namespace

TetMesh read_mesh_file(const std::filesystem::path& path, std::optional<double> edge_length) {
  const auto found = kFormats.find(extension(path));
  if (found == kFormats.end()) {
    throw Error(path.string(), "mesh format " + in_quotes(extension(path)) + " is not known",
                "give .msh (Gmsh), .node or .ele (TetGen), .vtk, .vtu, .mesh (Medit), a surface "
                "(.stl, .obj, .ply) or a .geo (Gmsh)");
  }
  const Format& format = found->second;
  if (format.read_mesh != nullptr) return format.read_mesh(path);
  return fill(format.read_surface(path), path.string(), edge_length);
}

bool is_surface_file(const std::filesystem::path& path) {
  const auto found = kFormats.find(extension(path));
  return found != kFormats.end() && found->second.read_surface != nullptr;
}

ShadedSurface read_shaded_surface(const std::filesystem::path& path) {
  const std::string format = extension(path);
  if (format != ".obj") return {weld(kFormats.at(format).read_surface(path)), {}, {}};
  ShadedSurface surface = read_shaded_obj(path);
  if (surface.normals.rows() == 0 && surface.texture.rows() == 0) surface.mesh = weld(surface.mesh);
  return surface;
}

}  // namespace irdm::precompute
