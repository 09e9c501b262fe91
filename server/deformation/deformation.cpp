#include "server/deformation/deformation.hpp"

#include "server/step/nodal_forces.hpp"

namespace irdm {

Deformation::Deformation(std::shared_ptr<const Model> model)
    : model_(std::move(model)), engine_(make_engine(model_)) {}

void Deformation::follow(const StepRecord& record) {
  const NodalForces held = nodal_forces(last_);
  for (std::uint64_t k = started_ ? last_.force_step + 1 : 0; k < record.force_step; ++k) {
    engine_->advance(held.view());
    ++lost_steps_;
  }
  engine_->advance(nodal_forces(record).view());
  last_ = record;
  started_ = true;
}

void Deformation::compute(SurfaceFrame& frame) const {
  frame.force_step = last_.force_step;
  frame.time = last_.time;
  frame.position = last_.position;
  frame.orientation = last_.orientation;
  engine_->displacement(frame.displacement);
}

}  // namespace irdm
