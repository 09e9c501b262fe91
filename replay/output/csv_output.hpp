#pragma once

#include <fstream>

#include "replay/output/output_file.hpp"
#include "replay/output/run_output.hpp"
#include "replay/traced_scene.hpp"

namespace irdm::replay {

/// Motion and forces as a table, a row a frame (docs/replay.md). Numbers are written so that they
/// read back to the bit.
class CsvOutput final : public FrameOutput {
 public:
  /// Throws Error.
  CsvOutput(const std::filesystem::path& path, const TracedScene& scene);

  bool needs_surfaces() const override { return false; }
  void put(const ReplayFrame& frame) override;
  void finish() override;

 private:
  PartFile file_;
  std::ofstream stream_;
};

}  // namespace irdm::replay
