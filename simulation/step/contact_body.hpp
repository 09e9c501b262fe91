#pragma once

#include "common/motion/free_motion.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/contact/contact_sampling.hpp"

namespace irdm {

/// The parts of an object that its contacts with other bodies read: shape and motion in this step.
struct ContactBody {
  const ContactSampling& sampling;
  const RestSurface& rest;
  DeformedSurface& surface;
  const FreeMotion& motion;
};

}  // namespace irdm
