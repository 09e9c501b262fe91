#include "replay/compare/measure_runs.hpp"

#include <algorithm>
#include <cmath>

namespace irdm::replay {
namespace {

constexpr double kSpectrumSegment = 1.0;  // [s]

/// One run at the common frames.
struct Side {
  const RunReader& run;
  std::vector<std::size_t> frames;
  std::vector<Points> forces;  ///< of each stylus: (frames, 3) [N], W
};

Points forces_of(const RunReader& run, std::size_t stylus, const std::vector<std::size_t>& frames) {
  Points forces(static_cast<Eigen::Index>(frames.size()), 3);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    forces.row(static_cast<Eigen::Index>(k)) = run.force(stylus, frames[k]);
  }
  return forces;
}

Side side_of(const RunReader& run, std::vector<std::size_t> frames) {
  Side side{run, std::move(frames), {}};
  for (std::size_t s = 0; s < run.styluses(); ++s) {
    side.forces.push_back(forces_of(run, s, side.frames));
  }
  return side;
}

Points node_of(const Side& side, std::size_t object, Eigen::Index node) {
  const Points all = side.run.node_displacement(object, node);
  Points u(static_cast<Eigen::Index>(side.frames.size()), 3);
  for (std::size_t k = 0; k < side.frames.size(); ++k) {
    u.row(static_cast<Eigen::Index>(k)) = all.row(static_cast<Eigen::Index>(side.frames[k]));
  }
  return u;
}

bool acts(const Points& force, std::size_t k) {
  return !force.row(static_cast<Eigen::Index>(k)).isZero(0.0);
}

// Frames without the force of any stylus in either run.
std::vector<bool> free_frames(const Side& a, const Side& b) {
  std::vector<bool> free(a.frames.size(), true);
  for (std::size_t k = 0; k < free.size(); ++k) {
    for (std::size_t s = 0; s < a.forces.size(); ++s) {
      if (acts(a.forces[s], k) || acts(b.forces[s], k)) free[k] = false;
    }
  }
  return free;
}

std::vector<double> sizes_of(const Points& signal) {
  const Eigen::VectorXd sizes = signal.rowwise().norm();
  return {sizes.begin(), sizes.end()};
}

SignalPair pair_of(const Points& a, const Points& b, const Measures& all,
                   const TimeInterval& interval) {
  SignalPair pair;
  pair.size_a = sizes_of(a);
  pair.size_b = sizes_of(b);
  if (!all.evenly_spaced) return pair;
  pair.spectrum_a = amplitude_spectrum(a, all.interval, kSpectrumSegment, Hold::kMean);
  pair.spectrum_b = amplitude_spectrum(b, all.interval, kSpectrumSegment, Hold::kMean);
  pair.interval = interval;
  const auto first = static_cast<Eigen::Index>(interval.first);
  const auto count = static_cast<Eigen::Index>(interval.count);
  pair.ringing_a = find_ringing(a.middleRows(first, count), all.interval);
  pair.ringing_b = find_ringing(b.middleRows(first, count), all.interval);
  return pair;
}

// The object that gives most along a stylus's force is the one that it touches.
void add_compliances(const Side& side, std::size_t k, const std::vector<Compliance*>& compliances) {
  std::vector<double> along(compliances.size(), 0.0);
  Points u;
  for (std::size_t i = 0; i < side.run.objects().size(); ++i) {
    side.run.displacement(i, side.frames[k], u);
    const Quaternion Q = side.run.pose(i, side.frames[k]).orientation;
    for (std::size_t s = 0; s < compliances.size(); ++s) {
      if (!acts(side.forces[s], k)) continue;
      const Vector3 force = side.forces[s].row(static_cast<Eigen::Index>(k));
      along[s] = std::max(along[s], largest_along(u, Q.conjugate() * -force));
    }
  }
  for (std::size_t s = 0; s < compliances.size(); ++s) {
    compliances[s]->add(along[s], side.forces[s].row(static_cast<Eigen::Index>(k)).norm());
  }
}

void measure_compliances(const Side& side, const std::vector<Compliance*>& compliances) {
  for (std::size_t k = 0; k < side.frames.size(); ++k) {
    const bool any = std::any_of(side.forces.begin(), side.forces.end(),
                                 [k](const Points& force) { return acts(force, k); });
    if (any) add_compliances(side, k, compliances);
  }
}

std::vector<bool> frames_in_contact(const Points& a, const Points& b) {
  std::vector<bool> marked(static_cast<std::size_t>(a.rows()));
  for (std::size_t k = 0; k < marked.size(); ++k) marked[k] = acts(a, k) && acts(b, k);
  return marked;
}

StylusMeasures measure_stylus(const Points& a, const Points& b, const std::vector<double>& times,
                              const Measures& all) {
  StylusMeasures found;
  found.difference = force_difference(a, b, all.interval);
  found.onsets = onset_delays(onsets_of(a, times), onsets_of(b, times));
  found.force = pair_of(a, b, all, longest_interval(frames_in_contact(a, b)));
  if (!all.evenly_spaced) return found;
  found.vibration_a = vibration_of(a, all.interval, all.hand);
  found.vibration_b = vibration_of(b, all.interval, all.hand);
  found.vibration_difference = vibration_of(b - a, all.interval, all.hand);
  return found;
}

std::vector<Compliance*> compliances_of(std::vector<StylusMeasures>& styluses,
                                        Compliance StylusMeasures::*which) {
  std::vector<Compliance*> all;
  for (StylusMeasures& stylus : styluses) all.push_back(&(stylus.*which));
  return all;
}

}  // namespace

double StylusMeasures::compliance_share() const {
  if (!compliance_a.known() || !compliance_b.known()) return 0.0;
  return std::abs(compliance_b.value() / compliance_a.value() - 1.0);
}

std::optional<bool> StylusMeasures::noticeable_compliance() const {
  if (!compliance_a.known() || !compliance_b.known()) return {};
  return compliance_share() > perception::kComplianceShare;
}

Measures measure_runs(const RunReader& a, const RunReader& b, const Comparison& comparison,
                      const perception::Hand& hand) {
  std::vector<std::size_t> frames_a;
  std::vector<std::size_t> frames_b;
  for (const auto& pair : comparison.frames) {
    frames_a.push_back(pair.first);
    frames_b.push_back(pair.second);
  }
  const Side side_a = side_of(a, std::move(frames_a));
  const Side side_b = side_of(b, std::move(frames_b));
  const std::vector<double>& times = comparison.times;
  Measures found;
  found.hand = hand;
  found.evenly_spaced = evenly_spaced(times);
  if (times.size() > 1) {
    found.interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  }
  const TimeInterval free = longest_interval(free_frames(side_a, side_b));
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    const ObjectComparison& object = comparison.objects[i];
    SignalPair& pair = found.nodes.emplace_back();
    if (!object.same_nodes) continue;
    pair = pair_of(node_of(side_a, i, object.node), node_of(side_b, i, object.node), found, free);
  }
  for (std::size_t s = 0; s < side_a.forces.size(); ++s) {
    found.styluses.push_back(measure_stylus(side_a.forces[s], side_b.forces[s], times, found));
  }
  measure_compliances(side_a, compliances_of(found.styluses, &StylusMeasures::compliance_a));
  measure_compliances(side_b, compliances_of(found.styluses, &StylusMeasures::compliance_b));
  return found;
}

}  // namespace irdm::replay
