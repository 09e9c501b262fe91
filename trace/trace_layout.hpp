#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/geometry.hpp"
#include "common/hdf5/file.hpp"
#include "trace/trace_writer.hpp"

namespace irdm {

/// The head of a trace file. Throws Error when it is none, or one that cannot be understood.
TraceHeader read_trace_header(const std::filesystem::path& path);

/// What it says of each object, in the scene's order: its models may differ. Throws Error.
std::vector<TraceObject> read_trace_objects(const std::filesystem::path& path,
                                            const std::vector<std::string>& names);

}  // namespace irdm

/// Where things are in a trace file (docs/files.md).
namespace irdm::trace {

/// Of the file and of the step that its forces were found with: 1 was of first order in time.
inline constexpr std::int64_t kVersion = 2;

/// How many steps are whole: a killed server may leave sets that are longer.
inline constexpr const char* kCommitted = "/committed";

/// Whether each object was asleep: not in the trace of a scene in which none can sleep.
inline constexpr const char* kAsleep = "/step/asleep";

/// Contacts of objects with each other and with scenery: none in the trace of a scene without.
inline constexpr const char* kBodyContact = "/body_contact";

inline std::string stylus_path(std::size_t stylus) {
  return "/stylus/" + std::to_string(stylus);
}

inline std::string settings_path(std::size_t object) {
  return "/settings/object/" + std::to_string(object);
}

/// One object's sets are those of the step; several have a group each.
inline std::string object_path(bool several, const std::string& name) {
  return several ? "/object/" + name : "/step";
}

/// Beside the body's sets of one object, within the group of one of several.
inline std::string floor_path(const std::string& object) {
  return object == "/step" ? "/floor" : object + "/floor";
}

}  // namespace irdm::trace

namespace irdm::trace {

/// Unit of a trace's dataset, by the last part of its path; empty: it has none (numbers of things,
/// flags). "1": a number without unit.
std::string unit_of(const std::string& path);

}  // namespace irdm::trace

namespace irdm::trace {

/// The first rows of a set; a set of width 1 is a list. Throws Error.
/// @param wrong said of a set that has another shape, or fewer rows
template <typename T>
std::vector<T> read_rows(const hdf5::File& file, const std::string& set, hsize_t rows,
                         hsize_t width, const char* wrong) {
  const hdf5::Shape shape = file.stored_shape(set);
  const std::string unit = unit_of(set);
  if (!unit.empty()) file.require_text(set, "unit", unit);
  const hdf5::Shape wanted = width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, width};
  if (shape.size() != wanted.size() || shape[0] < rows || (width > 1 && shape[1] != width)) {
    throw Error(file.name(), set + wrong, "record it again");
  }
  std::vector<T> values(rows * width);
  if (rows > 0) file.read_slab<T>(set, hdf5::Shape(wanted.size(), 0), wanted, values.data());
  return values;
}

/// Of the force step [s]. Throws Error.
inline double read_dt(const hdf5::File& file) {
  const double dt = file.read_double_attribute("/", "dt");
  if (!lab::kStepTime.contains(dt)) {
    throw Error(file.name(),
                "has a dt of " + number_text(dt) + " s, not " + describe(lab::kStepTime),
                "record it again");
  }
  return dt;
}

/// Row of a set of width 3.
inline Vector3 vector_of(const std::vector<double>& values, std::size_t row) {
  return Eigen::Map<const Vector3>(values.data() + 3 * row);
}

/// Reads sets of as many rows as the trace has steps.
class RowReader {
 public:
  /// Throws Error when the file has no steps to count.
  /// @param most rows that are read
  explicit RowReader(const hdf5::File& file, hsize_t most = std::numeric_limits<hsize_t>::max())
      : file_(file) {
    const hdf5::Shape steps = file.stored_shape("/step/time");
    if (steps.size() != 1) throw Error(file.name(), "/step/time is no list", "record it again");
    rows_ = steps[0];
    if (file.exists(kCommitted)) {  // not in an older trace
      const std::uint64_t committed = file.read<std::uint64_t>(kCommitted, {1})[0];
      if (committed > rows_) {
        throw Error(file.name(),
                    "says that it has " + std::to_string(committed) + " steps and has " +
                        std::to_string(rows_) + " rows",
                    "record it again");
      }
      rows_ = committed;
    }
    rows_ = std::min(rows_, most);
  }

  hsize_t rows() const { return rows_; }
  /// Throws Error.
  template <typename T>
  std::vector<T> read(const std::string& set, hsize_t width = 1) const {
    return read_rows<T>(file_, set, rows_, width, " does not have a row for each step");
  }

 private:
  const hdf5::File& file_;
  hsize_t rows_ = 0;
};

/// Reads sets with a row for each event: as many rows as all of them have, of steps up to the last
/// one that counts. A server that was killed may leave some that are longer.
class EventReader {
 public:
  /// @param sets with `/force_step`, whose numbers must not decrease
  EventReader(const hdf5::File& file, std::string group, const std::vector<const char*>& sets,
              std::uint64_t last_step)
      : file_(file), group_(std::move(group)), rows_(std::numeric_limits<hsize_t>::max()) {
    for (const char* set : sets) {
      const hdf5::Shape shape = file_.stored_shape(group_ + set);
      rows_ = std::min<hsize_t>(rows_, shape.empty() ? 0 : shape[0]);
    }
    force_step_ = read<std::uint64_t>("/force_step");
    if (!std::is_sorted(force_step_.begin(), force_step_.end())) {
      throw Error(file_.name(), group_ + "/force_step decreases", "record it again");
    }
    force_step_.erase(std::upper_bound(force_step_.begin(), force_step_.end(), last_step),
                      force_step_.end());
    rows_ = force_step_.size();
  }

  hsize_t rows() const { return rows_; }
  const std::vector<std::uint64_t>& force_step() const { return force_step_; }
  /// Throws Error.
  template <typename T>
  std::vector<T> read(const std::string& set, hsize_t width = 1) const {
    return read_rows<T>(file_, group_ + set, rows_, width, " has not the right shape");
  }

 private:
  const hdf5::File& file_;
  std::string group_;
  hsize_t rows_;
  std::vector<std::uint64_t> force_step_;
};

}  // namespace irdm::trace
