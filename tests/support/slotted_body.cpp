#include "tests/support/slotted_body.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "precompute/compress/compress_model.hpp"
#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {
namespace {

constexpr std::array<int, 3> kCells{5, 9, 2};

auto key(const SlottedBody& body) {
  return std::tie(body.closed, body.youngs_modulus, body.dt, body.rayleigh_alpha,
                  body.rayleigh_beta);
}

bool is_solid(const SlottedBody& body, const std::array<int, 3>& cell) {
  const bool end = cell[1] < 2 || (body.closed && cell[1] >= kCells[1] - 2);
  return cell[0] != kCells[0] / 2 || end;
}

// Each cube in six tetrahedra about its diagonal. Gmsh 2.2.
void write_mesh(const SlottedBody& body, const std::filesystem::path& path) {
  std::map<std::array<int, 3>, int> numbers;
  std::vector<std::array<int, 4>> tets;
  const auto number = [&](const std::array<int, 3>& at) {
    return numbers.emplace(at, static_cast<int>(numbers.size()) + 1).first->second;
  };
  for (int x = 0; x < kCells[0]; ++x) {
    for (int y = 0; y < kCells[1]; ++y) {
      for (int z = 0; z < kCells[2]; ++z) {
        if (!is_solid(body, {x, y, z})) continue;
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
  std::vector<std::array<int, 3>> places(numbers.size());
  for (const auto& [at, i] : numbers) places[static_cast<std::size_t>(i) - 1] = at;
  std::ofstream file(path);
  file.precision(17);
  file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << places.size() << "\n";
  for (std::size_t i = 0; i < places.size(); ++i) {
    file << i + 1 << ' ' << kVoxel * (places[i][0] - 0.5 * kCells[0]) << ' '
         << kVoxel * places[i][1] << ' ' << kVoxel * places[i][2] << "\n";
  }
  file << "$EndNodes\n$Elements\n" << tets.size() << "\n";
  for (std::size_t t = 0; t < tets.size(); ++t) {
    file << t + 1 << " 4 2 1 1 " << tets[t][0] << ' ' << tets[t][1] << ' ' << tets[t][2] << ' '
         << tets[t][3] << "\n";
  }
  file << "$EndElements\n";
}

}  // namespace

bool SlottedBody::operator<(const SlottedBody& other) const {
  return key(*this) < key(other);
}

std::shared_ptr<const Model> slotted_body(const SlottedBody& body, ResponseKind kind) {
  static std::map<std::pair<SlottedBody, ResponseKind>, std::shared_ptr<const Model>> made;
  std::shared_ptr<const Model>& model = made[{body, kind}];
  if (model != nullptr) return model;
  const TemporaryFolder folder;
  write_mesh(body, folder.path() / "body.msh");
  precompute::PrecomputeConfig config;
  config.name = "slotted body";
  config.mesh.source = folder.path() / "body.msh";
  config.mesh.order = 1;
  config.material = {body.youngs_modulus, 0.3, 300.0, body.rayleigh_alpha, body.rayleigh_beta};
  config.response.dt = body.dt;
  config.response.steps = 400;
  config.response.storage =
      kind == ResponseKind::kModal ? precompute::Storage::kModal : precompute::Storage::kDense;
  std::ostringstream ignored;
  const precompute::Console console{ignored, false};
  auto path = folder.path() / "body.h5";
  precompute::precompute_model(config, path, console);
  if (kind == ResponseKind::kCompressed) {
    const auto dense = std::exchange(path, folder.path() / "compressed.h5");
    precompute::compress_model(dense, path, folder.path() / "part", {.error = 0.05}, console);
  }
  model = std::make_shared<const Model>(read_model(path, kind));
  return model;
}

int corner_node(const Model& model, const Vector3& point) {
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    if ((model.mesh.rest_position(i) + model.mesh.com_offset - point).norm() < 1e-9) return i;
  }
  return -1;
}

}  // namespace irdm::test
