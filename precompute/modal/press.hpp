#pragma once

#include <Eigen/Dense>

namespace irdm::precompute {

/// How long a fingertip takes to be pressed in, where the errors of force are found [s]: as fast as
/// a finger pokes, and no faster than ten steps resolve.
double press_time(double dt);

/// Steps of press_force(): twice the time of pressing in, the second half at rest.
int press_steps(double dt);

/// Force of a fingertip that is pressed in as (1 - cos(pi t / time)) / 2 and then stays, at each
/// step, per indentation [N/m].
/// @param response of the place to a force held during one step, press_steps(dt) of it [m/N]
Eigen::VectorXd press_force(const Eigen::VectorXd& response, double dt);

/// Largest difference of the two forces as a share of the largest force with `all`.
double press_error(const Eigen::VectorXd& all, const Eigen::VectorXd& found, double dt);

}  // namespace irdm::precompute
