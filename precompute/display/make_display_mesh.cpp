#include "precompute/display/make_display_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/surface/surface_tree.hpp"
#include "precompute/display/corner_normals.hpp"
#include "precompute/display/curved_triangle.hpp"
#include "precompute/mesh/format/token_reader.hpp"
#include "precompute/mesh/mesh_config.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/shaded_surface.hpp"

namespace irdm::precompute {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kCreaseAngle = 35.0;  // degrees
constexpr int kMostParts = 16;
constexpr double kMostAway = 0.25;  // of the surface's diagonal

/// Where a vertex hangs on the surface.
struct Binding {
  std::array<int, 3> nodes;
  Vector3 weights;
};

/// A vertex as it is collected.
struct Vertex {
  Vector3 position, normal;
  Eigen::Vector2d texture = Eigen::Vector2d::Zero();
  Binding binding;
};

/// Collects triangles; corners that are alike become one vertex.
class DisplayMeshBuilder {
 public:
  /// @param size of the whole [m]
  DisplayMeshBuilder(double size, bool textured) : cell_(1e-6 * size), textured_(textured) {}

  int add(const Vertex& vertex) {
    const auto [found, is_new] = numbers_.emplace(key(vertex), static_cast<int>(vertices_.size()));
    if (is_new) vertices_.push_back(vertex);
    return found->second;
  }
  void add_triangle(int a, int b, int c) {
    if (a != b && b != c && c != a) corners_.insert(corners_.end(), {a, b, c});
  }

  std::vector<Vertex>& vertices() { return vertices_; }

  DisplayMesh mesh() const {
    DisplayMesh mesh;
    const auto count = static_cast<Eigen::Index>(vertices_.size());
    mesh.positions.resize(count, 3);
    mesh.normals.resize(count, 3);
    mesh.nodes.resize(count, 3);
    mesh.weights.resize(count, 3);
    mesh.texture_coordinates.resize(textured_ ? count : 0, 2);
    for (Eigen::Index v = 0; v < count; ++v) {
      const Vertex& vertex = vertices_[static_cast<std::size_t>(v)];
      mesh.positions.row(v) = vertex.position.cast<float>().transpose();
      mesh.normals.row(v) = vertex.normal.cast<float>().transpose();
      mesh.weights.row(v) = vertex.binding.weights.cast<float>().transpose();
      mesh.nodes.row(v) = Eigen::Map<const Eigen::RowVector3i>(vertex.binding.nodes.data());
      if (textured_) mesh.texture_coordinates.row(v) = vertex.texture.cast<float>().transpose();
    }
    mesh.triangles = Eigen::Map<const Triangles>(corners_.data(),
                                                 static_cast<Eigen::Index>(corners_.size()) / 3, 3);
    return mesh;
  }

 private:
  using Key = std::array<std::int64_t, 8>;
  static constexpr double kNormalCell = 1e-4;
  static constexpr double kTextureCell = 1e-7;

  Key key(const Vertex& vertex) const {
    Key key{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      key[i] = std::llround(vertex.position(axis) / cell_);
      key[3 + i] = std::llround(vertex.normal(axis) / kNormalCell);
      if (i < 2) key[6 + i] = std::llround(vertex.texture(axis) / kTextureCell);
    }
    return key;
  }

  double cell_;
  bool textured_;
  std::vector<Vertex> vertices_;
  std::map<Key, int> numbers_;
  std::vector<int> corners_;
};

SurfaceMesh surface_of(const ModelMesh& mesh) {
  return {mesh.nodes(mesh.surface_nodes, Eigen::all), mesh.triangles};
}

/// Nearest points of the surface that computes.
class Binder {
 public:
  explicit Binder(const ModelMesh& mesh) : mesh_(mesh), tree_(mesh) {}

  /// @param normal of the vertex, unit
  Binding bind(const Vector3& position, const Vector3& normal) {
    guess_ = tree_.closest_triangle(position, guess_);
    if (faces(guess_, normal)) return on(guess_, position);
    return on(nearest_facing(position, normal).value_or(guess_), position);
  }
  Vector3 outward(const Binding& binding) const {
    return area_normal({mesh_.rest_position(binding.nodes[0]),
                        mesh_.rest_position(binding.nodes[1]),
                        mesh_.rest_position(binding.nodes[2])});
  }

 private:
  TriangleCorners corners(int triangle) const {
    const auto corner = [&](int i) { return mesh_.rest_position(mesh_.triangles(triangle, i)); };
    return {corner(0), corner(1), corner(2)};
  }
  bool faces(int triangle, const Vector3& normal) const {
    return area_normal(corners(triangle)).dot(normal) > 0.0;
  }
  Binding on(int triangle, const Vector3& position) const {
    const Barycentric weights = closest_point(corners(triangle), position);
    return {
        {mesh_.triangles(triangle, 0), mesh_.triangles(triangle, 1), mesh_.triangles(triangle, 2)},
        Vector3(weights.data())};
  }
  // Of a wall that is thinner than the vertex is away: the side that it belongs to.
  std::optional<int> nearest_facing(const Vector3& position, const Vector3& normal) const {
    std::optional<int> found;
    double least = std::numeric_limits<double>::infinity();
    for (int t = 0; t < static_cast<int>(mesh_.triangles.rows()); ++t) {
      const TriangleCorners triangle = corners(t);
      if (least_distance2(triangle, position) >= least || !faces(t, normal)) continue;
      const double away =
          (at(triangle, closest_point(triangle, position)) - position).squaredNorm();
      if (away >= least) continue;
      least = away;
      found = t;
    }
    return found;
  }

