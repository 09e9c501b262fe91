#pragma once

#include <cstdint>
#include <span>
#include <string>

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

}  // namespace irdm::replay
