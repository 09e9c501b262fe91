#pragma once

#include <functional>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::test {

/// What a stylus does to a soft, free brick of 10 x 8 x 6 cm.
enum class BrickMotion {
  kSwing,  ///< holds a node of the top rigidly and swings it 3 cm at 1.5 Hz
  kPush,   ///< holds a node of the top rigidly, pushes 2 mm in 50 ms and holds on
  kTap,    ///< through a spring of 1000 N/m, as the next: a fingertip presses 2 mm deep and goes
           ///< back, in 60 ms; the brick flies off
  kSlide,  ///< a fingertip presses 3 mm and slides 3 cm on a tethered brick, with friction
};

/// The brick: density 300 kg/m^3, Poisson's ratio 0.45, damping 8 1/s and 2e-4 s, all modes.
/// @param youngs_modulus [N/m^2]  @param dt [s]
std::shared_ptr<const Model> soft_brick(double youngs_modulus, double dt);

/// A stylus that leads the brick.
struct BrickLead {
  BrickMotion motion = BrickMotion::kSwing;
  double youngs_modulus = 2e4;  ///< [N/m^2]
  double size = 1.0;            ///< of the motion: a share of what is said at BrickMotion
};

SimulationConfig brick_scene(const BrickLead& lead, double dt);
/// Makes the whole motion in steps of dt [s] and shows the record of each.
void lead_brick(const BrickLead& lead, double dt,
                const std::function<void(const StepRecord&)>& visit);

/// Force on the stylus in each step, which is the mean over it [N], W.
std::vector<Vector3> brick_forces(const BrickLead& lead, double dt);

/// Largest difference of these forces to those at kFineStep, averaged over the same times, as a
/// share of the largest force there.
double brick_error(const std::vector<Vector3>& fine, const std::vector<Vector3>& coarse, double dt);

inline constexpr double kFineStep = 1e-4;  ///< [s]

}  // namespace irdm::test
