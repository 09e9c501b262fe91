#pragma once

#include "common/model/display_mesh.hpp"
#include "viewer/message_parts.hpp"

namespace irdm::viewer {

/// The display mesh of an object in a Scene (docs/viewer-protocol.md), which is not empty.
void put_display(Writer& writer, const DisplayMesh& display);

/// Throws MessageError when it is damaged or too large.
/// @param nodes of the object's surface
DisplayMesh get_display(Reader& reader, std::uint32_t nodes);

}  // namespace irdm::viewer
