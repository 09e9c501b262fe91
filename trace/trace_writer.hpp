#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/hdf5/file.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// What a trace says of an object besides its steps.
struct TraceObject {
  std::string name;
  std::string model_file;      ///< name of the model file
  std::string model_checksum;  ///< its SHA-256
};

/// What a trace says of its run besides the steps.
struct TraceHeader {
  std::vector<TraceObject> objects;
  std::string scene;  ///< the scene file's text
  double dt = 0.0;    ///< [s]
  int stylus_count = 1;
  bool floor = false;           ///< the scene has one
  bool bodies = false;          ///< objects can touch each other or scenery (touches_bodies())
  std::vector<int> tools = {};  ///< styluses that lead a tool (tool_styluses())
  bool sleep = false;           ///< objects can sleep
};

/// Writes the trace file of one run (HDF5, format "irdm-trace", docs/files.md). One thread.
/// Large: one private method for each group of datasets.
class TraceWriter {
 public:
  /// Makes the file; one that exists is not overwritten. Throws Error, and leaves no file then.
  TraceWriter(const std::filesystem::path& path, const TraceHeader& header);

  /// Appends steps in their order. Throws Error when they cannot be written, or when the file is no
  /// longer the one that its path names (hdf5::File::require_in_place()); then none of them counts,
  /// and there is nothing more to append. close() keeps those before.
  void append(std::span<const StepRecord> records);
  /// Makes what was appended safe against a kill of this process, and says in the file how many
  /// steps are. Throws Error as append() does.
  void flush();
  /// Completes the file. Throws Error when it cannot be written.
  void close();

 private:
  void write_header(const TraceHeader& header);
  void create_datasets();
  bool several() const { return objects_.size() > 1; }
  std::string object_path(std::size_t object) const;
  void create_object(const std::string& group);
  void create_contact(const std::string& group);
  void append_object(std::span<const StepRecord> records, std::size_t object);
  void append_floor(std::span<const StepRecord> records, std::size_t object);
  void create_settings();
  void create_late();
  void append_late(std::span<const StepRecord> records);
  /// Enters what came late in the rows that it belongs to.
  void correct_applied(std::span<const StepRecord> records);
  void create_bridged();
  void append_bridged(std::span<const StepRecord> records);
  void create_body_contacts();
  void append_body_contacts(std::span<const StepRecord> records);
  /// A set that grows, with its unit.
  template <typename T>
  void create(const std::string& path, const hdf5::Shape& row);
  void append_settings(std::span<const StepRecord> records);
  void append_stylus(std::span<const StepRecord> records, std::size_t stylus);
  void append_tool(std::span<const StepRecord> records, std::size_t stylus);
  template <typename Contact>
  void append_contact(std::span<const StepRecord> records, const std::string& group,
                      const Contact& contact);
  /// Appends one row of `width` numbers a record; `fill` writes a record's row.
  template <typename T, typename Fill>
  void append_rows(const std::string& dataset, std::size_t width,
                   std::span<const StepRecord> records, const Fill& fill);

  /// One of the last steps, whose applied forces may still change.
  struct RecentStep {
    std::uint64_t force_step = 0;
    std::uint64_t row = 0;
    std::array<Quaternion, kMaxObjects> halfway;
    std::array<Vector3, kMaxStyluses> applied;  ///< [N], W
  };

  hdf5::File file_;
  std::vector<TraceObject> objects_;
  int stylus_count_;
  std::vector<int> tools_;
  bool floor_;
  bool bodies_;
  bool sleep_;
  std::uint64_t rows_ = 0;  ///< appended
  std::deque<RecentStep> recent_;
  std::optional<std::uint32_t> settings_change_;  ///< that was written last
};

}  // namespace irdm
