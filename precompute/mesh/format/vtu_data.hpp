#pragma once

#include <bit>
#include <cstddef>
#include <string_view>
#include <vector>

#include "precompute/mesh/format/number_array.hpp"

namespace irdm::precompute {

/// How the arrays of one VTK XML file are stored.
struct VtuCoding {
  std::endian order = std::endian::little;
  NumberType header = NumberType::kUInt32;  ///< of the sizes before the data
  bool compressed = false;                  ///< by zlib, in blocks
};

/// The numbers of an array in binary form. Layout: VTK File Formats, "XML File Formats", and
/// vtkXMLDataParser. Throws std::runtime_error with what is wrong.
/// @param text base64, white space allowed around it, or the bytes themselves; may go on after the
/// array
/// @param base64 which of the two
std::vector<double> decode_vtu_array(std::string_view text, bool base64, NumberType type,
                                     const VtuCoding& coding);

}  // namespace irdm::precompute
