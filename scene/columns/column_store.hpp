#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/model/model.hpp"
#include "common/realtime/event_fd.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// Columns of one model's R, of as many nodes as there are slots for, and a thread that reads them:
/// first those that engines ask for, then those near the tips. All memory is taken at construction.
///
/// Who owns a slot: the loader, until the columns are whole in it; from then on everybody who has
/// taken them, each counted, and again the loader when nobody has them any more. Taking and giving
/// back are an exchange or two of atomic numbers and never wait for the loader, but in lockstep.
class ColumnStore final : public ColumnSupply {
 public:
  /// Reads the columns of a node into a slot of slot_bytes. Throws Error. The loader's thread only.
  using Reader = std::function<void(int node, void* to)>;

  struct Settings {
    std::size_t slot_bytes = 0;
    int slots = 0;  ///< at least one, no more than nodes
    /// Lockstep: acquire() waits for the disk, and each engine may have only as many columns as are
    /// left to it whatever the others have, so that what comes of it does not depend on time.
    bool waits = false;
  };
  /// Engines that may share a store: force step, deformation, player.
  static constexpr int kEngines = 3;

  /// @param places of the surface nodes at rest [m], B
  /// @param name of the file, for messages
  ColumnStore(std::vector<Vector3> places, Reader reader, const Settings& settings,
              std::string name);
  ~ColumnStore() override;

  /// Begins to read. From here on whoever else uses HDF5 holds hdf5::library_mutex().
  /// @param beside_real_time leave a processor to the real-time threads
  void start(bool beside_real_time = false);
  /// Nothing is read any more; who waits gets nothing.
  void finish();

  const void* acquire(int node) noexcept override;
  void release(int node) noexcept override;
  int share() const noexcept override;
  void prefetch(std::span<const Vector3> tips) noexcept override;

  /// Nodes whose columns have been read, and whose cannot be; any thread.
  std::uint64_t loaded() const noexcept { return loaded_.load(std::memory_order_relaxed); }
  std::uint64_t failed() const noexcept { return failed_count_.load(std::memory_order_relaxed); }
  /// Whether a node's columns are there now; any thread.
  bool has(int node) const noexcept { return slot_of(node) >= 0; }
  int slots() const noexcept { return static_cast<int>(slots_.size()); }

 private:
  struct Tips {
    std::array<Vector3, kMaxStyluses> place;
    std::size_t count = 0;
  };
  struct Slot {
    std::atomic<int> users{kLoading};  ///< who has taken it; or the loader
    std::atomic<int> node{-1};
    std::int64_t kept_until_ns = 0;  ///< for whoever asked for it; the loader's
  };
  struct Node {
    std::atomic<int> slot{-1};
    std::atomic<bool> asked{false};
    std::atomic<bool> failed{false};
    float distance = 0.0F;  ///< to the nearest tip, squared; the loader's
    bool wanted = false;    ///< asked for since the loader last looked; the loader's
  };
  static constexpr int kLoading = -1;

  std::byte* data(int slot) noexcept {
    return memory_.get() + static_cast<std::size_t>(slot) * settings_.slot_bytes;
  }
  int slot_of(int node) const noexcept {
    return nodes_[static_cast<std::size_t>(node)].slot.load(std::memory_order_acquire);
  }
  const void* try_take(int node) noexcept;
  void run(bool beside_real_time) noexcept;
  void look() noexcept;
  bool load_next() noexcept;
  int most_wanted() const noexcept;
  int free_slot_for(int node) noexcept;
  bool read(int node, int slot) noexcept;

  std::vector<Vector3> places_;
  Reader reader_;
  Settings settings_;
  std::string name_;
  std::unique_ptr<std::byte[]> memory_;
  std::vector<Slot> slots_;
  std::vector<Node> nodes_;
  TripleBuffer<Tips> tips_;
  std::atomic<std::uint64_t> loaded_{0};
  std::atomic<std::uint64_t> failed_count_{0};
  std::atomic<bool> stopped_{false};
  EventFd news_;  ///< in lockstep: a column is waited for; and the end
  std::thread thread_;
};

/// The models of a scene whose dense responses are served from their files.
class SceneColumns {
 public:
  /// @param waits in lockstep: whoever needs a column waits for it
  explicit SceneColumns(bool waits) : waits_(waits) {}
  ~SceneColumns() { finish(); }
  SceneColumns(const SceneColumns&) = delete;
  SceneColumns& operator=(const SceneColumns&) = delete;

  /// Reads the file once for what is always in memory, and takes memory for columns. Throws Error,
  /// also where the budget is too small.
  /// @param budget of all that the response takes in memory [bytes]
  Model read(const std::filesystem::path& path, std::size_t budget);

  /// When all files that others read at start-up have been read (ColumnStore::start).
  void start(bool beside_real_time);
  /// After all threads that step these models.
  void finish();

  bool any() const noexcept { return !stores_.empty(); }
  std::uint64_t loaded() const noexcept;
  std::uint64_t failed() const noexcept;

 private:
  bool waits_;
  std::vector<std::shared_ptr<ColumnStore>> stores_;
};

}  // namespace irdm
