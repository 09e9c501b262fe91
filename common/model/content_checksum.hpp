#pragma once

#include <optional>
#include <string>

#include "common/hdf5/file.hpp"

/// The checksum that a model file carries of its own content: root attribute `content_sha256`.
namespace irdm {

/// SHA-256, lower-case hexadecimal, of mesh, body, material, dt, steps, kind, modes, centrifugal
/// responses, responses to gravity, what modes that are left out add, and compressed responses; of
/// those that the file has, in this order: for every dataset its path, a zero byte, its extents as
/// u64 and its numbers as they are stored; for every attribute its object, '@', its name, a zero
/// byte and its value (text, or f64). Little-endian. Dense R is left out: its chunks carry
/// checksums of their own. Throws Error when something cannot be read.
std::string content_checksum(const hdf5::File& file);

/// What the file says that it should be; nothing in files made before there was one.
std::optional<std::string> stored_content_checksum(const hdf5::File& file);

/// Computes the checksum of an open new file and stores it there.
void store_content_checksum(hdf5::File& file);

}  // namespace irdm
