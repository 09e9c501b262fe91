#include "precompute/check/wave_speed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "precompute/check/static_reference.hpp"
#include "precompute/fem/material.hpp"

namespace irdm::precompute {
namespace {

constexpr double kArrivalShare = 0.05;  // of the first peak
constexpr double kPeakShare = 0.3;      // of the largest displacement: smaller ones are precursors
constexpr double kFlatSlope = 0.2;      // distance from the tangent plane per distance
constexpr double kEquallyFar = 1e-3;    // share of the distance

struct Passage {
  double distance;  // [m]
  double arrival;   // [s]
  double peak;      // [s]
  double main;      // [s]
};

// Time between the samples at which `values`, sampled at (s+1) dt, first reaches `level`.
double first_crossing(const Eigen::VectorXd& values, double level, double dt) {
  for (Eigen::Index s = 0; s < values.size(); ++s) {
    if (values(s) < level) continue;
    const double before = s == 0 ? 0.0 : values(s - 1);
    return dt * (static_cast<double>(s) + (level - before) / (values(s) - before));
  }
  return dt * static_cast<double>(values.size());
}

// The first sample that no neighbour exceeds, or -1.
Eigen::Index first_peak(const Eigen::VectorXd& values) {
  const double least = kPeakShare * values.maxCoeff();
  for (Eigen::Index s = 1; s + 1 < values.size(); ++s) {
    if (values(s) > least && values(s) >= values(s - 1) && values(s) > values(s + 1)) return s;
  }
  return -1;
}

// Time of the peak of the parabola through three samples.
double peak_time(const Eigen::VectorXd& values, Eigen::Index s, double dt) {
  const double bend = values(s - 1) - 2.0 * values(s) + values(s + 1);
  return dt * (static_cast<double>(s) + 1.0 + 0.5 * (values(s - 1) - values(s + 1)) / bend);
}

double main_time(const Eigen::VectorXd& values, double dt) {
  Eigen::Index s = 0;
  values.maxCoeff(&s);
  if (s == 0 || s + 1 == values.size()) return dt * (static_cast<double>(s) + 1.0);
  return peak_time(values, s, dt);
}

Passage mean_of(std::span<const Passage> passages) {
  Passage sum{0.0, 0.0, 0.0, 0.0};
  for (const Passage& p : passages) {
    sum.distance += p.distance;
    sum.arrival += p.arrival;
    sum.peak += p.peak;
    sum.main += p.main;
  }
  const auto count = static_cast<double>(passages.size());
  return {sum.distance / count, sum.arrival / count, sum.peak / count, sum.main / count};
}

// Nodes that are equally far count as one: where they are so by symmetry, they say the same.
std::vector<Passage> by_distance(std::vector<Passage> passages) {
  std::sort(passages.begin(), passages.end(),
            [](const Passage& a, const Passage& b) { return a.distance < b.distance; });
  std::vector<Passage> means;
  for (std::size_t begin = 0, end = 0; begin < passages.size(); begin = end) {
    while (end < passages.size() &&
           passages[end].distance <= (1.0 + kEquallyFar) * passages[begin].distance) {
      ++end;
    }
    means.push_back(mean_of(std::span(passages).subspan(begin, end - begin)));
  }
  return means;
}

// Of three or more.
FittedPassage fit(const std::vector<Passage>& passages, double Passage::*time) {
  const Passage mean = mean_of(passages);
  double covariance = 0.0;
  double variance = 0.0;
  for (const Passage& p : passages) {
    covariance += (p.distance - mean.distance) * (p.*time - mean.*time);
    variance += (p.distance - mean.distance) * (p.distance - mean.distance);
  }
  const double slope = covariance / variance;
  double off = 0.0;
  for (const Passage& p : passages) {
    off += std::pow(p.*time - mean.*time - slope * (p.distance - mean.distance), 2);
  }
  return {slope, std::sqrt(off / static_cast<double>(passages.size() - 2) / variance)};
}

}  // namespace

double FittedPassage::speed() const {
  return slowness > 0.0 ? 1.0 / slowness : std::numeric_limits<double>::infinity();
}

WaveSpeeds theoretical_speeds(const Material& material) {
  const Lame lame = lame_parameters(material);
  const double shear = std::sqrt(lame.mu / material.density);
  const double dilatational = std::sqrt((lame.lambda + 2.0 * lame.mu) / material.density);
  // Rayleigh: (2 - q)^2 = 4 sqrt(1 - q) sqrt(1 - q (cs/cp)^2) for q = (c/cs)^2, one root in (0, 1).
  const double ratio = std::pow(shear / dilatational, 2);
  double low = 0.1;  // below it for every Poisson ratio, where the left side is the smaller one
  double high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double q = 0.5 * (low + high);
    const double excess =
        (2.0 - q) * (2.0 - q) - 4.0 * std::sqrt(1.0 - q) * std::sqrt(1.0 - q * ratio);
    (excess < 0.0 ? low : high) = q;
  }
  return {shear, shear * std::sqrt(low), dilatational};
}

int wave_source(const Model& model) {
  int node = 0;
  for (int i = 1; i < model.mesh.surface_node_count(); ++i) {
    // The same choice whatever rounding does to nodes that are equally far.
    if (model.mesh.rest_position(i).norm() < (1.0 - 1e-9) * model.mesh.rest_position(node).norm()) {
      node = i;
    }
  }
  int axis = 0;
  model.mesh.rest_position(node).cwiseAbs().maxCoeff(&axis);
  return 3 * node + axis;
}

MeasuredWave measure_wave(const Model& model, int b, const RowMatrix<double>& column, double dt) {
  const Vector3 source = model.mesh.rest_position(b / 3);
  const double reach = 1.1 * source.norm();
  const Vector3 outward = source.normalized();
  MeasuredWave wave;
  std::vector<Passage> passages;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const Vector3 from = model.mesh.rest_position(i) - source;
    const double distance = from.norm();
    if (i == b / 3 || distance > reach || std::abs(from.dot(outward)) > kFlatSlope * distance)
      continue;
    const Vector3 drift =
        dt * dt * rigid_mobility(model.body, model.mesh.rest_position(i), source).col(b % 3);
    Eigen::VectorXd moved(column.rows());
    Eigen::VectorXd along(column.rows());
    for (Eigen::Index s = 0; s < moved.size(); ++s) {
      // The force acts during the first step: from then on the body drifts as if pushed at its
      // middle.
      const Vector3 elastic = column.row(s).segment<3>(3 * i).transpose();
      const Vector3 total = elastic + (static_cast<double>(s) + 0.5) * drift;
      moved(s) = total.norm();
      along(s) = total[b % 3];
    }
    ++wave.nodes;
    const Eigen::Index peak = first_peak(moved);
    if (peak < 0) continue;
    passages.push_back({distance, first_crossing(moved, kArrivalShare * moved(peak), dt),
                        peak_time(moved, peak, dt), main_time(along, dt)});
  }
  wave.passed = static_cast<int>(passages.size());
  passages = by_distance(std::move(passages));
  wave.distances = static_cast<int>(passages.size());
  if (wave.distances < 3) return wave;
  wave.arrival = fit(passages, &Passage::arrival);
  wave.main = fit(passages, &Passage::main);
  wave.peak = fit(passages, &Passage::peak);
  return wave;
}

}  // namespace irdm::precompute
