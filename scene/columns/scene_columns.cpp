#include "scene/columns/scene_columns.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_file.hpp"

namespace irdm {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;
/// Nodes, so that a fingertip finds room: fewer would be a static object.
constexpr std::size_t kFewestSlots = 12;

std::string in_mebibytes(std::size_t bytes) {
  return std::to_string(std::llround(std::ceil(static_cast<double>(bytes) / kMebibyte)));
}

int slots_within(const std::filesystem::path& path, const StreamedResponse& response,
                 std::size_t slot_bytes, std::size_t budget) {
  const auto nodes = static_cast<std::size_t>(response.degrees_of_freedom / 3);
  const std::size_t resident = resident_bytes(response) + slot_bytes / 3;  // and the reader's own
  const std::size_t fewest = std::min(nodes, kFewestSlots);
  const std::size_t least = resident + fewest * slot_bytes;
  if (budget < least) {
    throw Error(path.string(),
                "memory_budget of " + in_mebibytes(budget) +
                    " MiB is too small: what is always in memory and the columns of " +
                    std::to_string(fewest) + " nodes need " + in_mebibytes(least) + " MiB",
                "raise it, or make R small with irdm-precompute compress");
  }
  return static_cast<int>(std::min(nodes, (budget - resident) / slot_bytes));
}

}  // namespace

Model SceneColumns::read(const std::filesystem::path& path, std::size_t budget) {
  Model model = read_streamed_model(path);
  auto& response = std::get<StreamedResponse>(model.response);
  const std::size_t slot_bytes = 3 * static_cast<std::size_t>(response.degrees_of_freedom) *
                                 static_cast<std::size_t>(response.steps) * number_size(response);
  const int slots = slots_within(path, response, slot_bytes, budget);
  std::vector<Vector3> places;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    places.push_back(model.mesh.rest_position(i));
  }
  const auto file = std::make_shared<DenseColumnFile>(path, response);
  stores_.push_back(std::make_shared<ColumnStore>(
      std::move(places), [file](int node, void* to) { file->read(node, to); },
      ColumnStore::Settings{slot_bytes, slots, waits_}, path.filename().string()));
  response.columns = stores_.back();
  return model;
}

void SceneColumns::start(bool beside_real_time) {
  for (const auto& store : stores_) store->start(beside_real_time);
}

void SceneColumns::finish() {
  for (const auto& store : stores_) store->finish();
}

std::uint64_t SceneColumns::loaded() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& store : stores_) sum += store->loaded();
  return sum;
}

std::uint64_t SceneColumns::failed() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& store : stores_) sum += store->failed();
  return sum;
}

}  // namespace irdm