  const ModelMesh& mesh_;
  SurfaceTree tree_;
  int guess_ = 0;
};

ShadedSurface read_file(const DisplayConfig& config, const ModelMesh& mesh) {
  ShadedSurface surface = read_shaded_surface(*config.file);
  const std::string name = config.file->string();
  if (surface.mesh.triangles.rows() == 0) {
    throw Error(name, "has no triangles", "write the surface again");
  }
  if (surface.mesh.triangles.rows() > DisplayMesh::kMostTriangles) {
    throw Error(name,
                "has " + std::to_string(surface.mesh.triangles.rows()) + " triangles, more than " +
                    std::to_string(DisplayMesh::kMostTriangles),
                "simplify it for display");
  }
  surface.mesh.nodes *= config.unit;
  surface.mesh.nodes.rowwise() -= mesh.com_offset.transpose();
  if (!surface.mesh.nodes.allFinite()) {
    throw Error(name, "has coordinates that are not finite", "write the surface again");
  }
  if (surface.normals.rows() == 0) {
    surface.normals = smooth_shading(surface.mesh, config.crease_angle).normals;
  }
  return surface;
}

// A file's triangles may be turned inward.
void turn_outward(DisplayMesh& display, const Binder& binder) {
  double outward = 0.0;
  for (Eigen::Index t = 0; t < display.triangles.rows(); ++t) {
    const auto corner = [&](int i) -> Vector3 {
      return display.positions.row(display.triangles(t, i)).cast<double>().transpose();
    };
    const Eigen::RowVector3i nodes = display.nodes.row(display.triangles(t, 0));
    const Vector3 surface = binder.outward({{nodes(0), nodes(1), nodes(2)}, Vector3::Zero()});
    outward += area_normal({corner(0), corner(1), corner(2)}).dot(surface.normalized());
  }
  if (outward < 0.0) display.triangles.col(1).swap(display.triangles.col(2));
}

DisplayMesh of_file(const DisplayConfig& config, const ModelMesh& mesh) {
  const ShadedSurface surface = read_file(config, mesh);
  const bool textured = surface.texture.rows() > 0;
  DisplayMeshBuilder builder(diagonal(surface.mesh), textured);
  for (Eigen::Index t = 0; t < surface.mesh.triangles.rows(); ++t) {
    std::array<int, 3> corners{};
    for (int i = 0; i < 3; ++i) {
      Vertex vertex{.position = surface.mesh.nodes.row(surface.mesh.triangles(t, i)).transpose(),
                    .normal = surface.normals.row(3 * t + i).transpose(),
                    .binding = {}};
      if (textured) vertex.texture = surface.texture.row(3 * t + i).transpose();
      corners[static_cast<std::size_t>(i)] = builder.add(vertex);
    }
    builder.add_triangle(corners[0], corners[1], corners[2]);
  }
  Binder binder(mesh);
  for (Vertex& vertex : builder.vertices()) {
    vertex.binding = binder.bind(vertex.position, vertex.normal);
  }
  DisplayMesh display = builder.mesh();
  turn_outward(display, binder);
  return display;
}

/// One triangle of the surface, to be cut into smaller ones.
struct CutTriangle {
  std::array<int, 3> nodes;
  std::array<Vector3, 3> normals;
  CurvedTriangle curve;
};

CutTriangle cut_triangle(const SurfaceMesh& surface, const Shading& shading, Eigen::Index t) {
  std::array<int, 3> nodes{};
  std::array<Vector3, 3> corners, normals;
  std::array<bool, 3> straight{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    nodes[i] = surface.triangles(t, column);
    corners[i] = surface.nodes.row(nodes[i]).transpose();
    normals[i] = shading.normals.row(3 * t + column).transpose();
    straight[i] =
        shading.creases.contains(std::minmax(nodes[i], surface.triangles(t, (column + 1) % 3)));
  }
  return {nodes, normals, CurvedTriangle(corners, normals, straight)};
}

Vertex vertex_on(const CutTriangle& triangle, const Vector3& weights) {
  Vector3 normal = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    normal += weights(static_cast<Eigen::Index>(i)) * triangle.normals[i];
  }
  if (!(normal.norm() > 0.0)) normal = triangle.normals[0];
  return {.position = triangle.curve.at(weights),
          .normal = normal.normalized(),
          .binding = {triangle.nodes, weights}};
}

