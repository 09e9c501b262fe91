#pragma once

#include <filesystem>

#include "common/hdf5/file.hpp"
#include "common/model/model.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {

/// Writes beside what a model file has what unit it is in (docs/files.md): attribute `unit` of
/// datasets, `units` of groups for their attributes. Once, when all is there.
void write_model_units(hdf5::File& file);

// The model file (HDF5, format "irdm-model", docs/files.md).

enum class ResponseKind { kModal, kDense, kCompressed };

/// Throws Error when the file says that it is something else, such as a trace.
void check_model_format(const hdf5::File& file);

/// Whether a reader compares the checksum of the file's content (content_checksum.hpp).
enum class Checksum { kCompare, kIgnore };

/// Reads a model file and, of its responses, the one that is asked for; of a rigid body
/// RigidResponse, whatever is asked for. Everything is checked: types, units, shapes, index ranges,
/// finite numbers, positive mass, and last the checksum. Throws Error.
Model read_model(const std::filesystem::path& path, ResponseKind kind,
                 Checksum checksum = Checksum::kCompare);

/// The same with of the dense one only what a StreamedResponse always has; its columns are for the
/// caller to provide.
Model read_streamed_model(const std::filesystem::path& path);

/// The same without a response and without the checksum: what ModelFileWriter::write_description()
/// wrote. A rigid body is whole.
Model read_description(hdf5::File file);

}  // namespace irdm
