#include "precompute/mesh/make_mesh.hpp"

#include "common/error.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/round_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"

namespace irdm::precompute {
namespace {

TetMesh checked(TetMesh mesh, const std::string& name) {
  check_mesh(mesh, name);
  return mesh;
}

MadeMesh linear_mesh(const BoxConfig& box) {
  return {checked(tetrahedralise(box_surface(box.size, box.cells)), "mesh of the box")};
}

// Filled at radius 1, so that the mesh does not depend on the size.
MadeMesh round_mesh(const SurfaceMesh& surface, double radius, const std::string& name) {
  TetMesh mesh = fill_surface(surface, name, "tetgen", 120.0, "use other cells");
  mesh.nodes *= radius;
  return {checked(std::move(mesh), name)};
}

MadeMesh linear_mesh(const SphereConfig& sphere) {
  return round_mesh(sphere_surface(sphere.cells), sphere.radius, "mesh of the sphere");
}

MadeMesh linear_mesh(const CapsuleConfig& capsule) {
  return round_mesh(capsule_surface(capsule.length / capsule.radius, capsule.cells), capsule.radius,
                    "mesh of the capsule");
}

MadeMesh file_mesh(const std::filesystem::path& path, const MeshConfig& config) {
  std::optional<double> edge_length = config.edge_length;
  if (edge_length) *edge_length /= config.unit;
  MadeMesh made{read_mesh_file(path, edge_length)};
  made.unused_nodes = drop_unused_nodes(made.mesh);
  check_mesh(made.mesh, path.string());  // whose places are those of the file
  made.mesh.nodes *= config.unit;
  return made;
}

MadeMesh given_mesh(const MeshConfig& config) {
  if (const auto* box = std::get_if<BoxConfig>(&config.source)) return linear_mesh(*box);
  if (const auto* sphere = std::get_if<SphereConfig>(&config.source)) return linear_mesh(*sphere);
  if (const auto* capsule = std::get_if<CapsuleConfig>(&config.source)) {
    return linear_mesh(*capsule);
  }
  return file_mesh(std::get<std::filesystem::path>(config.source), config);
}

}  // namespace

MadeMesh make_mesh(const MeshConfig& config) {
  MadeMesh made = given_mesh(config);
  if (config.order < made.mesh.order()) {
    throw Error("mesh.order", "is 1 and the file has second-order tetrahedra",
                "set it to 2, or write linear ones (gmsh -order 1)");
  }
  if (config.order > made.mesh.order()) made.mesh = quadratic_mesh(made.mesh);
  return made;
}

}  // namespace irdm::precompute
