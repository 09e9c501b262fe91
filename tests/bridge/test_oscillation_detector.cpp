#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "device_bridge/safety/oscillation_detector.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr double kTick = 1e-3;  // [s]
constexpr double kLate = 0.01;  // [s]

// A tip that goes by `way(t)` against the force `force(t)` on it [m, N], for so many seconds. A
// force that stood for its tick would be late by half of one, which is enough from 15 Hz on.
template <class Way, class Force>
OscillationDetector watched(double seconds, const Way& way, const Force& force,
                            double age = kLate) {
  OscillationDetector oscillation{OscillationLimits{}};
  for (double t = 0.0; t < seconds; t += kTick) {
    const double pushes = force(t + 0.5 * kTick);
    oscillation.observe(-pushes * (way(t + kTick) - way(t)), kTick, age, pushes != 0.0);
  }
  return oscillation;
}

// The same, but what the force gives the world has given, to the tip of before.
template <class Way, class Force>
OscillationDetector granted(double seconds, const Way& way, const Force& force,
                            double age = kLate) {
  OscillationDetector oscillation{OscillationLimits{}};
  double taken = 0.0;
  for (double t = 0.0; t < seconds; t += kTick) {
    const double pushes = force(t + 0.5 * kTick);
    const double work = -pushes * (way(t + kTick) - way(t));
    taken += work;
    oscillation.grant(std::max(0.0, -taken));
    taken = std::max(0.0, taken);
    oscillation.observe(work, kTick, age, pushes != 0.0);
  }
  return oscillation;
}

double sine(double t, double frequency) {
  return std::sin(2.0 * M_PI * frequency * t);
}

}  // namespace

TEST_CASE("oscillation: a force that lags behind its own motion is cut, one that leads is not") {
  for (const double frequency : {3.0, 10.0, 20.0, 40.0}) {
    CAPTURE(frequency);
    // A spring of 300 N/m; what it gives in a cycle is pi k a^2 sin(lag).
    const double amplitude = 3e-3;
    const auto way = [=](double t) { return amplitude * sine(t, frequency); };
    const auto late_by = [=](double lag) {
      return [=](double t) { return -300.0 * way(t - lag / (2.0 * M_PI * frequency)); };
    };
    const double given = M_PI * 300.0 * amplitude * amplitude * std::sin(0.6);
    const double cycles_to_a_cut = OscillationLimits{}.late.debt / given;
    // The first low ends no cycle.
    const double seconds = (2.5 + cycles_to_a_cut) / frequency;
    CHECK(watched(seconds, way, late_by(0.6)).gain() < 0.6);
    CHECK(watched(3.0, way, late_by(-0.6)).gain() == 1.0);
    CHECK(watched(3.0, way, late_by(0.0)).gain() == 1.0);
  }
}

TEST_CASE("oscillation: a force that is fresh is let alone in slow cycles, by its age's mean") {
  const auto way = [](double t) { return 3e-3 * sine(t, 6.0); };  // two cycles of energy in each
  const auto late = [&](double t) { return -300.0 * way(t - 0.01); };
  CHECK(granted(3.0, way, late, 4.9e-3).gain() == 1.0);
  CHECK(granted(3.0, way, late, 5.1e-3).gain() < 0.6);
  for (const double other : {7e-3, 9e-3}) {
    OscillationDetector oscillation{OscillationLimits{}};
    for (int i = 0; i < 3000; ++i) {
      const double t = i * kTick;
      oscillation.grant(std::max(0.0, late(t) * (way(t + kTick) - way(t))));
      oscillation.observe(-late(t) * (way(t + kTick) - way(t)), kTick, i % 2 == 0 ? 2e-3 : other,
                          true);
    }
    CHECK((oscillation.gain() < 0.6) == (other > 8e-3));
  }
}

TEST_CASE("oscillation: a force that is fresh is cut for quick cycles, later than a late one") {
  const auto way = [](double t) { return 1e-3 * sine(t, 25.0); };
  const auto late = [&](double t) { return -500.0 * way(t - 3e-3); };
  // What a cycle gives: pi k a^2 sin(lag).
  const double given = M_PI * 500.0 * 1e-6 * std::sin(2.0 * M_PI * 25.0 * 3e-3);
  const double cycles = OscillationLimits{}.fresh.debt / given;
  CHECK(watched((cycles - 1.0) / 25.0, way, late, 3e-3).gain() == 1.0);
  CHECK(watched((cycles + 2.5) / 25.0, way, late, 3e-3).gain() < 0.6);
  CHECK(watched((cycles - 1.0) / 25.0, way, late, 6e-3).gain() < 0.6);
  CHECK(watched(3.0, way, late, 0.0).gain() == 1.0);
}

