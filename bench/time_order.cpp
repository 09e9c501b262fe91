// How the force goes with the step: bench_time_order. One line for each motion of a stylus on a
// soft brick, stiffness and step: the largest error of the force as a share of its peak, against
// steps of 0.1 ms, and against corotational finite elements of the same mesh in such steps.
// scripts/plot_time_order.py draws it.

#include <array>
#include <cstdio>
#include <utility>

#include "replay/reference/fem_body.hpp"
#include "tests/support/led_brick.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// Motions so small that what the responses leave out, the geometry, is far below the step's error.
constexpr double kSmall = 0.01;

// What the contact's point has slipped by, or has been put aside by friction [m], W: the finite
// elements have it slip alike, and find the force for it.
Vector3 slip(const StepRecord& record, double compliance) {
  const ObjectRecord& object = record.object[0];
  const ContactRecord& contact = object.contact[0];
  return record.stylus[0].tip - contact.proxy - object.orientation * contact.offset -
         compliance * (object.halfway * contact.force);
}

/// A run of the force step in steps of 0.1 ms, and the force that finite elements need to take the
/// contact's points along the same path at the same times.
struct FineRun {
  std::vector<Vector3> forces, fem;

  explicit FineRun(const BrickLead& lead) {
    const SimulationConfig config = brick_scene(lead, kFineStep);
    const double stiffness = config.styluses[0].coupling_stiffness;
    const double compliance = stiffness > 0.0 ? 1.0 / stiffness : 0.0;
    replay::FemBody body(config, 0, precompute::Elasticity::kCorotational, kFineStep, true);
    lead_brick(lead, kFineStep, [&](const StepRecord& record) {
      forces.push_back(record.stylus[0].force);
      ObjectRecord again = record.object[0];
      ContactRecord& contact = again.contact[0];
      StylusRecord stylus = record.stylus[0];
      if (contact.state != ContactState::kFree) {
        stylus.tip -= slip(record, compliance);
        stylus.buttons |= kGrabButton;
        contact.state = ContactState::kHeld;
      }
      body.step(again, {&stylus, 1});
      fem.push_back(Vector3::Zero());
      if (contact.state != ContactState::kFree) fem.back() -= again.halfway * contact.force;
    });
  }
};

void print_errors(const char* name, const BrickLead& lead) {
  const FineRun fine(lead);
  for (const double dt : {4e-3, 2e-3, 1e-3, 5e-4, 2e-4, kFineStep}) {
    const std::vector<Vector3> forces = brick_forces(lead, dt);
    std::printf("%s,%g,%g,%.3e,%.3e\n", name, lead.youngs_modulus, dt,
                brick_error(fine.forces, forces, dt), brick_error(fine.fem, forces, dt));
    std::fflush(stdout);
  }
}

}  // namespace

int main() {
  constexpr std::array<std::pair<const char*, BrickMotion>, 4> kMotions{
      {{"swing", BrickMotion::kSwing},
       {"push", BrickMotion::kPush},
       {"tap", BrickMotion::kTap},
       {"slide", BrickMotion::kSlide}}};
  std::printf("motion,youngs_modulus,dt,error,fem_error\n");
  for (const auto& [name, motion] : kMotions) {
    for (const double E : {2e3, 2e4, 2e5, 1e6}) print_errors(name, {motion, E, kSmall});
  }
}
