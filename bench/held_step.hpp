#pragma once

#include <memory>
#include <vector>

#include "common/model/model.hpp"

namespace irdm::bench {

/// How long a force step takes [us].
struct StepTimes {
  double median = 0.0;
  double p99 = 0.0;
  double p999 = 0.0;
};

/// Force steps in which styluses hold points of a cube of 0.12 m, each between three nodes of a
/// face, and move them a little to and fro; after a whole history. Throws when one lost its hold.
/// @param styluses 1 to kMaxStyluses; the first one is in the middle of the top
StepTimes held_steps(std::shared_ptr<const Model> model, int styluses, int measured);

/// What of a force step belongs to eight held points that are coupled, more than there are
/// styluses: prediction, the contact problem and its solution, and the forces' entry into the
/// history. The first of them are where the styluses of held_steps() are.
StepTimes eight_contacts(const std::shared_ptr<const Model>& model, int measured);

/// The nodes that those points are between, whatever the response is. @param points 1 to 8
std::vector<int> held_nodes(const Model& model, int points);

}  // namespace irdm::bench
