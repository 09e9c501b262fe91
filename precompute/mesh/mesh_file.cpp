#include "precompute/mesh/mesh_file.hpp"

#include <string>

#include "common/error.hpp"
#include "precompute/mesh/gmsh_reader.hpp"
#include "precompute/mesh/tetgen_reader.hpp"

namespace irdm::precompute {

TetMesh read_mesh_file(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".msh") return read_gmsh(path);
  if (extension == ".node" || extension == ".ele") return read_tetgen(path);
  throw Error(path.string(), "mesh format '" + extension + "' is not known",
              "give a .msh (Gmsh), .node or .ele (TetGen) file");
}

}  // namespace irdm::precompute
