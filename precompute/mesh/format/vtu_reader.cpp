#include "precompute/mesh/format/readers.hpp"

#include <algorithm>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <iterator>
#include <sstream>
#include <string>

#include "common/error.hpp"
#include "precompute/mesh/format/number_array.hpp"
#include "precompute/mesh/format/token_reader.hpp"
#include "precompute/mesh/format/vtk_cells.hpp"
#include "precompute/mesh/format/vtu_data.hpp"

namespace irdm::precompute {
namespace {

namespace xml = boost::property_tree;

const std::string kAppended = "<AppendedData";

std::string attribute(const xml::ptree& element, const std::string& key,
                      const std::string& fallback = "") {
  return element.get<std::string>("<xmlattr>." + key, fallback);
}

class VtuReader {
 public:
  explicit VtuReader(const std::filesystem::path& path) : name_(path.string()) {
    std::string text = text_content(path);
    split_appended(text);
    parse(text);
  }

  TetMesh read() {
    read_coding();
    const xml::ptree& piece = only_piece();
    VtkCells cells;
    cells.coordinates = numbers(array(piece, "Points", ""));
    cells.connectivity = numbers(array(piece, "Cells", "connectivity"));
    cells.ends = numbers(array(piece, "Cells", "offsets"));
    cells.types = numbers(array(piece, "Cells", "types"));
    return mesh_of_cells(cells, name_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(name_, what, remedy);
  }

  // The appended data begin after an underscore and may be any bytes, which no parser of XML takes.
  void split_appended(std::string& text) {
    const std::size_t tag = text.find(kAppended);
    if (tag == std::string::npos) return;
    const std::size_t tag_end = text.find('>', tag);
    const std::size_t begin = text.find('_', tag_end);
    const std::size_t end = text.rfind("</AppendedData>");
    if (begin == std::string::npos || end == std::string::npos || end < begin) {
      fail("the appended data end too early", "the file is truncated: write the mesh again");
    }
    const std::string attributes = text.substr(tag, tag_end - tag);
    appended_base64_ = attributes.find("raw") == std::string::npos;
    appended_ = text.substr(begin + 1, end - begin - 1);
    text = text.substr(0, tag) + "</VTKFile>";
  }

  // The parser calls itself for each level, and a file from elsewhere must not exhaust the stack.
  void check_depth(const std::string& text) const {
    constexpr int kDeepest = 64;  // VTK's own files have about six levels
    int depth = 0;
    for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at + 1)) {
      const std::size_t end = std::min(text.find('>', at), text.size() - 1);
      if (text[at + 1] == '/') {
        --depth;
      } else if (text[at + 1] != '?' && text[at + 1] != '!' && text[end - 1] != '/') {
        ++depth;
      }
      if (depth > kDeepest) {
        fail("its elements are nested more than " + std::to_string(kDeepest) + " deep",
             "it is no mesh of VTK: write the mesh again");
      }
    }
  }

  void parse(const std::string& text) {
    check_depth(text);
    std::istringstream stream(text);
    try {
      xml::read_xml(stream, tree_, xml::xml_parser::no_comments);
    } catch (const xml::xml_parser_error& error) {
      throw Error(name_ + ":" + std::to_string(error.line()),
                  "is not well-formed XML (" + shortened(error.message()) + ")",
                  "it is damaged or truncated: write the mesh again");
    }
  }

  void read_coding() {
    const auto root = tree_.get_child_optional("VTKFile");
    if (!root || attribute(*root, "type") != "UnstructuredGrid") {
      fail("is not a VTK file with an unstructured grid",
           "write an unstructured grid of tetrahedra, or a surface as .stl, .obj or .ply");
    }
    coding_.order =
        attribute(*root, "byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
    coding_.header = attribute(*root, "header_type", "UInt32") == "UInt64" ? NumberType::kUInt64
                                                                           : NumberType::kUInt32;
    const std::string compressor = attribute(*root, "compressor");
    coding_.compressed = !compressor.empty();
    if (coding_.compressed && compressor != "vtkZLibDataCompressor") {
      fail("is compressed by " + shortened(compressor), "save it with the compressor ZLib or none");
    }
  }

  const xml::ptree& only_piece() const {
    const auto grid = tree_.get_child_optional("VTKFile.UnstructuredGrid");
    const std::size_t pieces = grid ? grid->count("Piece") : 0;
    if (pieces != 1) {
      fail("has " + std::to_string(pieces) + " pieces", "save the mesh in one piece");
    }
    return grid->get_child("Piece");
  }

  // The array of this name in a section of the piece; the first one when no name is given.
  const xml::ptree& array(const xml::ptree& piece, const std::string& section,
                          const std::string& wanted) const {
    if (const auto parent = piece.get_child_optional(section)) {
      for (const auto& [tag, element] : *parent) {
        if (tag != "DataArray") continue;
        if (wanted.empty() || attribute(element, "Name") == wanted) return element;
      }
    }
    fail("has no array " + section + (wanted.empty() ? "" : " " + wanted), "write the mesh again");
  }

  std::vector<double> numbers(const xml::ptree& element) const {
    const std::string format = attribute(element, "format");
    const std::string array_name = "array " + shortened(attribute(element, "Name", "of points"));
    const auto type = number_type(attribute(element, "type"));
    if (!type) fail(array_name + " has numbers of an unknown type", "write the mesh again");
    try {
      if (format == "ascii") return ascii_numbers(element.data());
      if (format == "binary") return decode_vtu_array(element.data(), true, *type, coding_);
      const std::size_t offset = element.get<std::size_t>("<xmlattr>.offset", appended_.size());
      if (format != "appended" || offset >= appended_.size()) {
        throw std::runtime_error("its data are not where they should be");
      }
      return decode_vtu_array(std::string_view(appended_).substr(offset), appended_base64_, *type,
                              coding_);
    } catch (const std::runtime_error& error) {
      fail(array_name + ": " + error.what(), "the file is damaged: write the mesh again");
    }
  }

  static std::vector<double> ascii_numbers(const std::string& text) {
    std::istringstream stream(text);
    std::vector<double> found{std::istream_iterator<double>(stream), {}};
    if (!stream.eof()) throw std::runtime_error("it has something that is not a number");
    return found;
  }

  std::string name_;
  std::string appended_;
  bool appended_base64_ = true;
  xml::ptree tree_;
  VtuCoding coding_;
};

}  // namespace

TetMesh read_vtu(const std::filesystem::path& path) {
  return VtuReader(path).read();
}

}  // namespace irdm::precompute
