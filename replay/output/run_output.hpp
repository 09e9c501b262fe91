#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "common/hdf5/file.hpp"
#include "replay/output/output_file.hpp"
#include "replay/traced_scene.hpp"
#include "simulation/step/step_record.hpp"

/// Where things are in a run file (docs/files.md).
namespace irdm::replay::run {

inline constexpr const char* kFormat = "irdm-run";
inline constexpr int kVersion = 1;

inline std::string object_path(std::size_t object) {
  return "/object/" + std::to_string(object);
}

inline std::string stylus_path(std::size_t stylus) {
  return "/stylus/" + std::to_string(stylus);
}

}  // namespace irdm::replay::run

namespace irdm::replay {

/// A run at the end of one step.
struct ReplayFrame {
  const StepRecord& record;
  std::span<const Points> displacement;  ///< of each object, (n, 3) [m], B; see needs_surfaces()
};

/// Takes in the frames of a run, in their order, and makes a file or a folder of them. What is not
/// finished leaves no file under its final name.
class FrameOutput {
 public:
  virtual ~FrameOutput() = default;

  /// Whether displacements are looked at: otherwise they may be missing.
  virtual bool needs_surfaces() const = 0;
  /// Throws Error when it cannot be written.
  virtual void put(const ReplayFrame& frame) = 0;
  /// After the last. Throws Error.
  virtual void finish() = 0;
};

/// What a run was rerun from.
struct RunOrigin {
  std::string trace;    ///< name of the trace file
  std::string from;     ///< "forces" or "inputs"
  std::string by = {};  ///< for people: engines, or a reference and its sub-step
};

/// A run file (HDF5, format "irdm-run", docs/files.md): poses, displacements and forces of each
/// frame, which compare reads.
class RunOutput final : public FrameOutput {
 public:
  /// Throws Error.
  RunOutput(const std::filesystem::path& path, const TracedScene& scene, const RunOrigin& origin);

  bool needs_surfaces() const override { return true; }
  void put(const ReplayFrame& frame) override;
  void finish() override;

 private:
  void create(const TracedScene& scene, const RunOrigin& origin);
  void create_set(const std::string& path, const hdf5::Shape& row, const std::string& unit);
  void append(const std::string& path, const double* values) {
    file_.append<double>(path, 1, values);
  }

  PartFile part_;
  hdf5::File file_;
  std::vector<std::string> names_;
};

}  // namespace irdm::replay
