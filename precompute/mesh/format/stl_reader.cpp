#include "precompute/mesh/format/readers.hpp"

#include <array>
#include <string>

#include "common/error.hpp"
#include "precompute/mesh/format/number_array.hpp"
#include "precompute/mesh/format/surface_builder.hpp"
#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

constexpr std::size_t kHeader = 80;  // bytes of text, then the number of triangles
constexpr std::size_t kFacet = 50;   // bytes: normal, three corners, two bytes of attributes
constexpr std::size_t kNormal = 12;  // bytes

SurfaceMesh read_binary(std::string_view bytes, std::size_t count) {
  SurfaceBuilder surface;
  for (std::size_t t = 0; t < count; ++t) {
    const std::string_view facet = bytes.substr(kHeader + 4 + t * kFacet + kNormal, 36);
    const auto values = decode_numbers(facet, NumberType::kFloat32, std::endian::little);
    const int first = surface.node_count();
    for (std::size_t i = 0; i < 9; i += 3)
      surface.add_node(values[i], values[i + 1], values[i + 2]);
    surface.add_polygon({first, first + 1, first + 2});
  }
  return surface.surface();
}

void expect(TokenReader& in, std::string_view wanted) {
  const std::string_view found = in.word();
  if (found == wanted) return;
  in.fail(in_quotes(found) + " stands where " + std::string(wanted) + " should",
          "write the surface again");
}

void read_facet(TokenReader& in, SurfaceBuilder& surface) {
  expect(in, "normal");
  in.skip(3);
  expect(in, "outer");
  expect(in, "loop");
  const int first = surface.node_count();
  for (int i = 0; i < 3; ++i) {
    expect(in, "vertex");
    const double x = in.number();
    const double y = in.number();
    surface.add_node(x, y, in.number());
  }
  expect(in, "endloop");
  expect(in, "endfacet");
  surface.add_polygon({first, first + 1, first + 2});
}

SurfaceMesh read_ascii(const std::filesystem::path& path) {
  TokenReader in(path);
  SurfaceBuilder surface;
  while (!in.at_end()) {
    expect(in, "solid");
    in.rest_of_line();  // its name
    std::string word(in.word());
    for (; word == "facet"; word = in.word()) read_facet(in, surface);
    if (word != "endsolid") {
      in.fail(in_quotes(word) + " stands where facet or endsolid should",
              "write the surface again");
    }
    in.rest_of_line();
  }
  return surface.surface();
}

}  // namespace

// A binary file may begin with "solid" as well: its size tells.
SurfaceMesh read_stl(const std::filesystem::path& path) {
  const std::string bytes = file_content(path);
  std::size_t count = 0;
  if (bytes.size() >= kHeader + 4) {
    count = static_cast<std::size_t>(decode_number(std::string_view(bytes).substr(kHeader),
                                                   NumberType::kUInt32, std::endian::little));
    if (bytes.size() == kHeader + 4 + count * kFacet) return read_binary(bytes, count);
  }
  const std::size_t first = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  if (bytes.compare(first, 5, "solid") == 0 && bytes.find('\0') == std::string::npos) {
    return read_ascii(path);
  }
  throw Error(
      path.string(),
      "is no STL file of its size: it would be binary with " + std::to_string(count) + " triangles",
      "it is truncated or damaged: write the surface again");
}

}  // namespace irdm::precompute
