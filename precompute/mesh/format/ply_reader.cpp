#include "precompute/mesh/format/readers.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "precompute/mesh/format/number_array.hpp"
#include "precompute/mesh/format/surface_builder.hpp"
#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

struct Property {
  std::string name;
  NumberType type;
  std::optional<NumberType> length;  // of a list
};

struct Element {
  std::string name;
  std::int64_t count;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& path) : in_(path) {}

  SurfaceMesh read() {
    read_header();
    if (binary_) in_.bytes(0);  // the end of the header's last line
    for (const Element& element : elements_) {
      for (std::int64_t i = 0; i < element.count; ++i) read_entry(element);
    }
    return surface_.surface();
  }

 private:
  void read_header() {
    if (in_.word() != "ply") in_.fail("is not a PLY file", "it should begin with ply");
    for (std::string word(in_.word()); word != "end_header"; word = in_.word()) {
      if (word == "format") {
        read_format();
      } else if (word == "element") {
        const std::string name(in_.word());
        elements_.push_back({name, in_.integer(0, kMaxCount, "number of elements"), {}});
      } else if (word == "property" && !elements_.empty()) {
        elements_.back().properties.push_back(read_property());
      } else if (word == "comment" || word == "obj_info") {
        in_.rest_of_line();
      } else {
        in_.fail(in_quotes(word) + " is not a line of a PLY header", "write the surface again");
      }
    }
  }

  void read_format() {
    const std::string format(in_.word());
    if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian") {
      in_.fail("format " + in_quotes(format) + " is not known", "write the surface again");
    }
    binary_ = format != "ascii";
    order_ = format == "binary_big_endian" ? std::endian::big : std::endian::little;
    in_.word();  // the version
  }

  NumberType type() {
    const std::string_view word = in_.word();
    const auto found = number_type(word);
    if (!found) in_.fail("numbers of type " + in_quotes(word) + " are not known", "write floats");
    return *found;
  }

  Property read_property() {
    const std::string first(in_.word());
    if (first == "list") {
      const NumberType length = type();
      const NumberType entry = type();
      return {std::string(in_.word()), entry, length};
    }
    const auto found = number_type(first);
    if (!found) in_.fail("numbers of type " + in_quotes(first) + " are not known", "write floats");
    return {std::string(in_.word()), *found, {}};
  }

  double number(NumberType type) {
    return binary_ ? decode_number(in_.more_bytes(size_of(type)), type, order_) : in_.number();
  }

  // A whole number in a range.
  int whole(NumberType type, int highest, const std::string& meaning) {
    const double value = number(type);
    if (!(value >= 0 && value <= highest && value == std::floor(value))) {
      in_.fail(meaning + " is " + std::to_string(value),
               "it must be whole and lie from 0 to " + std::to_string(highest));
    }
    return static_cast<int>(value);
  }

  void read_entry(const Element& element) {
    std::map<std::string, double> values;
    for (const Property& property : element.properties) {
      if (!property.length) {
        values[property.name] = number(property.type);
      } else if (element.name == "face" &&
                 (property.name == "vertex_indices" || property.name == "vertex_index")) {
        read_face(property);
      } else {
        const int count = whole(*property.length, kMaxCount, "length of a list");
        for (int i = 0; i < count; ++i) number(property.type);
      }
    }
    if (element.name != "vertex") return;
    if (!values.contains("x") || !values.contains("y") || !values.contains("z")) {
      in_.fail("a vertex has not x, y and z", "write the surface again");
    }
    surface_.add_node(values["x"], values["y"], values["z"]);
  }

  void read_face(const Property& property) {
    const int count = whole(*property.length, 1000, "number of corners of a face");
    std::vector<int> corners;
    for (int i = 0; i < count; ++i) {
      corners.push_back(whole(property.type, surface_.node_count() - 1, "vertex of a face"));
    }
    surface_.add_polygon(corners);
  }

  TokenReader in_;
  bool binary_ = false;
  std::endian order_ = std::endian::little;
  std::vector<Element> elements_;
  SurfaceBuilder surface_;
};

}  // namespace

SurfaceMesh read_ply(const std::filesystem::path& path) {
  return PlyReader(path).read();
}

}  // namespace irdm::precompute