TEST_CASE("oscillation: a hand that bounces, and is only ever pushed away, is cut") {
  // In without force, out with it: 1 mJ each time.
  const auto way = [](double t) { return -1e-3 * std::cos(2.0 * M_PI * 10.0 * t); };
  const auto out = [](double t) { return sine(t, 10.0) > 0.0 ? 0.5 : 0.0; };
  CHECK(watched(0.35, way, out).gain() < 0.6);
  CHECK(watched(0.35, way, out, 4e-3).gain() == 1.0);
  // One that takes what it gets, in and out alike, is not.
  const auto wall = [&](double t) { return 300.0 * std::max(0.0, -way(t)); };
  CHECK(watched(3.0, way, wall).gain() == 1.0);
}

TEST_CASE("oscillation: neither a push by another hand nor a weight that is let down is cut") {
  const auto constant = [](double) { return 1.0; };
  CHECK(granted(
            2.0, [](double t) { return 0.1 * t; }, constant)
            .gain() == 1.0);
  // With the tremor of a hand, 0.1 mm at 10 Hz.
  CHECK(granted(
            2.0, [](double t) { return 0.05 * t + 1e-4 * sine(t, 10.0); }, constant)
            .gain() == 1.0);
  // To and fro, slowly, pushed one way only.
  const auto push = [](double t) { return sine(t - 1e-9, 0.7) > 0.0 ? 0.5 : 0.0; };
  CHECK(granted(
            6.0, [](double t) { return -0.02 * std::cos(2 * M_PI * 0.7 * t); }, push)
            .gain() == 1.0);
}

TEST_CASE("oscillation: energy that nobody gave is cut, in whatever course it comes") {
  const double owed = OscillationLimits{}.owed;
  const auto constant = [](double) { return 1.0; };
  const auto steady = [](double t) { return 0.01 * t; };  // without any low
  CHECK(watched(owed / 0.01 - 0.01, steady, constant).gain() == 1.0);
  CHECK(watched(owed / 0.01 + 0.02, steady, constant).gain() < 0.51);
  CHECK(watched(2.0 * owed / 0.01 + 0.06, steady, constant).gain() < 0.26);
  // In cycles that are too slow for a fresh force.
  const auto way = [](double t) { return 3e-3 * sine(t, 6.0); };
  const auto late = [&](double t) { return -300.0 * way(t - 4e-3); };
  const double given = M_PI * 300.0 * 9e-6 * std::sin(2.0 * M_PI * 6.0 * 4e-3);  // a cycle
  CHECK(watched((owed / given - 1.0) / 6.0, way, late, 4e-3).gain() == 1.0);
  CHECK(watched((owed / given + 2.0) / 6.0, way, late, 4e-3).gain() < 0.6);
  // A force of now is the world's own.
  CHECK(watched(2.0, steady, constant, 0.0).gain() == 1.0);
  // What the hand did before counts, and little that is given is forgotten with time.
  const auto there_and_back = [](double t) { return t < 0.5 ? -0.01 * t : -0.01 * (1.0 - t); };
  CHECK(watched(1.0 + owed / 0.01 - 0.02, there_and_back, constant).gain() == 1.0);
  const auto slow = [=](double t) { return 0.9 * owed / OscillationLimits{}.recovery * t; };
  CHECK(watched(100.0, slow, constant).gain() == 1.0);
}

TEST_CASE("oscillation: the noise of a sensor is no oscillation") {
  std::mt19937_64 random(1);
  OscillationDetector oscillation{OscillationLimits{}};
  double before = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const double now = 5e-5 * static_cast<double>(random() % 3);
    oscillation.observe(-3.0 * (now - before), kTick, kLate, true);
    before = now;
  }
  CHECK(oscillation.gain() == 1.0);
}

TEST_CASE("oscillation: the gain comes back, slowly, and work that is no number is none") {
  OscillationDetector oscillation{OscillationLimits{}};
  const auto shake = [&](int ticks) {
    for (int i = 0; i < ticks; ++i)
      oscillation.observe(i % 100 < 50 ? -1e-4 : 4e-5, kTick, kLate, true);
  };
  shake(1000);
  const double cut = oscillation.gain();
  CHECK(cut < 0.6);
  CHECK(cut >= OscillationLimits{}.least);
  oscillation.observe(std::numeric_limits<double>::quiet_NaN(), kTick, kLate, true);
  oscillation.observe(std::numeric_limits<double>::infinity(), kTick, kLate, true);
  for (int i = 0; i < 5000; ++i) oscillation.observe(0.0, kTick, kLate, true);
  const double expected = cut * std::exp(5.0 / OscillationLimits{}.recovery);
  CHECK(oscillation.gain() == Approx(expected).epsilon(1e-3));
  for (int i = 0; i < 100'000; ++i) oscillation.observe(0.0, kTick, kLate, true);
  CHECK(oscillation.gain() == 1.0);
  shake(1000);
  oscillation.reset();
  CHECK(oscillation.gain() == 1.0);
}
