#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "common/model/model.hpp"
#include "scene/columns/column_store.hpp"

namespace irdm {

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
