#include "precompute/mesh/format/readers.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

// Gmsh's element types: how many nodes, and what the type means to us.
struct ElementType {
  std::int64_t nodes;
  int dimension;
  const char* refused;  // nullptr: tetrahedron or not a volume element
};
const std::unordered_map<std::int64_t, ElementType> element_types{
    {1, {2, 1, nullptr}},      {2, {3, 2, nullptr}},  {3, {4, 2, nullptr}},   {4, {4, 3, nullptr}},
    {5, {8, 3, "hexahedron"}}, {6, {6, 3, "prism"}},  {7, {5, 3, "pyramid"}}, {8, {3, 1, nullptr}},
    {9, {6, 2, nullptr}},      {10, {9, 2, nullptr}}, {11, {10, 3, nullptr}}, {15, {1, 0, nullptr}},
    {16, {8, 2, nullptr}}};
constexpr std::int64_t kLinearTet = 4;
constexpr std::int64_t kQuadraticTet = 11;

constexpr std::array<const char*, 4> kDimensions{"point", "curve", "surface", "volume"};

using Tag = std::pair<std::int64_t, std::int64_t>;  // dimension and number

class GmshReader {
 public:
  explicit GmshReader(const std::filesystem::path& path) : in_(path) {}

  TetMesh read() {
    read_format();
    bool nodes = false;
    bool elements = false;
    while (!in_.at_end()) {
      const std::string section(in_.word());
      // Mesh.SaveParametric names the section of version 2.2 otherwise.
      const bool parametric = section == "$ParametricNodes" && version_ == "2.2";
      if (section == "$Nodes" || parametric) {
        version_ == "2.2" ? read_nodes_2(parametric) : read_nodes_4();
        nodes = true;
      } else if (section == "$Elements") {
        if (!nodes) in_.fail("$Elements comes before $Nodes", "write the mesh again with gmsh");
        version_ == "2.2" ? read_elements_2() : read_elements_4();
        elements = true;
      } else if (section == "$PhysicalNames") {
        read_group_names();
      } else if (section == "$Entities" && version_ == "4.1") {
        read_entities(false);
      } else if (section == "$PartitionedEntities" && version_ == "4.1") {
        read_entities(true);
      } else if (section.starts_with("$")) {
        in_.skip_past("$End" + section.substr(1));
        continue;
      } else {
        in_.fail(in_quotes(section) + " stands where a section should begin",
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
    in_.fail(in_quotes(found) + " stands where " + wanted + " should",
             "write the mesh again with gmsh");
  }

  void read_format() {
    const std::string_view first = in_.word();
    if (first == "$NOD") {
      in_.fail("MSH version 1 is not read", "convert it: gmsh -save FILE -format msh41 -o NEW.msh");
    }
    if (first != "$MeshFormat") {
      in_.fail("is not a Gmsh file", "it should begin with $MeshFormat");
    }
    version_ = std::string(in_.word());
    if (version_ != "2.2" && version_ != "4.1") {
      in_.fail("MSH version " + shortened(version_) + " is not read",
               "save as version 4.1 or 2.2 (gmsh -format msh41)");
    }
    if (in_.integer() != 0) in_.fail("binary MSH files are not read", "save it as ASCII");
    in_.integer();  // size of a number
    expect("$EndMeshFormat");
  }

  void read_group_names() {
    const std::int64_t count = in_.integer(0, kMaxCount, "number of physical names");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t dimension = in_.integer(0, 3, "dimension of a physical group");
      const std::int64_t tag = in_.integer();
      const std::string_view line = in_.rest_of_line();
      const std::size_t begin = line.find('"');
      const std::size_t end = line.rfind('"');
      if (begin == std::string_view::npos || end == begin) {
        in_.fail("the name of a physical group is not in quotes", "write the mesh again with gmsh");
      }
      group_names_[{dimension, std::abs(tag)}] = line.substr(begin + 1, end - begin - 1);
    }
  }

  // Which physical groups each point, curve, surface and volume of the geometry belongs to.
  // Entities of partitions take the place of those that they are parts of.
  void read_entities(bool partitioned) {
    if (partitioned) {
      in_.skip(1);  // number of partitions
      in_.skip(2 * in_.integer(0, kMaxCount, "number of ghost entities"));
    }
    std::array<std::int64_t, 4> counts{};
    for (std::int64_t& count : counts) count = in_.integer(0, kMaxCount, "number of entities");
    for (std::int64_t dimension = 0; dimension < 4; ++dimension) {
      for (std::int64_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        const std::int64_t tag = in_.integer();
        if (partitioned) {
          in_.skip(2);  // the entity that it is a part of
          in_.skip(in_.integer(0, kMaxCount, "number of partitions"));
        }
        in_.skip(dimension == 0 ? 3 : 6);  // bounding box
        const std::int64_t groups = in_.integer(0, kMaxCount, "number of physical groups");
        for (std::int64_t g = 0; g < groups; ++g) {
          entity_groups_[{dimension, tag}].push_back(in_.integer());
        }
        if (dimension > 0) in_.skip(in_.integer(0, kMaxCount, "number of bounding entities"));
      }
    }
  }

  void add_node(std::int64_t tag, double x, double y, double z) {
    if (!number_.try_emplace(tag, static_cast<int>(coordinates_.size())).second) {
      in_.fail("node " + std::to_string(tag) + " is there twice", "write the mesh again with gmsh");
    }
    coordinates_.push_back({x, y, z});
  }

  void read_nodes_2(bool parametric) {
    const std::int64_t count = in_.integer(0, kMaxCount, "number of nodes");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t tag = in_.integer();
      const double x = in_.number();
      const double y = in_.number();
      add_node(tag, x, y, in_.number());
      if (!parametric) continue;
      const std::int64_t dimension = in_.integer(0, 3, "dimension of an entity");
      in_.skip(1);  // entity
      if (dimension < 3) in_.skip(dimension);
    }
  }

  void read_nodes_4() {
    const std::int64_t blocks = in_.integer(0, kMaxCount, "number of node blocks");
    in_.skip(3);  // number of nodes, lowest and highest tag
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.integer(0, 3, "dimension of an entity");
      in_.integer();  // entity
      const bool parametric = in_.integer(0, 1, "parametric flag") == 1;
      const std::int64_t count = in_.integer(0, kMaxCount, "number of nodes");
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
               "make a mesh of tetrahedra");
    }
    if (found->second.refused != nullptr) {
      in_.fail(std::string("there is a ") + found->second.refused, "write tetrahedra alone");
    }
    return found->second;
  }

  int node_number() {
    const std::int64_t tag = in_.integer();
    const auto found = number_.find(tag);
    if (found == number_.end()) {
      in_.fail("node " + std::to_string(tag) + " does not exist", "write the mesh again with gmsh");
    }
    return found->second;
  }

  // The nodes of an element that lies in the given physical groups.
  void read_element(std::int64_t type, const std::vector<std::int64_t>& groups) {
    const ElementType& element = element_type(type);
    const bool is_tet = type == kLinearTet || type == kQuadraticTet;
    if (!is_tet && groups.empty()) return in_.skip(element.nodes);
    std::vector<int> nodes;
    for (std::int64_t i = 0; i < element.nodes; ++i) nodes.push_back(node_number());
    if (type == kQuadraticTet) std::swap(nodes[8], nodes[9]);
    // Version 2.2 has an element once for each of its physical groups.
    const bool again =
        version_ == "2.2" && !groups.empty() && is_tet && !grouped_.insert(nodes).second;
    if (is_tet && !again) add_tet(nodes);
    for (const std::int64_t group : groups) {
      groups_[{element.dimension, std::abs(group)}].push_back(nodes);
    }
  }

  void add_tet(const std::vector<int>& nodes) {
    if (!tets_.empty() && nodes.size() != tets_.front().size()) {
      in_.fail("there are tetrahedra of first and of second order",
               "let one order be that of all (gmsh -order)");
    }
    tets_.push_back(nodes);
  }

  void read_elements_2() {
    const std::int64_t count = in_.integer(0, kMaxCount, "number of elements");
    for (std::int64_t i = 0; i < count; ++i) {
      in_.integer();  // tag
      const std::int64_t type = in_.integer();
      element_type(type);
      const std::int64_t tags = in_.integer(0, 1000, "number of tags");
      std::vector<std::int64_t> groups;  // the first tag is the physical group, 0 for none
      if (tags > 0) groups.push_back(in_.integer());
      if (tags > 0 && groups.front() == 0) groups.clear();
      in_.skip(std::max<std::int64_t>(tags - 1, 0));
      read_element(type, groups);
    }
  }

  void read_elements_4() {
    const std::int64_t blocks = in_.integer(0, kMaxCount, "number of element blocks");
    in_.skip(3);  // number of elements, lowest and highest tag
    for (std::int64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = in_.integer();
      const std::int64_t entity = in_.integer();
      const std::vector<std::int64_t>& groups = entity_groups_[{dimension, entity}];
      const std::int64_t type = in_.integer();
      element_type(type);
      const std::int64_t count = in_.integer(0, kMaxCount, "number of elements");
      for (std::int64_t i = 0; i < count; ++i) {
        in_.integer();  // tag
        read_element(type, groups);
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
    const std::size_t width = tets_.empty() ? 4 : tets_.front().size();
    mesh.tets.resize(static_cast<Eigen::Index>(tets_.size()), static_cast<Eigen::Index>(width));
    for (std::size_t i = 0; i < tets_.size(); ++i) {
      std::copy(tets_[i].begin(), tets_[i].end(),
                mesh.tets.row(static_cast<Eigen::Index>(i)).begin());
    }
    // Numbers and names of physical groups are unique in one dimension only.
    std::map<std::string, int> uses;
    for (const auto& [key, group] : groups_) ++uses[group_name(key)];
    for (const auto& [key, group] : groups_) {
      const std::string name = group_name(key);
      const auto dimension = static_cast<std::size_t>(key.first);
      mesh.groups[uses[name] == 1 ? name : std::string(kDimensions[dimension]) + " " + name] =
          group;
    }
    return mesh;
  }

  std::string group_name(const Tag& key) const {
    const auto named = group_names_.find(key);
    return named == group_names_.end() ? std::to_string(key.second) : named->second;
  }

  TokenReader in_;
  std::string version_;
  std::unordered_map<std::int64_t, int> number_;
  std::vector<std::array<double, 3>> coordinates_;
  std::vector<std::vector<int>> tets_;
  std::set<std::vector<int>> grouped_;  ///< tetrahedra of version 2.2 that are in a group
  std::map<Tag, std::string> group_names_;
  std::map<Tag, std::vector<std::int64_t>> entity_groups_;
  std::map<Tag, MeshGroup> groups_;
};

}  // namespace

TetMesh read_gmsh(const std::filesystem::path& path) {
  return GmshReader(path).read();
}

}  // namespace irdm::precompute
