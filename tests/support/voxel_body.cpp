#include "tests/support/voxel_body.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "common/model/model_file.hpp"
#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {
namespace {

constexpr double kClampedShare = 0.05;  // of the height

}  // namespace

void write_voxel_mesh(const VoxelMesh& mesh, const std::filesystem::path& path) {
  std::map<std::array<int, 3>, int> numbers;
  std::vector<std::array<int, 4>> tets;
  const auto number = [&](const std::array<int, 3>& at) {
    return numbers.emplace(at, static_cast<int>(numbers.size()) + 1).first->second;
  };
  for (int x = 0; x < mesh.cells[0]; ++x) {
    for (int y = 0; y < mesh.cells[1]; ++y) {
      for (int z = 0; z < mesh.cells[2]; ++z) {
        if (mesh.solid && !mesh.solid({x, y, z})) continue;
        std::array<std::size_t, 3> axes{0, 1, 2};
        do {
          std::array<int, 3> at{x, y, z};
          std::array<int, 4> tet{number(at), 0, 0, 0};
          for (std::size_t i = 0; i < 3; ++i) {
            ++at[axes[i]];
            tet[i + 1] = number(at);
          }
          const bool even = axes[1] == (axes[0] + 1) % 3;
          if (!even) std::swap(tet[2], tet[3]);
          tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  std::vector<std::array<int, 3>> corners(numbers.size());
  for (const auto& [at, i] : numbers) corners[static_cast<std::size_t>(i) - 1] = at;
  std::ofstream file(path);
  file.precision(17);
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << corners.size() << "\n";
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 x = mesh.place(corners[i]);
    file << i + 1 << ' ' << x.x() << ' ' << x.y() << ' ' << x.z() << "\n";
  }
  file << "$EndNodes\n$Elements\n" << tets.size() << "\n";
  for (std::size_t t = 0; t < tets.size(); ++t) {
    file << t + 1 << " 4 2 1 1 " << tets[t][0] << ' ' << tets[t][1] << ' ' << tets[t][2] << ' '
         << tets[t][3] << "\n";
  }
  file << "$EndElements\n";
}

std::shared_ptr<const Model> voxel_body(const VoxelMesh& mesh, const VoxelMaterial& material) {
  const TemporaryFolder folder;
  write_voxel_mesh(mesh, folder.path() / "body.msh");
  precompute::PrecomputeConfig config;
  config.name = "voxel body";
  config.mesh.source = folder.path() / "body.msh";
  config.mesh.order = material.order;
  config.material = {material.youngs_modulus, material.poisson_ratio, material.density,
                     material.rayleigh_alpha, material.rayleigh_beta};
  if (material.clamped) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (int x = 0; x <= mesh.cells[0]; ++x) {
      for (int y = 0; y <= mesh.cells[1]; ++y) {
        for (int z = 0; z <= mesh.cells[2]; ++z) {
          lowest = std::min(lowest, mesh.place({x, y, z}).y());
          highest = std::max(highest, mesh.place({x, y, z}).y());
        }
      }
    }
    const double height = lowest + kClampedShare * (highest - lowest);
    config.support = precompute::HalfSpace{Vector3(0, height, 0), Vector3::UnitY()};
  }
  if (material.modes > 0) config.modes.count = material.modes;
  config.response.dt = material.dt;
  config.response.steps = 100;
  config.response.storage = precompute::Storage::kModal;
  std::ostringstream ignored;
  const precompute::Console console{ignored, false};
  const auto path = folder.path() / "body.h5";
  precompute::precompute_model(config, path, console);
  return std::make_shared<const Model>(read_model(path, ResponseKind::kModal));
}

}  // namespace irdm::test
