#include "precompute/mesh/gmsh_reader.hpp"

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "precompute/mesh/token_reader.hpp"

namespace irdm::precompute {
namespace {

constexpr std::int64_t kMany = 100'000'000;  // bound of every count in a file

// Gmsh's element types: how many nodes, and what the type means to us.
struct ElementType {
  std::int64_t nodes;
  const char* refused;  // nullptr: linear tetrahedron or not a volume element
};
const std::unordered_map<std::int64_t, ElementType> element_types{
    {1, {2, nullptr}},
    {2, {3, nullptr}},
    {3, {4, nullptr}},
    {4, {4, nullptr}},
    {5, {8, "hexahedron"}},
    {6, {6, "prism"}},
    {7, {5, "pyramid"}},
    {8, {3, nullptr}},
    {9, {6, nullptr}},
    {10, {9, nullptr}},
    {11, {10, "second-order tetrahedron"}},
    {15, {1, nullptr}},
    {16, {8, nullptr}}};
constexpr std::int64_t kLinearTet = 4;

class GmshReader {
 public:
  explicit GmshReader(const std::filesystem::path& path) : in_(path) {}

  TetMesh read() {
    read_format();
    bool nodes = false;
    bool elements = false;
    while (!in_.at_end()) {
      const std::string section(in_.word());
      if (section == "$Nodes") {
        version_ == "2.2" ? read_nodes_2() : read_nodes_4();
        nodes = true;
      } else if (section == "$Elements") {
        if (!nodes) in_.fail("$Elements comes before $Nodes", "write the mesh again with gmsh");
        version_ == "2.2" ? read_elements_2() : read_elements_4();
        elements = true;
      } else if (section.starts_with("$")) {
        in_.skip_past("$End" + section.substr(1));
        continue;
      } else {
        in_.fail("'" + section.substr(0, 40) + "' stands where a section should begin",
                 "write the mesh again with gmsh");
      }
      expect("$End" + section.substr(1));
    }
    if (!nodes || !elements) in_.fail("has no $Nodes or no $Elements", "it is truncated");
    return mesh();
  }

 private:
  void expect(const std::string& wanted) {
    const std::string found(in_.word());
    if (found == wanted) return;
    in_.fail("'" + found.substr(0, 40) + "' stands where " + wanted + " should",
             "write the mesh again with gmsh");
  }

  void read_format() {
    if (in_.word() != "$MeshFormat") {
      in_.fail("is not a Gmsh file", "it should begin with $MeshFormat");
    }
    version_ = std::string(in_.word());
    if (version_ != "2.2" && version_ != "4.1") {
      in_.fail("MSH version " + version_.substr(0, 40) + " is not read",
               "save as version 4.1 or 2.2 (gmsh -format msh41)");
    }
    if (in_.integer() != 0) in_.fail("binary MSH files are not read", "save it as ASCII");
    in_.integer();  // size of a number
    expect("$EndMeshFormat");
  }

  void add_node(std::int64_t tag, double x, double y, double z) {
    if (!number_.try_emplace(tag, static_cast<int>(coordinates_.size())).second) {
      in_.fail("node " + std::to_string(tag) + " is there twice", "write the mesh again with gmsh");
    }
    coordinates_.push_back({x, y, z});
  }

  void read_nodes_2() {
    const std::int64_t count = in_.integer(0, kMany, "number of nodes");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t tag = in_.integer();
      const double x = in_.number();
      const double y = in_.number();
      add_node(tag, x, y, in_.number());
    }
  }

  void read_nodes_4() {
    const std::int64_t blocks = in_.integer(0, kMany, "number of node blocks");
    in_.skip(3);  // number of nodes, lowest and highest tag
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.integer(0, 3, "dimension of an entity");
      in_.integer();  // entity
      const bool parametric = in_.integer(0, 1, "parametric flag") == 1;
      const std::int64_t count = in_.integer(0, kMany, "number of nodes");
      std::vector<std::int64_t> tags;
      for (std::int64_t i = 0; i < count; ++i) tags.push_back(in_.integer());
      for (const std::int64_t tag : tags) {
        const double x = in_.number();
        const double y = in_.number();
        add_node(tag, x, y, in_.number());
        if (parametric) in_.skip(dimension);
      }
    }
  }

  const ElementType& element_type(std::int64_t type) {
    const auto found = element_types.find(type);
    if (found == element_types.end()) {
      in_.fail("element type " + std::to_string(type) + " is not known",
               "make a mesh of linear tetrahedra");
    }
    if (found->second.refused != nullptr) {
      in_.fail(std::string("there is a ") + found->second.refused,
               "write linear tetrahedra (gmsh -order 1); mesh.order = 2 makes them quadratic here");
    }
    return found->second;
  }

  void read_element(std::int64_t type, std::int64_t nodes) {
    if (type != kLinearTet) return in_.skip(nodes);
    std::array<int, 4> tet{};
    for (int& corner : tet) {
      const std::int64_t tag = in_.integer();
      const auto found = number_.find(tag);
      if (found == number_.end()) {
        in_.fail("node " + std::to_string(tag) + " does not exist",
                 "write the mesh again with gmsh");
      }
      corner = found->second;
    }
    tets_.push_back(tet);
  }

  void read_elements_2() {
    const std::int64_t count = in_.integer(0, kMany, "number of elements");
    for (std::int64_t i = 0; i < count; ++i) {
      in_.integer();  // tag
      const std::int64_t type = in_.integer();
      const std::int64_t nodes = element_type(type).nodes;
      in_.skip(in_.integer(0, 1000, "number of tags"));
      read_element(type, nodes);
    }
  }

  void read_elements_4() {
    const std::int64_t blocks = in_.integer(0, kMany, "number of element blocks");
    in_.skip(3);  // number of elements, lowest and highest tag
    for (std::int64_t b = 0; b < blocks; ++b) {
      in_.skip(2);  // dimension and entity
      const std::int64_t type = in_.integer();
      const std::int64_t nodes = element_type(type).nodes;
      const std::int64_t count = in_.integer(0, kMany, "number of elements");
      for (std::int64_t i = 0; i < count; ++i) {
        in_.integer();  // tag
        read_element(type, nodes);
      }
    }
  }

  TetMesh mesh() const {
    TetMesh mesh;
    mesh.nodes.resize(static_cast<Eigen::Index>(coordinates_.size()), 3);
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const auto& [x, y, z] = coordinates_[i];
      mesh.nodes.row(static_cast<Eigen::Index>(i)) << x, y, z;
    }
    mesh.tets.resize(static_cast<Eigen::Index>(tets_.size()), 4);
    for (std::size_t i = 0; i < tets_.size(); ++i) {
      const auto& [a, b, c, d] = tets_[i];
      mesh.tets.row(static_cast<Eigen::Index>(i)) << a, b, c, d;
    }
    return mesh;
  }

  TokenReader in_;
  std::string version_;
  std::unordered_map<std::int64_t, int> number_;
  std::vector<std::array<double, 3>> coordinates_;
  std::vector<std::array<int, 4>> tets_;
};

}  // namespace

TetMesh read_gmsh(const std::filesystem::path& path) {
  return GmshReader(path).read();
}

}  // namespace irdm::precompute
