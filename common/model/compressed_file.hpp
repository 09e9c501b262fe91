#pragma once

#include "common/hdf5/file.hpp"
#include "common/model/model.hpp"

/// The group /response/modal/residual of a model file (docs/files.md). The file has the blocks on
/// and above the diagonal only, so that reciprocity holds whatever is in it.
namespace irdm {

inline constexpr const char* kModalResidual = "/response/modal/residual";
inline constexpr const char* kResidualRowStart = "/response/modal/residual/row_start";
inline constexpr const char* kResidualNodes = "/response/modal/residual/nodes";
inline constexpr const char* kResidualBlocks = "/response/modal/residual/blocks";

void write_residual(hdf5::File& file, const ResidualCompliance& residual);

/// Nothing where the file has no such group. Throws Error when it is damaged.
/// @param surface_nodes n of the model
ResidualCompliance read_residual(const hdf5::File& file, int surface_nodes);

// The compressed response in a model file (docs/files.md).

inline constexpr const char* kCompressedGroup = "/response/compressed";
inline constexpr const char* kCompressedFir = "/response/compressed/early";
inline constexpr const char* kCompressedFirScale = "/response/compressed/early_scale";
inline constexpr const char* kCompressedShapes = "/response/compressed/shapes";
inline constexpr const char* kCompressedPoleShape = "/response/compressed/pole_shape";
inline constexpr const char* kCompressedPole = "/response/compressed/pole";
inline constexpr const char* kCompressedAmplitude = "/response/compressed/amplitude";

/// How far a compressed response is from the R that it was made from, as measured. All are shares.
struct CompressionError {
  double requested = 0.0;         ///< what --error said
  double displacement = 0.0;      ///< of a column over all steps, norm; the largest
  double displacement_rms = 0.0;  ///< the same, root mean square over the columns
  double force = 0.0;             ///< of the force on a held node, of its peak; the largest
  int measured_columns = 0;       ///< that this was measured on
};

void write_compressed(hdf5::File& file, const CompressedResponse& response,
                      const CompressionError& error);

/// Reads and checks: shapes, ranges, finite numbers, poles inside the unit circle. Throws Error.
/// @param model its description
CompressedResponse read_compressed(const hdf5::File& file, const Model& model);

CompressionError read_compression_error(const hdf5::File& file);

}  // namespace irdm
