#pragma once

#include "common/model/model.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// Within which distance of each other nodes answer exactly [m]: two under one fingertip are never
/// farther apart, and those of one triangle belong together whatever the fingertip.
double residual_radius(const ModelMesh& mesh, double contact_radius);

/// The static flexibility that the modes lack, K^+ - Phi diag(1 / omega^2) Phi^T, between surface
/// nodes up to `radius` apart, by a static solve for each surface degree of freedom. Should
/// leaving out what is farther apart make the whole of it indefinite, as much as is needed is
/// added to every diagonal (`added_compliance`), after which no set of contacts can draw energy
/// from it.
/// @param modes with shapes in double precision
/// @param threads > 0; the outcome does not depend on it
ResidualCompliance residual_compliance(const ElasticStatics& statics, const ModelMesh& mesh,
                                       const ModalResponse& modes, double radius, int threads,
                                       const Console& console);

/// What has to be added to the diagonal of a symmetric matrix so that it has no negative eigenvalue
/// (0 where there is none), found by Lanczos to 1e-7 of its norm.
double needed_for_definiteness(const ResidualCompliance& compliance);

}  // namespace irdm::precompute
