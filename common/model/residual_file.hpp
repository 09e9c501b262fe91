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

}  // namespace irdm
