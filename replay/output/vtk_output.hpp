#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "replay/output/run_output.hpp"
#include "replay/traced_scene.hpp"
#include "simulation/step/nodal_forces.hpp"

namespace irdm::replay {

/// Parts of VTK's XML files, with numbers in base64 as they are in memory (format="binary",
/// header_type="UInt64", not compressed).

/// <VTKFile> up to its end. @param type "PolyData", "Collection"
std::string vtk_file(const std::string& type, const std::string& content);

/// A <DataArray> of as many components a row. @param more further attributes
std::string vtk_array(const std::string& name, std::span<const double> values, int components,
                      const std::string& more = "");
std::string vtk_array(const std::string& name, std::span<const std::int32_t> values, int components,
                      const std::string& more = "");

/// The deformed surfaces and the styluses as a time series for ParaView: a folder with run.pvd,
/// which is written last, and for each frame a NAME_NUMBER.vtp for each object and one for the
/// styluses (docs/replay.md). All in W.
class VtkOutput final : public FrameOutput {
 public:
  /// @param folder new or empty. Throws Error.
  VtkOutput(const std::filesystem::path& folder, const TracedScene& scene);

  bool needs_surfaces() const override { return true; }
  void put(const ReplayFrame& frame) override;
  void finish() override;

 private:
  /// What stays the same.
  struct Surface {
    std::string name;
    std::shared_ptr<const Model> model;
    std::unique_ptr<RestSurface> rest;
    std::unique_ptr<RecordedForces> forces;
    std::string triangles;  ///< in XML
  };
  std::string surface_text(const Surface& surface, const ObjectRecord& object,
                           const Points& displacement, const StepRecord& record) const;
  std::string styluses_text(const StepRecord& record) const;
  void write(const std::string& name, const std::string& text) const;
  void write_part(const std::string& name, const std::string& text, double time, std::size_t part);

  std::filesystem::path folder_;
  std::vector<Surface> surfaces_;
  std::string index_;  ///< lines of run.pvd so far
  std::size_t frames_ = 0;
};

}  // namespace irdm::replay
