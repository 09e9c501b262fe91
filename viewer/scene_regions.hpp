#pragma once

#include "common/model/model.hpp"
#include "viewer/message.hpp"

namespace irdm::viewer {

/// What viewers are shown of a model's materials; empty where it is rigid or of one material. Pure.
///
/// A face between two tetrahedra is shown where their regions differ, or where in one region one
/// of them is more than twice as stiff as the other. It is coloured as the one whose region comes
/// later in the configuration, or in one region as the stiffer one.
SceneRegions scene_regions(const Model& model);

}  // namespace irdm::viewer
