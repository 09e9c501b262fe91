#include "precompute/mesh/mesh_config.hpp"

#include <cmath>
#include <map>

#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/round_mesh.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMaxCells = 100;
constexpr int kMaxCapsuleRows = 1000;

BoxConfig read_box(TomlTable table) {
  BoxConfig box;
  const std::vector<double> size = table.numbers("size", 3, lab::kLength);
  const std::vector<int> cells = table.integers("cells", 3, 1, kMaxCells);
  for (std::size_t k = 0; k < 3; ++k) {
    box.size(static_cast<Eigen::Index>(k)) = size[k];
    box.cells[k] = cells[k];
  }
  table.finish();
  return box;
}

SphereConfig read_sphere(TomlTable table) {
  SphereConfig sphere;
  sphere.radius = table.number("radius", lab::kLength);
  sphere.cells = table.integer("cells", 2, kMaxCells);
  table.finish();
  return sphere;
}

CapsuleConfig read_capsule(TomlTable table) {
  CapsuleConfig capsule;
  capsule.radius = table.number("radius", lab::kLength);
  capsule.length = table.number("length", lab::kLength);
  capsule.cells = table.integer("cells", 2, kMaxCells);
  if (capsule_rows(capsule.length / capsule.radius, capsule.cells) > kMaxCapsuleRows) {
    table.fail("length", "is more than " + std::to_string(kMaxCapsuleRows) + " cells long",
               "use fewer cells or a larger radius");
  }
  table.finish();
  return capsule;
}

// Of a mesh that is not a file: `unit` and `edge_length` do not belong to it.
void refuse_keys_of_files(TomlTable& table) {
  if (table.has("unit")) {
    table.fail("unit", "belongs to a mesh file", "leave it out: other meshes are given in metres");
  }
  if (table.has("edge_length")) {
    table.fail("edge_length", "belongs to a surface (.stl, .obj, .ply)",
               "leave it out: cells says how fine the mesh is");
  }
}

void read_file(TomlTable& table, MeshConfig& mesh) {
  const std::filesystem::path path = table.path("file");
  if (table.has("edge_length") && !is_surface_file(path)) {
    table.fail("edge_length", "belongs to a surface (.stl, .obj, .ply)",
               "leave it out: this file says its own sizes");
  }
  mesh.source = path;
  mesh.unit = read_unit(table, 1.0);
  if (table.has("edge_length")) mesh.edge_length = table.number("edge_length", lab::kLength);
}

}  // namespace

double read_unit(TomlTable& table, double fallback) {
  static const std::map<std::string, double> words{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
  if (!table.has("unit")) return fallback;
  return words.at(table.choice("unit", {"m", "cm", "mm"}, "m"));
}

MeshConfig read_mesh_config(TomlTable table, int default_order) {
  MeshConfig mesh;
  if (table.has("box") + table.has("sphere") + table.has("capsule") + table.has("file") != 1) {
    table.fail("", "has not exactly one of box, sphere, capsule and file",
               "give for instance box = { size = [..], cells = [..] } or file = \"name\"");
  }
  if (!table.has("file")) refuse_keys_of_files(table);
  if (table.has("box")) mesh.source = read_box(table.table("box"));
  if (table.has("sphere")) mesh.source = read_sphere(table.table("sphere"));
  if (table.has("capsule")) mesh.source = read_capsule(table.table("capsule"));
  if (table.has("file")) read_file(table, mesh);
  mesh.order = table.integer("order", 1, 2, default_order);
  table.finish();
  return mesh;
}

}  // namespace irdm::precompute
