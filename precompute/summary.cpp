#include "precompute/summary.hpp"

#include <algorithm>
#include <cstdio>

namespace irdm::precompute {
namespace {

std::string significant(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  return text;
}

std::string bytes(double value) {
  const char* const units[] = {"B", "kB", "MB", "GB", "TB"};
  int unit = 0;
  while (value >= 1000.0 && unit < 4) {
    value /= 1000.0;
    ++unit;
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.*f %s", value < 100.0 && unit > 0 ? 1 : 0, value,
                units[unit]);
  return text;
}

std::string quality(const MeshReport& mesh) {
  char text[64];
  std::snprintf(text, sizeof text, "%.3f %.3f", mesh.worst_quality, mesh.median_quality);
  return text;
}

std::string row(const std::string& name, const std::string& value) {
  return "  " + name + std::string(34 - name.size(), ' ') + value + "\n";
}

std::string reduction_rows(const ModeReduction& reduction) {
  return row("elastic modes of the body", std::to_string(reduction.elastic_modes)) +
         row("error of force under a fingertip", significant(100.0 * reduction.force_error, "%")) +
         row("error of shape under a fingertip", significant(100.0 * reduction.shape_error, "%"));
}

std::string region_rows(const std::vector<RegionReport>& regions) {
  std::string rows;
  for (const RegionReport& region : regions) rows += row(name_of(region), format_region(region));
  return rows;
}

}  // namespace

std::string format_summary(const Summary& s) {
  const double computed = std::max(1, s.columns);
  const double stored = s.slice ? computed : s.degrees_of_freedom();
  return row("free nodes (n)", std::to_string(s.free_nodes)) +
         row("triangle patches", std::to_string(s.triangles)) +
         row("entire nodes", std::to_string(s.nodes)) +
         row("inner nodes", std::to_string(s.nodes - s.free_nodes)) +
         (s.clamped_nodes > 0 ? row("clamped nodes", std::to_string(s.clamped_nodes)) : "") +
         row("tetrahedral elements", std::to_string(s.tetrahedra)) +
         row("order of the elements", std::to_string(s.order)) +
         row("quality, worst and median (0..1)", quality(s.mesh)) +
         row("bounding box", format_extent(s.mesh.extent)) + region_rows(s.regions) +
         row("mass", significant(s.mass, "kg")) +
         row("degrees of freedom (3n)", std::to_string(s.degrees_of_freedom())) +
         (s.modes == 0
              ? std::string()
              : row("elastic modes", std::to_string(s.modes)) +
                    row("lowest elastic frequency", significant(s.lowest_frequency, "Hz"))) +
         (s.reduction ? reduction_rows(*s.reduction) : std::string()) +
         (s.decay_left ? row("decay left at the last step", significant(100.0 * *s.decay_left, "%"))
                       : std::string()) +
         row("nodal over solid inertia", significant(100.0 * s.inertia_excess, "% more")) +
         (s.columns == s.degrees_of_freedom()
              ? std::string()
              : row("columns computed in this run", std::to_string(s.columns))) +
         row("pre-computation time", significant(s.seconds, "s")) +
         row("pre-computation time per d.o.f.", significant(s.seconds / computed, "s")) +
         row(s.slice ? "part of a model file" : "model file",
             bytes(static_cast<double>(s.file_bytes))) +
         row("data size per d.o.f.", bytes(static_cast<double>(s.file_bytes) / stored)) +
         row("BLAS kernel", s.blas_kernel);
}

}  // namespace irdm::precompute
