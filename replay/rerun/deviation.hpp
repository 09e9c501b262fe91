#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// Whether every number that a step did is finite.
bool is_finite(const StepRecord& record);

/// Throws Error unless a step that was rerun is finite: forces of a damaged trace, or of
/// another model, may drive an object beyond all numbers.
/// @param trace its name
void require_finite(const StepRecord& again, const std::string& trace);
/// The same of the displacements of all objects.
void require_finite(const std::vector<Points>& displacements, const std::string& trace);

/// How far a run that is rerun is from the recorded one: the largest differences of all steps,
/// objects and styluses.
class Deviation {
 public:
  void add(const StepRecord& recorded, const StepRecord& again);

  double force() const noexcept { return force_; }              ///< of a stylus [N]
  double peak_force() const noexcept { return peak_force_; }    ///< recorded, of a stylus [N]
  double position() const noexcept { return position_; }        ///< of a centre of mass [m]
  double orientation() const noexcept { return orientation_; }  ///< angle between [rad]
  /// Steps in which a stylus was in another state of contact.
  std::size_t other_contacts() const noexcept { return other_contacts_; }

  /// Two lines for people.
  std::string text() const;

 private:
  double force_ = 0.0;
  double peak_force_ = 0.0;
  double position_ = 0.0;
  double orientation_ = 0.0;
  double velocity_ = 0.0;          ///< [m/s]
  double angular_velocity_ = 0.0;  ///< [rad/s]
  std::size_t other_contacts_ = 0;
  double first_other_ = 0.0;  ///< end of the first such step [s]
};

/// The angle of the rotation between two orientations [rad].
double angle_between(const Quaternion& a, const Quaternion& b) noexcept;

}  // namespace irdm::replay
