#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <vector>

#include "common/geometry.hpp"
#include "common/hdf5/file.hpp"

namespace irdm {

/// A surface that is drawn in place of the one that computes, finer than that and bound to it. v
/// vertices, f triangles. A vertex is displaced by the weighted mean of its three surface nodes.
struct DisplayMesh {
  static constexpr int kMostVertices = 200'000;
  static constexpr int kMostTriangles = 400'000;
  static constexpr std::size_t kMostTextureBytes = 16 << 20;

  using Rows2 = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
  using Rows3 = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

  Rows3 positions{};                    ///< (v, 3) at rest [m], B
  Rows3 normals{};                      ///< (v, 3) at rest, outward unit vectors, B
  Triangles triangles{};                ///< (f, 3) vertices, outward
  Triangles nodes{};                    ///< (v, 3) surface node numbers
  Rows3 weights{};                      ///< (v, 3) barycentric, >= 0, sum 1
  Rows2 texture_coordinates{};          ///< (v, 2) from the lower left corner; no rows: none
  std::vector<std::uint8_t> texture{};  ///< a PNG or JPEG file; empty: none

  bool empty() const { return triangles.rows() == 0; }
};

/// Whether bytes begin as those of a PNG or JPEG file do.
bool is_texture(const std::vector<std::uint8_t>& bytes);

/// What is wrong with a display mesh. Nothing: all shapes fit, indices are in range, numbers are
/// finite, weights sum to 1, and nothing is more than its most.
/// @param surface_nodes of the model
std::optional<std::string> display_fault(const DisplayMesh& display, int surface_nodes);

/// Writes or reads the group /display of a model file (docs/files.md). One that is not there is
/// read as an empty one. Throws Error when what is read has a fault.
void write_display(hdf5::File& file, const DisplayMesh& display);
DisplayMesh read_display(const hdf5::File& file, int surface_nodes);

inline constexpr const char* kDisplayPositions = "/display/positions";
inline constexpr const char* kDisplayNormals = "/display/normals";
inline constexpr const char* kDisplayTriangles = "/display/triangles";
inline constexpr const char* kDisplayNodes = "/display/nodes";
inline constexpr const char* kDisplayWeights = "/display/weights";
inline constexpr const char* kDisplayTextureCoordinates = "/display/texture_coordinates";
inline constexpr const char* kDisplayTexture = "/display/texture";

}  // namespace irdm
