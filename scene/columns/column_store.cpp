#include "scene/columns/column_store.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "common/error.hpp"
#include "common/hdf5/handle.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_file.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/scheduling.hpp"

namespace irdm {
namespace {

constexpr int kColumnPollMs = 2;
constexpr std::int64_t kColumnWaitNs = 50'000;
// In which who asked for a column comes for it: some steps.
constexpr std::int64_t kColumnKeptNs = 50'000'000;

}  // namespace

ColumnStore::ColumnStore(std::vector<Vector3> places, Reader reader, const Settings& settings,
                         std::string name)
    : places_(std::move(places)),
      reader_(std::move(reader)),
      settings_(settings),
      name_(std::move(name)),
      memory_(std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(settings.slots) *
                                                          settings.slot_bytes)),
      slots_(static_cast<std::size_t>(settings.slots)),
      nodes_(places_.size()) {}

ColumnStore::~ColumnStore() {
  finish();
}

void ColumnStore::start(bool beside_real_time) {
  thread_ = std::thread([this, beside_real_time] { run(beside_real_time); });
}

void ColumnStore::finish() {
  stopped_.store(true, std::memory_order_relaxed);
  if (!thread_.joinable()) return;
  news_.signal();
  thread_.join();
}

int ColumnStore::share() const noexcept {
  return settings_.waits ? std::max(1, slots() / kEngines) : slots();
}

// A slot may be given to another node between the look at its number and the exchange.
const void* ColumnStore::try_take(int node) noexcept {
  const int slot = slot_of(node);
  if (slot < 0) return nullptr;
  Slot& held = slots_[static_cast<std::size_t>(slot)];
  int users = held.users.load(std::memory_order_relaxed);
  while (users >= 0) {
    if (!held.users.compare_exchange_weak(users, users + 1, std::memory_order_acquire)) continue;
    if (held.node.load(std::memory_order_relaxed) == node) return data(slot);
    held.users.fetch_sub(1, std::memory_order_release);
    break;
  }
  return nullptr;
}

const void* ColumnStore::acquire(int node) noexcept {
  Node& wanted = nodes_[static_cast<std::size_t>(node)];
  while (true) {
    if (const void* columns = try_take(node)) return columns;
    if (wanted.failed.load(std::memory_order_relaxed)) return nullptr;
    wanted.asked.store(true, std::memory_order_relaxed);
    if (!settings_.waits || stopped_.load(std::memory_order_relaxed)) return nullptr;
    news_.signal();
    sleep_until(monotonic_ns() + kColumnWaitNs);
  }
}

void ColumnStore::release(int node) noexcept {
  slots_[static_cast<std::size_t>(slot_of(node))].users.fetch_sub(1, std::memory_order_release);
}

void ColumnStore::prefetch(std::span<const Vector3> tips) noexcept {
  Tips& next = tips_.back();
  next.count = std::min(tips.size(), next.place.size());
  std::copy_n(tips.begin(), next.count, next.place.begin());
  tips_.publish();
}

void ColumnStore::run(bool beside_real_time) noexcept {
  ::pthread_setname_np(::pthread_self(), "columns");
  if (beside_real_time) spare_last_cpu();
  while (!stopped_.load(std::memory_order_relaxed)) {
    look();
    if (!load_next()) news_.wait(kColumnPollMs);
  }
}

// Who asks goes on asking: what nobody asked for since the last look is not wanted any more.
void ColumnStore::look() noexcept {
  for (Node& node : nodes_) {
    node.wanted = node.asked.load(std::memory_order_relaxed);
    if (node.wanted) node.asked.store(false, std::memory_order_relaxed);
  }
  if (!tips_.receive()) return;
  const Tips& tips = tips_.front();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    double nearest = tips.count == 0 ? 0.0 : std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < tips.count; ++t) {
      nearest = std::min(nearest, (places_[i] - tips.place[t]).squaredNorm());
    }
    nodes_[i].distance = static_cast<float>(nearest);
  }
}

int ColumnStore::most_wanted() const noexcept {
  int best = -1;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (node.slot.load(std::memory_order_relaxed) >= 0) continue;
    if (node.failed.load(std::memory_order_relaxed)) continue;
    const Node* other = best < 0 ? nullptr : &nodes_[static_cast<std::size_t>(best)];
    if (other == nullptr || (node.wanted && !other->wanted) ||
        (node.wanted == other->wanted && node.distance < other->distance)) {
      best = static_cast<int>(i);
    }
  }
  return best;
}

// An empty one, or that of the farthest node that nobody has taken, if it is farther than this one
// or this one is asked for. -1: none.
int ColumnStore::free_slot_for(int node) noexcept {
  const Node& next = nodes_[static_cast<std::size_t>(node)];
  const std::int64_t now_ns = monotonic_ns();
  int victim = -1;
  float farthest = next.wanted ? -1.0F : next.distance;
  for (std::size_t s = 0; s < slots_.size(); ++s) {
    const int held = slots_[s].node.load(std::memory_order_relaxed);
    if (held < 0) return static_cast<int>(s);
    const float distance = nodes_[static_cast<std::size_t>(held)].distance;
    if (slots_[s].users.load(std::memory_order_relaxed) != 0 || distance <= farthest) continue;
    if (now_ns < slots_[s].kept_until_ns) continue;
    farthest = distance;
    victim = static_cast<int>(s);
  }
  if (victim < 0) return -1;
  Slot& slot = slots_[static_cast<std::size_t>(victim)];
  int unused = 0;
  if (!slot.users.compare_exchange_strong(unused, kLoading, std::memory_order_acquire)) return -1;
  nodes_[static_cast<std::size_t>(slot.node.load(std::memory_order_relaxed))].slot.store(
      -1, std::memory_order_relaxed);
  slot.node.store(-1, std::memory_order_relaxed);
  return victim;
}

bool ColumnStore::load_next() noexcept {
  const int node = most_wanted();
  if (node < 0) return false;
  const int slot = free_slot_for(node);
  if (slot < 0) return false;
  if (!read(node, slot)) return true;
  Slot& filled = slots_[static_cast<std::size_t>(slot)];
  filled.node.store(node, std::memory_order_relaxed);
  const bool asked = nodes_[static_cast<std::size_t>(node)].wanted;
  filled.kept_until_ns = asked ? monotonic_ns() + kColumnKeptNs : 0;
  filled.users.store(0, std::memory_order_release);
  nodes_[static_cast<std::size_t>(node)].slot.store(slot, std::memory_order_release);
  loaded_.fetch_add(1, std::memory_order_relaxed);
  return true;
}

// What cannot be read once is not tried again: its forces get the static answer.
bool ColumnStore::read(int node, int slot) noexcept {
  try {
    reader_(node, data(slot));
    return true;
  } catch (const std::exception& error) {
    if (failed_count_.fetch_add(1, std::memory_order_relaxed) == 0) {
      spdlog::error("columns of {} cannot be read, forces there get the static answer: {}", name_,
                    error.what());
    }
    nodes_[static_cast<std::size_t>(node)].failed.store(true, std::memory_order_relaxed);
    return false;
  }
}

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

namespace {

Model read_locked(const std::filesystem::path& path) {
  const std::lock_guard lock(hdf5::library_mutex());
  return read_streamed_model(path);
}

}  // namespace

Model SceneColumns::read(const std::filesystem::path& path, std::size_t budget) {
  Model model = read_locked(path);
  if (is_rigid(model)) return model;
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
