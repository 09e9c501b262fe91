#pragma once

#include <algorithm>

#include "replay/rerun/deviation.hpp"
#include "replay/rerun/rerun.hpp"
#include "tests/replay/kept_run.hpp"
#include "tests/server/touching_cubes.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {

/// Largest differences of a run that is rerun.
struct Found {
  replay::Deviation deviation;
  double displacement = 0.0;            ///< of a component [m]
  std::size_t other_body_contacts = 0;  ///< steps in which those between bodies differ
};

inline Found run_again(replay::Rerun& made, const KeptRun& run) {
  const Recording recording = run.recording();
  REQUIRE(recording.steps() == run.records.size());
  REQUIRE(recording.lost_steps() == 0);
  Found found;
  StepRecord recorded;
  StepRecord again;
  Points u;
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, recorded);
    REQUIRE(same_body_contacts(recorded, run.records[k]));
    made.step(recorded, again);
    found.deviation.add(run.records[k], again);
    found.other_body_contacts += same_body_contacts(again, run.records[k]) ? 0 : 1;
    for (std::size_t i = 0; i < run.names.size(); ++i) {
      made.displacement(i, u);
      const Points& was = run.displacements[k][i];
      found.displacement = std::max(found.displacement, (u - was).cwiseAbs().maxCoeff());
    }
  }
  return found;
}

inline void check_to_the_bit(const KeptRun& run) {
  replay::InputRerun made(run.config);
  const Found found = run_again(made, run);
  INFO(found.deviation.text());
  CHECK(found.deviation.force() == 0.0);
  CHECK(found.deviation.position() == 0.0);
  CHECK(found.deviation.orientation() == 0.0);
  CHECK(found.deviation.other_contacts() == 0);
  CHECK(found.other_body_contacts == 0);
  CHECK(found.displacement == 0.0);
}

inline void check_from_forces(const KeptRun& run) {
  replay::ForceRerun made(run.config);
  const Found found = run_again(made, run);
  INFO(found.deviation.text());
  CHECK(found.deviation.force() < 1e-12);
  CHECK(found.deviation.position() < 1e-12);
  CHECK(found.deviation.orientation() < 1e-12);
  CHECK(found.displacement < 1e-12);
}

}  // namespace irdm::test
