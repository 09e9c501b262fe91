#include "precompute/mesh/format/readers.hpp"

#include <charconv>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "precompute/mesh/format/surface_builder.hpp"
#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

const std::set<std::string, std::less<>> kSkippedKeywords{
    "vt", "vn", "vp", "g", "o", "s", "l", "p", "mg", "usemtl", "mtllib", "usemap", "maplib"};

// The vertex of a corner that is written as 3, 3/1, 3//2 or 3/1/2, from 1, or from -1 backwards.
int vertex(const std::string& corner, int count, const TokenReader& in) {
  const std::string text = corner.substr(0, corner.find('/'));
  int number = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  const int node = number < 0 ? count + number : number - 1;
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || node < 0 ||
      node >= count) {
    in.fail("vertex " + in_quotes(text) + " of a face does not exist", "write the surface again");
  }
  return node;
}

void read_face(TokenReader& in, SurfaceBuilder& surface) {
  std::istringstream words{std::string(in.rest_of_line())};
  std::vector<int> corners;
  for (std::string word; words >> word;) corners.push_back(vertex(word, surface.node_count(), in));
  if (corners.size() < 3) in.fail("a face has less than three corners", "write the surface again");
  surface.add_polygon(corners);
}

}  // namespace

SurfaceMesh read_obj(const std::filesystem::path& path) {
  TokenReader in(path, '#');
  SurfaceBuilder surface;
  while (!in.at_end()) {
    const std::string_view keyword = in.word();
    if (keyword == "v") {
      const double x = in.number();
      const double y = in.number();
      surface.add_node(x, y, in.number());
      in.rest_of_line();  // a weight or a colour
    } else if (keyword == "f") {
      read_face(in, surface);
    } else if (kSkippedKeywords.contains(keyword)) {
      in.rest_of_line();
    } else {
      in.fail(in_quotes(keyword) + " stands where v or f should", "write the surface again");
    }
  }
  return surface.surface();
}

}  // namespace irdm::precompute
