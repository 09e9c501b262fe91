#include "precompute/mesh/format/readers.hpp"

#include <vector>

#include "precompute/mesh/format/token_reader.hpp"

namespace irdm::precompute {
namespace {

struct NodeFile {
  Points nodes;
  std::int64_t first = 0;  // number of the first node: 0 or 1
};

NodeFile read_nodes(const std::filesystem::path& path) {
  TokenReader in(path, '#');
  const std::int64_t count = in.integer(0, kMaxCount, "number of nodes");
  in.integer(3, 3, "dimension");
  const std::int64_t extra =
      in.integer(0, 1000, "number of attributes") + in.integer(0, 1, "marker flag");
  NodeFile file;
  std::vector<double> values;
  for (std::int64_t i = 0; i < count; ++i) {
    if (i == 0) {
      file.first = in.integer(0, 1, "number of the first node");
    } else {
      in.integer(file.first + i, file.first + i, "number of the node");
    }
    for (int axis = 0; axis < 3; ++axis) values.push_back(in.number());
    in.skip(extra);
  }
  file.nodes = Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(count), 3);
  return file;
}

RowMatrix<int> read_tets(const std::filesystem::path& path, const NodeFile& nodes) {
  TokenReader in(path, '#');
  const std::int64_t count = in.integer(0, kMaxCount, "number of tetrahedra");
  if (in.integer(4, 10, "nodes of a tetrahedron") != 4) {
    in.fail("the tetrahedra are of second order",
            "run tetgen without -o2; mesh.order = 2 makes them quadratic here");
  }
  const std::int64_t extra = in.integer(0, 1000, "number of attributes");
  std::vector<int> values;
  for (std::int64_t e = 0; e < count; ++e) {
    in.integer();
    for (int corner = 0; corner < 4; ++corner) {
      const std::int64_t node =
          in.integer(nodes.first, nodes.first + nodes.nodes.rows() - 1, "node of a tetrahedron");
      values.push_back(static_cast<int>(node - nodes.first));
    }
    in.skip(extra);
  }
  return Eigen::Map<const RowMatrix<int>>(values.data(), static_cast<Eigen::Index>(count), 4);
}

}  // namespace

TetMesh read_tetgen(const std::filesystem::path& path) {
  std::filesystem::path node_path = path;
  std::filesystem::path ele_path = path;
  const NodeFile nodes = read_nodes(node_path.replace_extension(".node"));
  return {nodes.nodes, read_tets(ele_path.replace_extension(".ele"), nodes), {}};
}

}  // namespace irdm::precompute
