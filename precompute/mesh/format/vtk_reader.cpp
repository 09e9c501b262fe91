#include "precompute/mesh/format/readers.hpp"

#include <string>
#include <vector>

#include "precompute/mesh/format/number_array.hpp"
#include "precompute/mesh/format/token_reader.hpp"
#include "precompute/mesh/format/vtk_cells.hpp"

namespace irdm::precompute {
namespace {

class VtkReader {
 public:
  explicit VtkReader(const std::filesystem::path& path) : name_(path.string()), in_(path) {}

  TetMesh read() {
    read_header();
    bool points = false;
    bool cells = false;
    bool types = false;
    while (!(points && cells && types)) {
      if (in_.at_end()) in_.fail("has no POINTS, CELLS or CELL_TYPES", "it is truncated");
      const std::string keyword(in_.word());
      if (keyword == "POINTS") {
        const std::int64_t count = in_.integer(0, kMaxCount, "number of points");
        cells_.coordinates = numbers(3 * count, type());
        points = true;
      } else if (keyword == "CELLS") {
        newer_ ? read_cells_5() : read_cells();
        cells = true;
      } else if (keyword == "CELL_TYPES") {
        cells_.types = numbers(in_.integer(0, kMaxCount, "number of cells"), NumberType::kInt32);
        types = true;
      } else if (keyword == "FIELD") {
        skip_field();
      } else if (keyword == "METADATA") {
        skip_metadata();
      } else {
        in_.fail(in_quotes(keyword) + " stands where a section should begin",
                 "write the mesh again");
      }
    }
    return mesh_of_cells(cells_, name_);
  }

 private:
  void read_header() {
    const std::string first(in_.rest_of_line());
    const std::string begin = "# vtk DataFile Version ";
    if (!first.starts_with(begin) || first.size() == begin.size()) {
      in_.fail("is not a VTK file", "it should begin with '" + begin + "'");
    }
    newer_ = first[begin.size()] >= '5';
    in_.rest_of_line();  // the title
    const std::string coding(in_.word());
    if (coding != "ASCII" && coding != "BINARY") {
      in_.fail(in_quotes(coding) + " stands where ASCII or BINARY should", "write the mesh again");
    }
    binary_ = coding == "BINARY";
    if (in_.word() != "DATASET") in_.fail("has no DATASET", "write the mesh again");
    const std::string kind(in_.word());
    if (kind != "UNSTRUCTURED_GRID") {
      in_.fail("the data set is " + in_quotes(kind),
               "write an unstructured grid of tetrahedra, or a surface as .stl, .obj or .ply");
    }
  }

  NumberType type() {
    const std::string_view word = in_.word();
    const auto found = number_type(word);
    if (!found) in_.fail("numbers of type " + in_quotes(word) + " are not known", "write doubles");
    return *found;
  }

  std::vector<double> numbers(std::int64_t count, NumberType type) {
    if (binary_) {
      return decode_numbers(in_.bytes(static_cast<std::size_t>(count) * size_of(type)), type,
                            std::endian::big);
    }
    std::vector<double> found;
    for (std::int64_t i = 0; i < count; ++i) found.push_back(in_.number());
    return found;
  }

  // Every cell as the number of its points and these.
  void read_cells() {
    const std::int64_t count = in_.integer(0, kMaxCount, "number of cells");
    const std::vector<double> all =
        numbers(in_.integer(0, kMaxCount, "size of the cells"), NumberType::kInt32);
    std::size_t i = 0;
    for (std::int64_t c = 0; c < count; ++c) {
      if (i >= all.size() || !(all[i] >= 0.0 && all[i] < static_cast<double>(all.size() - i))) {
        in_.fail("the cells have not the size that is said", "write the mesh again");
      }
      const auto points = static_cast<std::size_t>(all[i++]);
      for (std::size_t k = 0; k < points; ++k) cells_.connectivity.push_back(all[i++]);
      cells_.ends.push_back(static_cast<double>(cells_.connectivity.size()));
    }
  }

  // Offsets, one more than there are cells, and the points of all cells.
  void read_cells_5() {
    const std::int64_t offsets = in_.integer(1, kMaxCount, "number of offsets");
    const std::int64_t size = in_.integer(0, kMaxCount, "size of the cells");
    expect("OFFSETS");
    cells_.ends = numbers(offsets, type());
    cells_.ends.erase(cells_.ends.begin());
    expect("CONNECTIVITY");
    cells_.connectivity = numbers(size, type());
  }

  void expect(const std::string& wanted) {
    const std::string_view found = in_.word();
    if (found == wanted) return;
    in_.fail(in_quotes(found) + " stands where " + wanted + " should", "write the mesh again");
  }

  void skip_field() {
    in_.word();  // its name
    const std::int64_t arrays = in_.integer(0, kMaxCount, "number of arrays");
    for (std::int64_t i = 0; i < arrays; ++i) {
      if (in_.word() == "METADATA") {
        skip_metadata();
        in_.word();
      }
      const std::int64_t components = in_.integer(0, 1000, "number of components");
      const std::int64_t count = in_.integer(0, kMaxCount, "number of tuples");
      numbers(components * count, type());
    }
  }

  // Ends with an empty line.
  void skip_metadata() {
    in_.rest_of_line();
    while (!in_.rest_of_line().empty()) {
    }
  }

  std::string name_;
  TokenReader in_;
  bool newer_ = false;  // version 5 stores cells in another way
  bool binary_ = false;
  VtkCells cells_;
};

}  // namespace

TetMesh read_vtk(const std::filesystem::path& path) {
  return VtkReader(path).read();
}

}  // namespace irdm::precompute
