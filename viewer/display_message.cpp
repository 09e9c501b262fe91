#include "viewer/display_message.hpp"

namespace irdm::viewer {
namespace {

constexpr std::uint32_t kTextureFlag = 1;

template <typename Matrix>
void put_rows(Writer& writer, const Matrix& rows) {
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    if constexpr (std::is_integral_v<typename Matrix::Scalar>) {
      writer.put(static_cast<std::uint32_t>(rows.data()[i]));
    } else {
      writer.put(rows.data()[i]);
    }
  }
}

template <typename Matrix>
Matrix get_rows(Reader& reader, std::uint32_t count) {
  reader.expect(count, 4UL * Matrix::ColsAtCompileTime);
  Matrix rows(count, Matrix::ColsAtCompileTime);
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    if constexpr (std::is_integral_v<typename Matrix::Scalar>) {
      rows.data()[i] = static_cast<int>(reader.get<std::uint32_t>());
    } else {
      rows.data()[i] = reader.get_single();
    }
  }
  return rows;
}

}  // namespace

void put_display(Writer& writer, const DisplayMesh& display) {
  const bool textured = display.texture_coordinates.rows() > 0;
  writer.put(static_cast<std::uint32_t>(display.positions.rows()));
  writer.put(static_cast<std::uint32_t>(display.triangles.rows()));
  writer.put(textured ? kTextureFlag : 0U);
  writer.put(static_cast<std::uint32_t>(display.texture.size()));
  put_rows(writer, display.positions);
  put_rows(writer, display.normals);
  put_rows(writer, display.triangles);
  put_rows(writer, display.nodes);
  put_rows(writer, display.weights);
  put_rows(writer, display.texture_coordinates);
  writer.put_text({display.texture.begin(), display.texture.end()});
  writer.align();
}

DisplayMesh get_display(Reader& reader, std::uint32_t nodes) {
  DisplayMesh display;
  const auto vertices = reader.get<std::uint32_t>();
  const auto triangles = reader.get<std::uint32_t>();
  const auto flags = reader.get<std::uint32_t>();
  const auto bytes = reader.get<std::uint32_t>();
  display.positions = get_rows<DisplayMesh::Rows3>(reader, vertices);
  display.normals = get_rows<DisplayMesh::Rows3>(reader, vertices);
  display.triangles = get_rows<Triangles>(reader, triangles);
  display.nodes = get_rows<Triangles>(reader, vertices);
  display.weights = get_rows<DisplayMesh::Rows3>(reader, vertices);
  if ((flags & kTextureFlag) != 0) {
    display.texture_coordinates = get_rows<DisplayMesh::Rows2>(reader, vertices);
  }
  reader.expect(bytes, 1);
  const std::string texture = reader.get_text(bytes);
  display.texture.assign(texture.begin(), texture.end());
  reader.align();
  if (const auto fault = display_fault(display, static_cast<int>(nodes)))
    throw MessageError(*fault);
  return display;
}

}  // namespace irdm::viewer
