#pragma once

#include <optional>
#include <vector>

#include "replay/compare/compare_runs.hpp"
#include "replay/compare/run_reader.hpp"
#include "replay/measures/force_difference.hpp"
#include "replay/measures/ringing.hpp"
#include "replay/measures/spectrum.hpp"

namespace irdm::replay {

/// A signal of both runs: its size in each frame, its spectrum over the whole time that they have
/// in common, and what rings in one interval of it.
struct SignalPair {
  std::vector<double> size_a, size_b;
  Spectrum spectrum_a, spectrum_b;
  TimeInterval interval;  ///< of common frames
  std::vector<Ringing> ringing_a, ringing_b;
};

struct StylusMeasures {
  SignalPair force;  ///< [N]; rings where both runs have a force, longest
  ForceDifference difference;
  Compliance compliance_a, compliance_b;
  Vibration vibration_a, vibration_b, vibration_difference;
  OnsetDelays onsets;

  double compliance_share() const;  ///< of A's, by which B's is off; 0 where one is not known
  std::optional<bool> noticeable_compliance() const;  ///< nothing where one is not known
};

/// What two runs sound and feel like.
struct Measures {
  bool evenly_spaced = false;  ///< otherwise there are no spectra, ringing and vibrations
  double interval = 0.0;       ///< between frames, on average [s]
  perception::Hand hand;
  /// Of each object the node that is displaced most in A: displacement in B [m]. Rings where no
  /// stylus exerts a force in either run, longest. Empty where the meshes differ.
  std::vector<SignalPair> nodes;
  std::vector<StylusMeasures> styluses;
};

/// @param hand that holds the styluses
Measures measure_runs(const RunReader& a, const RunReader& b, const Comparison& comparison,
                      const perception::Hand& hand = {});

}  // namespace irdm::replay
