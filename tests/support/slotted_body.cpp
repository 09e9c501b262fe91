#include "tests/support/slotted_body.hpp"

#include <map>
#include <sstream>
#include <tuple>
#include <utility>

#include "precompute/compress/compress_model.hpp"
#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/voxel_body.hpp"

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

void write_mesh(const SlottedBody& body, const std::filesystem::path& path) {
  write_voxel_mesh({kCells, [&](const std::array<int, 3>& cell) { return is_solid(body, cell); },
                    [](const std::array<int, 3>& at) -> Vector3 {
                      return kVoxel * Vector3(at[0] - 0.5 * kCells[0], at[1], at[2]);
                    }},
                   path);
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
