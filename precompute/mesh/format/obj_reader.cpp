#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "precompute/mesh/format/readers.hpp"
#include "precompute/mesh/format/surface_builder.hpp"
#include "precompute/mesh/format/token_reader.hpp"
#include "precompute/mesh/shaded_surface.hpp"

namespace irdm::precompute {
namespace {

const std::set<std::string, std::less<>> kSkippedKeywords{
    "vp", "g", "o", "s", "l", "p", "mg", "usemtl", "mtllib", "usemap", "maplib"};

/// A corner of a face: into vertices, texture coordinates and normals; -1: none.
struct Corner {
  int vertex = -1, texture = -1, normal = -1;
};

/// What an .obj lists, its polygons cut into triangles.
struct ObjContent {
  SurfaceBuilder surface;
  std::vector<Corner> corners;  ///< three a triangle
  std::vector<std::array<double, 2>> texture;
  std::vector<Vector3> normals;
};

// A number from 1, or from -1 backwards.
int index(const std::string& text, int count, const char* what, const TokenReader& in) {
  int number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  const int found = number < 0 ? count + number : number - 1;
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || found < 0 ||
      found >= count) {
    in.fail(std::string(what) + " " + in_quotes(text) + " of a face does not exist",
            "write the surface again");
  }
  return found;
}

// Written as 3, 3/1, 3//2 or 3/1/2. What a mesh does not need of it is not looked at.
Corner read_corner(const std::string& word, const ObjContent& content, bool looks,
                   const TokenReader& in) {
  std::array<std::string, 3> parts;
  std::istringstream text(word);
  for (std::string& part : parts) std::getline(text, part, '/');
  Corner corner;
  corner.vertex = index(parts[0], content.surface.node_count(), "vertex", in);
  if (!looks) return corner;
  if (!parts[1].empty()) {
    corner.texture =
        index(parts[1], static_cast<int>(content.texture.size()), "texture coordinate", in);
  }
  if (!parts[2].empty()) {
    corner.normal = index(parts[2], static_cast<int>(content.normals.size()), "normal", in);
  }
  return corner;
}

void read_face(TokenReader& in, bool looks, ObjContent& content) {
  std::string line(in.rest_of_line());
  while (line.ends_with('\\')) {  // goes on in the next line
    line.pop_back();
    line += ' ';
    line += in.rest_of_line();
  }
  std::istringstream words{line};
  std::vector<Corner> corners;
  for (std::string word; words >> word;) corners.push_back(read_corner(word, content, looks, in));
  if (corners.size() < 3) in.fail("a face has less than three corners", "write the surface again");
  std::vector<int> nodes;
  for (const Corner& corner : corners) nodes.push_back(corner.vertex);
  for (const std::array<int, 3>& triangle : content.surface.add_polygon(nodes)) {
    for (const int i : triangle) content.corners.push_back(corners[static_cast<std::size_t>(i)]);
  }
}

void read_vertex(TokenReader& in, ObjContent& content) {
  const double x = in.number();
  const double y = in.number();
  content.surface.add_node(x, y, in.number());
  in.rest_of_line();  // a weight or a colour
}

void read_normal(TokenReader& in, ObjContent& content) {
  const double x = in.number();
  const double y = in.number();
  content.normals.emplace_back(x, y, in.number());
  in.rest_of_line();
}

// A one-dimensional one has no second number.
void read_texture(TokenReader& in, ObjContent& content) {
  std::istringstream numbers{std::string(in.rest_of_line())};
  std::array<double, 2> place{};
  if (!(numbers >> place[0])) in.fail("a texture coordinate has no number", "write the file again");
  numbers >> place[1];
  content.texture.push_back(place);
}

/// @param looks whether normals and texture coordinates are wanted
ObjContent read_content(const std::filesystem::path& path, bool looks) {
  TokenReader in(path, '#');
  ObjContent content;
  while (!in.at_end()) {
    const std::string_view keyword = in.word();
    if (keyword == "v") {
      read_vertex(in, content);
    } else if (!looks && (keyword == "vn" || keyword == "vt")) {
      in.rest_of_line();
    } else if (keyword == "vn") {
      read_normal(in, content);
    } else if (keyword == "vt") {
      read_texture(in, content);
    } else if (keyword == "f") {
      read_face(in, looks, content);
    } else if (kSkippedKeywords.contains(keyword)) {
      in.rest_of_line();
    } else {
      in.fail(in_quotes(keyword) + " stands where v or f should", "write the surface again");
    }
  }
  return content;
}

bool has_length(const Vector3& normal) {
  return normal.allFinite() && normal.norm() > 0.0;
}

}  // namespace

SurfaceMesh read_obj(const std::filesystem::path& path) {
  return read_content(path, false).surface.surface();
}

ShadedSurface read_shaded_obj(const std::filesystem::path& path) {
  const ObjContent content = read_content(path, true);
  const auto normal = [&](const Corner& corner) -> const Vector3& {
    return content.normals[static_cast<std::size_t>(corner.normal)];
  };
  const auto all = [&](const auto& holds) {
    return std::all_of(content.corners.begin(), content.corners.end(), holds);
  };
  ShadedSurface surface{content.surface.surface(), {}, {}};
  const auto corners = static_cast<Eigen::Index>(content.corners.size());
  if (all([&](const Corner& c) { return c.normal >= 0 && has_length(normal(c)); })) {
    surface.normals.resize(corners, 3);
    for (Eigen::Index i = 0; i < corners; ++i) {
      surface.normals.row(i) =
          normal(content.corners[static_cast<std::size_t>(i)]).normalized().transpose();
    }
  }
  if (all([](const Corner& c) { return c.texture >= 0; })) {
    surface.texture.resize(corners, 2);
    for (Eigen::Index i = 0; i < corners; ++i) {
      const Corner& corner = content.corners[static_cast<std::size_t>(i)];
      const auto& [s, t] = content.texture[static_cast<std::size_t>(corner.texture)];
      surface.texture.row(i) << s, t;
    }
  }
  return surface;
}

}  // namespace irdm::precompute
