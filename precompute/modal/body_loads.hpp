#pragma once

#include "common/model/model.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"

/// What loads on the whole body do to its modes. They are found offline, because such a load acts
/// on the nodes inside as well.
namespace irdm::precompute {

/// Of a floating body the centrifugal forces of its modes: a fixed one does not spin. Of a fixed
/// body the forces of gravity: no elastic mode of a floating one takes a uniform acceleration.
/// @param modes with their shapes at all nodes, those of `response`
void add_body_loads(const ElasticModes& modes, const Model& model, ModalResponse& response);

/// What some of the modes of a fixed body lack of its static displacement under gravity.
void add_gravity_rest(const ElasticStatics& statics, const Model& model, ModalResponse& response);

}  // namespace irdm::precompute
