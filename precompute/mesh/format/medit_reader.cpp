#include "precompute/mesh/format/readers.hpp"

#include <map>
#include <string>
#include <vector>

#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

// Sections whose elements may form groups: how many vertices each element has.
const std::map<std::string, int> kElements{{"Edges", 2}, {"Triangles", 3}, {"Tetrahedra", 4}};

// Sections that say nothing to us: how many words each of their entries has.
const std::map<std::string, int> kSkipped{{"Quadrilaterals", 5},
                                          {"Corners", 1},
                                          {"Ridges", 1},
                                          {"RequiredVertices", 1},
                                          {"RequiredEdges", 1},
                                          {"RequiredTriangles", 1},
                                          {"RequiredTetrahedra", 1},
                                          {"Normals", 3},
                                          {"NormalAtVertices", 2},
                                          {"NormalAtTriangleVertices", 3},
                                          {"Tangents", 3},
                                          {"TangentAtVertices", 2},
                                          {"TangentAtEdges", 3},
                                          {"SubDomainFromMesh", 4},
                                          {"EdgesP2", 4},
                                          {"TrianglesP2", 7}};

const std::map<std::string, std::string> kRefused{{"Hexahedra", "hexahedra"},
                                                  {"Prisms", "prisms"},
                                                  {"Pyramids", "pyramids"},
                                                  {"TetrahedraP2", "second-order tetrahedra"}};

class MeditReader {
 public:
  explicit MeditReader(const std::filesystem::path& path) : in_(path, '#') {}

  TetMesh read() {
    if (in_.word() != "MeshVersionFormatted") {
      in_.fail("is not a Medit file in ASCII", "it should begin with MeshVersionFormatted");
    }
    in_.integer();
    bool tetrahedra = false;
    while (!in_.at_end()) {
      const std::string section(in_.word());
      if (section == "End") break;
      tetrahedra = tetrahedra || section == "Tetrahedra";
      read_section(section);
    }
    if (!tetrahedra) {
      in_.fail("has no Tetrahedra", "make a volume mesh of linear tetrahedra, or it is truncated");
    }
    mesh_.nodes = Eigen::Map<const Points>(coordinates_.data(), vertex_count(), 3);
    mesh_.tets = Eigen::Map<const RowMatrix<int>>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size()) / 4, 4);
    return std::move(mesh_);
  }

 private:
  Eigen::Index vertex_count() const { return static_cast<Eigen::Index>(coordinates_.size()) / 3; }

  void read_section(const std::string& section) {
    if (section == "Dimension") {
      in_.integer(3, 3, "dimension");
    } else if (section == "Vertices") {
      read_vertices();
    } else if (const auto element = kElements.find(section); element != kElements.end()) {
      read_elements(section, element->second);
    } else if (const auto skipped = kSkipped.find(section); skipped != kSkipped.end()) {
      in_.skip(count() * skipped->second);
    } else if (const auto refused = kRefused.find(section); refused != kRefused.end()) {
      const std::int64_t number = count();
      if (number == 0) return;
      in_.fail("there are " + std::to_string(number) + " " + refused->second,
               "write linear tetrahedra only; mesh.order = 2 makes them quadratic here");
    } else {
      in_.fail(in_quotes(section) + " is not a known section", "write the mesh again");
    }
  }

  std::int64_t count() { return in_.integer(0, kMaxCount, "number of entries"); }

  void add_to_group(const std::string& section, std::int64_t reference, std::vector<int> nodes) {
    if (reference == 0) return;
    std::string name = section + " " + std::to_string(reference);
    name.front() = static_cast<char>(name.front() - 'A' + 'a');
    mesh_.groups[name].push_back(std::move(nodes));
  }

  void read_vertices() {
    const std::int64_t number = count();
    for (int i = 0; i < number; ++i) {
      for (int axis = 0; axis < 3; ++axis) coordinates_.push_back(in_.number());
      add_to_group("Vertices", in_.integer(), {i});
    }
  }

  void read_elements(const std::string& section, int corners) {
    const std::int64_t number = count();
    for (std::int64_t i = 0; i < number; ++i) {
      std::vector<int> nodes;
      for (int k = 0; k < corners; ++k) {
        nodes.push_back(static_cast<int>(in_.integer(1, vertex_count(), "vertex")) - 1);
      }
      if (corners == 4) corners_.insert(corners_.end(), nodes.begin(), nodes.end());
      add_to_group(section, in_.integer(), std::move(nodes));
    }
  }

  TokenReader in_;
  std::vector<double> coordinates_;
  std::vector<int> corners_;
  TetMesh mesh_;
};

}  // namespace

TetMesh read_medit(const std::filesystem::path& path) {
  return MeditReader(path).read();
}

}  // namespace irdm::precompute
