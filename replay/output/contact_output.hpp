#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "replay/output/output_file.hpp"
#include "replay/output/run_output.hpp"
#include "replay/traced_scene.hpp"

namespace irdm::replay {

/// Contacts of objects with each other and with scenery as a table, a row for each contact of each
/// frame (docs/replay.md). Numbers are written so that they read back to the bit.
class ContactOutput final : public FrameOutput {
 public:
  /// Throws Error.
  ContactOutput(const std::filesystem::path& path, const TracedScene& scene);

  bool needs_surfaces() const override { return false; }
  void put(const ReplayFrame& frame) override;
  void finish() override;

 private:
  const std::string& name(int body) const;

  PartFile file_;
  std::ofstream stream_;
  std::vector<std::string> objects_;
  std::vector<std::string> scenery_;
};

}  // namespace irdm::replay
