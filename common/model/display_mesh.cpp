#include "common/model/display_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/model/model_check.hpp"

namespace irdm {
namespace {

constexpr float kWeightError = 1e-4F;
constexpr float kNormalError = 1e-2F;

bool in_range(const Triangles& indices, Eigen::Index count) {
  return indices.size() == 0 || (indices.minCoeff() >= 0 && indices.maxCoeff() < count);
}

bool weights_hold(const DisplayMesh::Rows3& weights) {
  return weights.allFinite() && weights.minCoeff() >= 0.0F &&
         ((weights.rowwise().sum().array() - 1.0F).abs() < kWeightError).all();
}

bool normals_hold(const DisplayMesh::Rows3& normals) {
  return normals.allFinite() &&
         ((normals.rowwise().norm().array() - 1.0F).abs() < kNormalError).all();
}

template <typename Matrix>
Matrix rows_of(const std::vector<typename Matrix::Scalar>& values) {
  return Eigen::Map<const Matrix>(
      values.data(), static_cast<Eigen::Index>(values.size()) / Matrix::ColsAtCompileTime,
      Matrix::ColsAtCompileTime);
}

}  // namespace

bool is_texture(const std::vector<std::uint8_t>& bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with("\x89PNG\r\n\x1a\n") || text.starts_with("\xff\xd8\xff");
}

std::optional<std::string> display_fault(const DisplayMesh& display, int surface_nodes) {
  const Eigen::Index vertices = display.positions.rows();
  if (display.triangles.rows() == 0) return "/display/triangles is empty";
  if (vertices > DisplayMesh::kMostVertices ||
      display.triangles.rows() > DisplayMesh::kMostTriangles) {
    return "/display has more than " + std::to_string(DisplayMesh::kMostVertices) +
           " vertices or " + std::to_string(DisplayMesh::kMostTriangles) + " triangles";
  }
  if (display.normals.rows() != vertices || display.nodes.rows() != vertices ||
      display.weights.rows() != vertices) {
    return "/display/normals, nodes and weights have not a row for each of positions";
  }
  if (!in_range(display.triangles, vertices)) {
    return "/display/triangles points outside /display/positions";
  }
  if (!in_range(display.nodes, surface_nodes)) {
    return "/display/nodes points outside /mesh/surface_nodes";
  }
  if (!display.positions.allFinite() || display.positions.cwiseAbs().maxCoeff() > 1e6F) {
    return "/display/positions has numbers that are not finite or out of range";
  }
  if (!normals_hold(display.normals)) return "/display/normals are not unit vectors";
  if (!weights_hold(display.weights)) return "/display/weights are negative or do not sum to 1";
  const Eigen::Index coordinates = display.texture_coordinates.rows();
  if ((coordinates != 0 && coordinates != vertices) || !display.texture_coordinates.allFinite()) {
    return "/display/texture_coordinates has not a finite row for each of positions";
  }
  if (display.texture.empty()) return {};
  if (coordinates == 0) return "/display/texture has no texture_coordinates";
  if (display.texture.size() > DisplayMesh::kMostTextureBytes || !is_texture(display.texture)) {
    return "/display/texture is no PNG or JPEG file of at most 16 MiB";
  }
  return {};
}

void write_display(hdf5::File& file, const DisplayMesh& display) {
  const auto vertices = static_cast<hsize_t>(display.positions.rows());
  file.write<float>(kDisplayPositions, {vertices, 3}, display.positions.data());
  file.write<float>(kDisplayNormals, {vertices, 3}, display.normals.data());
  file.write<std::int32_t>(kDisplayTriangles, {static_cast<hsize_t>(display.triangles.rows()), 3},
                           display.triangles.data());
  file.write<std::int32_t>(kDisplayNodes, {vertices, 3}, display.nodes.data());
  file.write<float>(kDisplayWeights, {vertices, 3}, display.weights.data());
  if (display.texture_coordinates.rows() > 0) {
    file.write<float>(kDisplayTextureCoordinates, {vertices, 2},
                      display.texture_coordinates.data());
  }
  if (display.texture.empty()) return;
  file.write<std::uint8_t>(kDisplayTexture, {display.texture.size()}, display.texture.data());
}

DisplayMesh read_display(const hdf5::File& file, int surface_nodes) {
  DisplayMesh display;
  if (!file.exists("/display")) return display;
  display.positions = rows_of<DisplayMesh::Rows3>(file.read<float>(kDisplayPositions, {0, 3}));
  display.normals = rows_of<DisplayMesh::Rows3>(file.read<float>(kDisplayNormals, {0, 3}));
  display.triangles = rows_of<Triangles>(file.read<std::int32_t>(kDisplayTriangles, {0, 3}));
  display.nodes = rows_of<Triangles>(file.read<std::int32_t>(kDisplayNodes, {0, 3}));
  display.weights = rows_of<DisplayMesh::Rows3>(file.read<float>(kDisplayWeights, {0, 3}));
  if (file.exists(kDisplayTextureCoordinates)) {
    display.texture_coordinates =
        rows_of<DisplayMesh::Rows2>(file.read<float>(kDisplayTextureCoordinates, {0, 2}));
  }
  if (file.exists(kDisplayTexture)) {
    display.texture = file.read<std::uint8_t>(kDisplayTexture, {0});
  }
  if (const auto fault = display_fault(display, surface_nodes)) refuse_model(file.name(), *fault);
  return display;
}

}  // namespace irdm
