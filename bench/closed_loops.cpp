// Hands, objects and links of any kind, closed over the link and the safety filter:
// bench_closed_loops [RUNS [FIRST]], from seed FIRST on. For the contact at the bridge and for held
// forces: the lowest energy that the device's port has taken from the hand, whether the hand comes
// to rest when what it wants does, compared with the same loop without delay (slow if not soon,
// unstable if not after kLater times as long either), how far the force is off it, how often the
// safety filter lowered its gain and how often the link was too bad for any force. Held forces also
// without the guard that lowers it, and trusted for as long as the filter allows at most. A line
// for each of the worst.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/statistics.hpp"
#include "tests/prediction/random_loop.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

struct Outcome {
  std::uint64_t seed = 0;
  double energy = 0.0;        ///< lowest [J]
  double speed = 0.0;         ///< of the hand at the end [m/s]
  double direct_speed = 0.0;  ///< the same without delay
  double error = 0.0;         ///< of the force, as a share of the peak
  double gain = 1.0;          ///< lowest of the filter
  double later_speed = 0.0;   ///< after kLater times as long, where it moves at the end [m/s]
  bool shown = true;          ///< any force
};

constexpr int kLater = 4;

// Still moving, and much more so than without delay.
bool moves(const Outcome& outcome, double speed) {
  return speed > 0.02 && speed > 3.0 * outcome.direct_speed;
}
bool slow(const Outcome& outcome) {
  return moves(outcome, outcome.speed);
}
bool unstable(const Outcome& outcome) {
  return moves(outcome, outcome.later_speed);
}

void report(const std::string& name, std::vector<Outcome> outcomes, bool near) {
  std::vector<double> energies;
  std::vector<double> errors;
  int shaking = 0;
  int below = 0;
  int little_below = 0;
  int lowered = 0;
  int late = 0;
  int idle = 0;
  for (const Outcome& outcome : outcomes) {
    energies.push_back(-1e3 * outcome.energy);
    if (std::isfinite(outcome.error)) errors.push_back(outcome.error);  // else it never touched
    shaking += unstable(outcome) ? 1 : 0;
    late += slow(outcome) ? 1 : 0;
    idle += outcome.shown ? 0 : 1;
    below += outcome.energy < -0.02 ? 1 : 0;
    little_below += outcome.energy < -0.002 ? 1 : 0;
    lowered += outcome.gain < 1.0 ? 1 : 0;
  }
  std::printf(
      "%s: %zu runs, %d unstable, %d slow to rest, %d below -20 mJ, %d below -2 mJ, %d with a "
      "lower gain, %d without any force; energy given by the port [mJ]: p50 %.3f, p99 %.3f, p99.9 "
      "%.3f, max %.3f; error of the force, share of the peak: p50 %.3f, p99 %.3f\n",
      name.c_str(), outcomes.size(), shaking, late, below, little_below, lowered, idle,
      bench::percentile(energies, 0.5), bench::percentile(energies, 0.99),
      bench::percentile(energies, 0.999), bench::percentile(energies, 1.0),
      bench::percentile(errors, 0.5), bench::percentile(errors, 0.99));
  std::sort(outcomes.begin(), outcomes.end(),
            [](const Outcome& a, const Outcome& b) { return a.energy < b.energy; });
  for (std::size_t i = 0; i < std::min<std::size_t>(3, outcomes.size()); ++i) {
    std::printf("  %.2f mJ: %s\n", 1e3 * outcomes[i].energy,
                RandomLoop(outcomes[i].seed, near).words.c_str());
  }
  int told = 0;
  for (const Outcome& outcome : outcomes) {
    if (!slow(outcome) || ++told > 10) continue;
    std::printf("  %.3f m/s at the end (%.3f without delay, %.3f after %d times as long): %s\n",
                outcome.speed, outcome.direct_speed, outcome.later_speed, kLater,
                RandomLoop(outcome.seed, near).words.c_str());
  }
}

Outcome outcome_of(std::uint64_t seed, const RandomLoop& loop, const LoopRun& direct, LoopMode mode,
                   Guards guards = {}, std::int64_t hold_horizon_ns = ForceDemand::kHoldHorizonNs) {
  LoopSetup setup = loop.setup;
  setup.guards = guards;
  setup.hold_horizon_ns = hold_horizon_ns;
  const LoopRun run = run_loop(setup, mode, loop.link);
  const bool lowers = guards.on(Guard::kOscillation);
  Outcome outcome{seed,
                  run.lowest_energy[0],
                  unrest(run, 0.002).speed,
                  unrest(direct, 0.002).speed,
                  largest_error(run, direct),
                  lowers ? run.lowest_gain[0] : 1.0};
  outcome.shown = peak(run) > 0.0;
  if (slow(outcome)) {
    setup.steps *= kLater;
    outcome.later_speed = unrest(run_loop(setup, mode, loop.link), 0.002).speed;
  }
  return outcome;
}

void run(int runs, int first, bool near) {
  std::vector<Outcome> predicted(static_cast<std::size_t>(runs));
  std::vector<Outcome> held(predicted.size());
  std::vector<Outcome> unguarded(predicted.size());
  std::vector<Outcome> trusted(predicted.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < runs; ++i) {
    const auto seed = static_cast<std::uint64_t>(first + i);
    const auto index = static_cast<std::size_t>(i);
    const RandomLoop loop(seed, near);
    const LoopRun direct = run_loop(loop.setup, LoopMode::kDirect);
    predicted[index] = outcome_of(seed, loop, direct, LoopMode::kPredict);
    held[index] = outcome_of(seed, loop, direct, LoopMode::kHold);
    unguarded[index] =
        outcome_of(seed, loop, direct, LoopMode::kHold, Guards{}.without(Guard::kOscillation));
    trusted[index] =
        outcome_of(seed, loop, direct, LoopMode::kHold, {}, FilterLimits{}.max_horizon_ns);
  }
  const std::string of = near ? ", round trip at most 2 ms, at most 400 N/m" : "";
  report("contact at the bridge" + of, predicted, near);
  report("forces held" + of, held, near);
  report("forces held, without the guard of oscillation" + of, unguarded, near);
  report("forces held, trusted for 50 ms" + of, trusted, near);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 1000;
  const int first = argc > 2 ? std::atoi(argv[2]) : 0;
  run(runs, first, false);
  run(runs / 10, first, true);
}