// Rows of vertices parallel to the edge from the first corner to the second one.
void add_parts(const CutTriangle& triangle, int parts, DisplayMeshBuilder& builder) {
  std::vector<int> below;
  for (int row = 0; row <= parts; ++row) {
    std::vector<int> here;
    for (int i = 0; i <= parts - row; ++i) {
      const Vector3 weights = Vector3(parts - row - i, i, row) / parts;
      here.push_back(builder.add(vertex_on(triangle, weights)));
    }
    for (std::size_t i = 0; i < here.size() && row > 0; ++i) {
      builder.add_triangle(below[i], below[i + 1], here[i]);
      if (i > 0) builder.add_triangle(here[i - 1], below[i], here[i]);
    }
    below = std::move(here);
  }
}

void check_size(Eigen::Index triangles, int parts) {
  if (triangles * parts * parts <= DisplayMesh::kMostTriangles) return;
  const int most = static_cast<int>(
      std::sqrt(static_cast<double>(DisplayMesh::kMostTriangles) / static_cast<double>(triangles)));
  throw Error("display.subdivision",
              "makes more than " + std::to_string(DisplayMesh::kMostTriangles) + " triangles",
              most < 2 ? "leave the table out" : "set it to " + std::to_string(most) + " at most");
}

DisplayMesh subdivided(const DisplayConfig& config, const ModelMesh& mesh) {
  const SurfaceMesh surface = surface_of(mesh);
  check_size(surface.triangles.rows(), config.subdivision);
  const Shading shading = smooth_shading(surface, config.crease_angle);
  DisplayMeshBuilder builder(diagonal(surface), false);
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    add_parts(cut_triangle(surface, shading, t), config.subdivision, builder);
  }
  return builder.mesh();
}

void check_place(const DisplayConfig& config, const DisplayMesh& display, const ModelMesh& mesh) {
  const double away = largest_distance(display, mesh);
  const double size = diagonal(surface_of(mesh));
  if (away <= kMostAway * size) return;
  throw Error(config.file->string(),
              "lies up to " + number_text(away) + " m off the mesh, which is " + number_text(size) +
                  " m large",
              "bring it to the mesh's place and size, or set display.unit");
}

void add_texture(const DisplayConfig& config, DisplayMesh& display) {
  if (!config.texture) return;
  const std::string name = config.texture->string();
  if (display.texture_coordinates.rows() == 0) {
    throw Error(name, "is a texture, and not every corner of display.file has texture coordinates",
                "write them (vt) to an .obj, or leave display.texture out");
  }
  const std::string content = file_content(*config.texture);
  display.texture.assign(content.begin(), content.end());
  if (!is_texture(display.texture) || content.size() > DisplayMesh::kMostTextureBytes) {
    throw Error(name, "is no PNG or JPEG file of at most 16 MiB", "save the picture as one");
  }
}

}  // namespace

DisplayConfig read_display_config(TomlTable table, double unit) {
  DisplayConfig config;
  if (table.has("file") + table.has("subdivision") != 1) {
    table.fail("", "has not exactly one of file and subdivision",
               "give for instance subdivision = 4 or file = \"name.obj\"");
  }
  for (const char* key : {"unit", "texture"}) {
    if (table.has(key) && !table.has("file")) {
      table.fail(key, "belongs to a file", "leave it out, or give file in place of subdivision");
    }
  }
  if (table.has("file")) {
    config.file = table.path("file");
    if (!is_surface_file(*config.file)) {
      table.fail("file", "is no .obj, .stl or .ply", "write the surface in one of these formats");
    }
    config.unit = read_unit(table, unit);
    if (table.has("texture")) config.texture = table.path("texture");
  } else {
    config.subdivision = table.integer("subdivision", 2, kMostParts);
  }
  config.crease_angle = kDegree * table.number("crease_angle", between(0, 180), kCreaseAngle);
  table.finish();
  return config;
}

DisplayMesh make_display_mesh(const DisplayConfig& config, const ModelMesh& mesh) {
  DisplayMesh display = config.file ? of_file(config, mesh) : subdivided(config, mesh);
  if (config.file) check_place(config, display, mesh);
  add_texture(config, display);
  if (const auto fault = display_fault(display, mesh.surface_node_count())) {
    throw Error(config.file ? config.file->string() : "display.subdivision",
                "makes a model whose " + *fault, "use a coarser or simpler surface");
  }
  return display;
}

double largest_distance(const DisplayMesh& display, const ModelMesh& mesh) {
  double largest = 0.0;
  for (Eigen::Index v = 0; v < display.positions.rows(); ++v) {
    Vector3 bound = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      bound += static_cast<double>(display.weights(v, i)) * mesh.rest_position(display.nodes(v, i));
    }
    const Vector3 place = display.positions.row(v).cast<double>().transpose();
    largest = std::max(largest, (place - bound).norm());
  }
  return largest;
}

}  // namespace irdm::precompute
