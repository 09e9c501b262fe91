#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/hdf5/file.hpp"
#include "replay/output/frame_output.hpp"
#include "replay/output/part_file.hpp"
#include "replay/traced_scene.hpp"

namespace irdm::replay {

/// What a run was made again from.
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
