#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "common/process/temporary_files.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {

using namespace precompute;

/// A folder for mesh files, and programs that write them.
struct MeshFiles : TemporaryFolder {
  MeshFiles() : TemporaryFolder("irdm-test-mesh") {}

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name, std::ios::binary) << text;
    return path() / name;
  }
  void run(const std::string& command) const {
    REQUIRE(std::system(("cd '" + path().string() + "' && " + command + " > log 2>&1").c_str()) ==
            0);
  }
};

/// A file of tests/precompute/meshes.
inline std::filesystem::path sample(const std::string& name) {
  return std::filesystem::path(IRDM_SOURCE_DIR "/tests/precompute/meshes") / name;
}

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  CAPTURE(from);
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

inline double volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (int e = 0; e < mesh.tet_count(); ++e) sum += signed_volume(mesh, e);
  return sum;
}

}  // namespace irdm::test
