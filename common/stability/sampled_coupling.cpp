#include "common/stability/sampled_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/motion/rigid_body.hpp"
#include "common/response/stored_response.hpp"
#include "common/stability/coupling_limit.hpp"

namespace irdm {
namespace {

// Steps 0: the response is not there, or not all of it.
RecordLength length_of(const Model& model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return record_length(*modal, model.dt);
  }
  if (const auto* compressed = std::get_if<CompressedResponse>(&model.response)) {
    return record_length(*compressed);
  }
  return {std::holds_alternative<DenseResponse>(model.response) ? model.steps : 0, 1.0};
}

}  // namespace

double sampled_coupling(const Model& model, int count) {
  double limit = std::numeric_limits<double>::infinity();
  const RecordLength length = length_of(model);
  if (length.steps == 0) return limit;
  const double radius = length.radius * std::exp(-kSlowestGrowth * model.dt);
  const HandLoop loop{{}, model.dt, loop_delay(model.dt, model.dt)};
  const RigidMobility mobility = RigidBody(model.body, model.dt).mobility();
  const auto R = stored_response(model);
  const int nodes = model.mesh.surface_node_count();
  for (int i = 0; i < std::min(count, nodes); ++i) {
    const int node = static_cast<int>(static_cast<long>(i) * nodes / std::min(count, nodes));
    const DrivingPoint record = R->driving_points(node, 1, length.steps).front();
    if (record.isZero(0.0)) continue;  // clamped
    const Vector3 x = model.mesh.rest_position(node);
    limit = std::min(limit, largest_coupling(record, mobility.between(x, x), loop, radius));
  }
  return limit;
}

}  // namespace irdm
