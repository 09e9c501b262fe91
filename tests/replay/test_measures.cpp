// What compare measures of signals, against signals whose answers are known.
#include <complex>
#include <numbers>
#include <random>

#include "replay/compare/run_reader.hpp"
#include "replay/measures/force_difference.hpp"
#include "replay/measures/ringing.hpp"
#include "replay/measures/spectrum.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr double kDt = 0.002;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// value(t) in a row every 2 ms.
template <typename Value>
Points signal_of(int rows, const Value& value) {
  Points signal(rows, 3);
  for (int k = 0; k < rows; ++k) signal.row(k) = value(k * kDt).transpose();
  return signal;
}

std::size_t bin(const Spectrum& spectrum, double frequency) {
  const double step = spectrum.frequency.at(0);
  return static_cast<std::size_t>(std::lround(frequency / step)) - 1;
}

/// Free motion of an oscillator with mass, from a displacement: the textbook's.
struct Oscillator {
  double frequency;  ///< undamped [Hz]
  double ratio;      ///< of damping
  double amplitude;
  double phase;

  double ringing_frequency() const { return frequency * std::sqrt(1.0 - ratio * ratio); }
  double at(double t) const {
    const double w = kTwoPi * frequency;
    return amplitude * std::exp(-ratio * w * t) *
           std::cos(w * std::sqrt(1.0 - ratio * ratio) * t + phase);
  }
};

}  // namespace

TEST_CASE("a sine wave has its amplitude at its frequency, and a vector that of its length") {
  const double offset = 4.0;
  const Points signal = signal_of(1500, [&](double t) {
    return Vector3(offset + 0.3 * std::sin(kTwoPi * 20 * t + 0.4),
                   0.4 * std::cos(kTwoPi * 20 * t) + 0.01 * std::sin(kTwoPi * 125 * t), 0.0);
  });
  for (const Hold hold : {Hold::kMean, Hold::kLargest}) {
    const Spectrum found = amplitude_spectrum(signal, kDt, 1.0, hold);
    REQUIRE(found.frequency.size() == 250);
    CHECK(found.frequency.front() == Approx(1.0));
    CHECK(found.frequency.back() == Approx(250.0));
    CHECK(found.amplitude[bin(found, 20)] == Approx(0.5).epsilon(1e-9));
    CHECK(found.amplitude[bin(found, 125)] == Approx(0.01).epsilon(1e-9));
    CHECK(found.amplitude[bin(found, 60)] < 1e-12);
  }
}

TEST_CASE("a spectrum is that of Fourier's sum, windowed, and holds the largest segment") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const int n = 90;  // no power of two, odd factors
  Points signal = signal_of(n, [&](double) { return Vector3(normal(random), 0.0, 0.0); });
  const Spectrum found = amplitude_spectrum(signal, kDt, n * kDt, Hold::kMean);
  const double mean = signal.col(0).mean();
  for (int bin_number = 1; bin_number <= n / 2; ++bin_number) {
    std::complex<double> sum;
    for (int k = 0; k < n; ++k) {
      const double hann = 0.5 - 0.5 * std::cos(kTwoPi * k / n);
      sum += hann * (signal(k, 0) - mean) * std::polar(1.0, -kTwoPi * bin_number * k / n);
    }
    const double factor = bin_number == n / 2 ? 1.0 : 2.0;
    CHECK(found.amplitude[static_cast<std::size_t>(bin_number - 1)] ==
          Approx(factor * std::abs(sum) / (0.5 * n)).epsilon(1e-9));
  }
  // Twice as loud in the second half: the largest segment says so.
  Points two(2 * n, 3);
  two << signal, 2.0 * signal;
  const Spectrum loudest = amplitude_spectrum(two, kDt, n * kDt, Hold::kLargest);
  for (std::size_t i = 0; i < found.amplitude.size(); ++i) {
    CHECK(loudest.amplitude[i] >= 2.0 * found.amplitude[i] * (1 - 1e-12));
  }
  CHECK(amplitude_spectrum(signal.topRows(7), kDt, 1.0, Hold::kMean).frequency.empty());
}

TEST_CASE("frequency, damping and size of a damped oscillation come out as they were put in") {
  const Oscillator one{9.37, 0.03, 2e-3, 0.3};
  const Points decay = signal_of(400, [&](double t) { return Vector3(0.0, one.at(t), 0.0); });
  const auto found = find_ringing(decay, kDt);
  REQUIRE(found.size() == 1);
  CHECK(found[0].frequency == Approx(one.ringing_frequency()).epsilon(1e-7));
  CHECK(found[0].damping_ratio == Approx(one.ratio).epsilon(1e-6));
  CHECK(found[0].amplitude == Approx(one.amplitude).epsilon(1e-6));
}

TEST_CASE("several oscillations beside a constant and a drift that dies away, and with noise") {
  const std::vector<Oscillator> all{
      {9.4, 0.02, 1.0, 0.1}, {11.0, 0.05, 0.5, 2.0}, {37.0, 0.1, 0.7, -1.0}};
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double noise = GENERATE(0.0, 0.003);
  const Points decay = signal_of(500, [&](double t) {
    const Vector3 slow(0.8, 0.5 * std::exp(-3.0 * t), 0.0);
    return Vector3(slow + Vector3(all[0].at(t), all[1].at(t), all[2].at(t) + all[0].at(t)) +
                   noise * Vector3(normal(random), normal(random), normal(random)));
  });
  const auto found = find_ringing(decay, kDt);
  const double allowed = noise == 0.0 ? 1e-6 : 2e-3;
  CAPTURE(noise, found.size());
  REQUIRE(found.size() == 3);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(found[i].frequency == Approx(all[i].ringing_frequency()).epsilon(allowed));
    CHECK(found[i].damping_ratio == Approx(all[i].ratio).epsilon(20 * allowed));
  }
}

TEST_CASE("oscillations belong together that are each other's nearest") {
  const std::vector<Ringing> a{{10.0, 0.1, 1.0}, {11.0, 0.1, 1.0}, {40.0, 0.1, 1.0}};
  const std::vector<Ringing> b{{11.2, 0.1, 1.0}, {50.0, 0.1, 1.0}};
  const auto pairs = pairs_of(a, b);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].a.frequency == 11.0);
  CHECK(pairs[0].b.frequency == 11.2);
  CHECK(pairs_of(a, {}).empty());
  CHECK(pairs_of({}, b).empty());
}

TEST_CASE("what does not oscillate does not ring") {
  CHECK(find_ringing(Points::Zero(100, 3), kDt).empty());
  CHECK(find_ringing(Points::Ones(23, 3), kDt).empty());
  const Points creep =
      signal_of(200, [](double t) { return Vector3(std::exp(-4.0 * t), 1.0, 0.1 * t); });
  CHECK(find_ringing(creep, kDt).empty());
}

TEST_CASE("a struck object rings with the frequencies and the damping of its modes") {
  Model model = synthetic_cube(2, 3, 10);
  auto& modal = std::get<ModalResponse>(model.response);
  modal.angular_frequency = kTwoPi * Vector3(12.0, 31.0, 75.0);
  modal.decay_rate = Vector3(3.0, 5.0, 12.0);
  const auto engine = make_engine(std::make_shared<const Model>(model));
  const std::vector<NodalForce> blow{{4, Vector3(0.3, 1.0, -0.5)}};
  engine->advance(blow);
  Points node(500, 3);
  for (Eigen::Index k = 0; k < node.rows(); ++k) {
    node.row(k) = engine->free_displacement(7);
    engine->advance({});
  }
  const auto found = find_ringing(node, model.dt);
  REQUIRE(found.size() == 3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double w = modal.angular_frequency[i];
    const double sigma = modal.decay_rate[i];
    const Ringing& ringing = found[static_cast<std::size_t>(i)];
    CHECK(ringing.frequency == Approx(std::sqrt(w * w - sigma * sigma) / kTwoPi).epsilon(1e-5));
    CHECK(ringing.damping_ratio == Approx(sigma / w).epsilon(1e-4));
  }
}

TEST_CASE("forces are judged by their share, slow ones alone") {
  const Points a = signal_of(500, [](double) { return Vector3(0.0, 2.0, 0.0); });
  const auto off = [&](double by) {
    return force_difference(a, a + Points::Constant(500, 3, by / std::sqrt(3.0)), kDt);
  };
  CHECK(off(0.1).largest == Approx(0.05));
  CHECK(off(0.19).noticeable() == std::optional(false));
  CHECK(off(0.21).noticeable_time == 1.0);
  // As much, but at 100 Hz: a vibration, not a change of the force.
  const Points fast =
      signal_of(500, [](double t) { return Vector3(0.5 * std::sin(kTwoPi * 100 * t), 2.0, 0.0); });
  // What is left of it is at most part of a period in the 26 rows at an end.
  CHECK(force_difference(a, fast, kDt).largest < 0.5 * 1.54 / 26 / 2);
  // Small forces are judged as half a newton.
  const Points small = Points::Constant(500, 3, 0.001);
  CHECK(force_difference(small, 2.0 * small, kDt).largest == Approx(0.001 * std::sqrt(3.0) / 0.5));
}

TEST_CASE("a force that only one run has counts as time in contact, whichever run it is") {
  Points both = Points::Zero(500, 3);
  both.topRows(200).col(1).setConstant(5.0);
  Points one = both;
  one.bottomRows(200).col(1).setConstant(5.0);
  // The means have a part of it from 50 ms before, where nothing acts and nothing is judged.
  CHECK(force_difference(both, one, kDt).noticeable_time == Approx(200.0 / 400.0));
  CHECK(force_difference(one, both, kDt).noticeable_time == Approx(200.0 / 400.0));
}

TEST_CASE("a force is not judged where there was no contact") {
  const Points none = Points::Zero(10, 3);
  CHECK_FALSE(force_difference(none, none, kDt).noticeable().has_value());
}

TEST_CASE("means over a time are those of its rows, fewer at the ends") {
  const Points ramp = signal_of(100, [](double t) { return Vector3(t, 1.0, -t); });
  const Points means = smoothed(ramp, kDt, 0.02);
  CHECK((means.middleRows(5, 90) - ramp.middleRows(5, 90)).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(means(0, 0) == Approx(2.5 * kDt));
  CHECK(smoothed(ramp, 0.0, 0.02) == ramp);
}

TEST_CASE("onsets are where a force begins, and belong together by time") {
  std::vector<double> times;
  for (int k = 0; k < 1000; ++k) times.push_back(kDt * (k + 1));
  Points a = Points::Zero(1000, 3);
  a.middleRows(100, 50).col(1).setOnes();
  a.middleRows(110, 10).setZero();  // 20 ms: the same touch
  a.middleRows(400, 50).col(0).setOnes();
  a.row(900).setOnes();
  Points b = Points::Zero(1000, 3);
  b.middleRows(103, 50).col(1).setOnes();
  b.middleRows(398, 20).col(0).setOnes();
  const OnsetDelays found = onset_delays(onsets_of(a, times), onsets_of(b, times));
  REQUIRE(found.onsets.size() == 2);
  CHECK(found.onsets[0] == Approx(101 * kDt));
  CHECK(found.delays[0] == Approx(0.006));
  CHECK(found.delays[1] == Approx(-0.004));
  CHECK(found.alone == 1);
  CHECK(found.noticeable(kDt) == std::optional(true));
  CHECK_FALSE(found.noticeable(0.01));
  CHECK_FALSE(onset_delays({}, {1.0}).noticeable(kDt));
  CHECK(onset_delays({1.0}, {1.005}).noticeable(kDt) == std::optional(false));
}

TEST_CASE("a force after 50 ms without is another touch, after less the same") {
  std::vector<double> times;
  for (int k = 0; k < 500; ++k) times.push_back(kDt * (k + 1));
  const auto onsets_after = [&](int rows) {  // without a force
    Points force = Points::Zero(500, 3);
    force.middleRows(100, 20).setOnes();
    force.middleRows(120 + rows, 20).setOnes();
    return onsets_of(force, times);
  };
  CHECK(onsets_after(23) == std::vector<double>{times[100]});              // 46 ms
  CHECK(onsets_after(26) == std::vector<double>{times[100], times[146]});  // 52 ms
  CHECK(onsets_after(35) == std::vector<double>{times[100], times[155]});  // 70 ms
}

TEST_CASE("the threshold of vibration falls by 12 dB an octave to a tenth of a micrometre") {
  using perception::vibration_threshold;
  CHECK(vibration_threshold(250.0) == Approx(0.1e-6));
  CHECK(20.0 * std::log10(vibration_threshold(60.0) / vibration_threshold(120.0)) == Approx(12.0));
  CHECK(vibration_threshold(10.0) == vibration_threshold(40.0));
  CHECK(vibration_threshold(40.0) == Approx(3.85e-6).epsilon(0.01));
  CHECK(vibration_threshold(400.0) == Approx(0.1e-6));
}

TEST_CASE("a hand moves under a force as an oscillator that is integrated does") {
  const perception::Hand hand;
  const double frequency = 60.0;
  const double w = kTwoPi * frequency;
  double x = 0.0;
  double v = 0.0;
  double largest = 0.0;
  const double dt = 1e-6;
  for (int k = 0; k < 2'000'000; ++k) {  // what was at the start has died away after 1 s
    v += dt * (std::cos(w * k * dt) - hand.damping * v - hand.stiffness * x) / hand.mass;
    x += dt * v;
    if (k > 1'950'000) largest = std::max(largest, std::abs(x));
  }
  CHECK(perception::hand_compliance(hand, frequency) == Approx(largest).epsilon(1e-3));
}

TEST_CASE("a force vibrates a hand by its amplitude times the hand's compliance") {
  const perception::Hand hand;
  const double size = 0.05;
  const Points force = signal_of(
      1000, [&](double t) { return Vector3(1.0, size * std::sin(kTwoPi * 100 * t), 0.0); });
  const Vibration found = vibration_of(force, kDt, hand);
  const double motion = size * perception::hand_compliance(hand, 100.0);
  CHECK(found.frequency == Approx(100.0));
  CHECK(found.level == Approx(motion / perception::vibration_threshold(100.0)));
  CHECK(found.noticeable() == std::optional(found.level > 1.0));
  CHECK_FALSE(vibration_of(force, 0.05, hand).noticeable());  // up to 10 Hz
  CHECK_FALSE(Vibration{}.noticeable());
}

TEST_CASE("compliance is that of the line through zero, and along the force") {
  Points u(3, 3);
  u << 1e-3, 0, 0, 0, 3e-3, 4e-3, -9e-3, 0, 0;
  CHECK(largest_along(u, Vector3(0.0, 30.0, 40.0)) == Approx(5e-3));
  CHECK(largest_along(u, Vector3(2.0, 0.0, 0.0)) == Approx(1e-3));
  Compliance found;
  CHECK_FALSE(found.known());
  for (const double force : {0.01, 0.1, 0.4, 2.0}) found.add(0.006 * force, force);
  CHECK(found.value() == Approx(0.006));
}

TEST_CASE("intervals and spacing of frames") {
  const TimeInterval found = longest_interval({true, false, true, true, false, true, true, false});
  CHECK(found.first == 2);
  CHECK(found.count == 2);
  CHECK(longest_interval({false}).count == 0);
  CHECK(evenly_spaced({0.1, 0.2, 0.3001}));
  CHECK_FALSE(evenly_spaced({0.016, 0.034, 0.05}));
  CHECK_FALSE(evenly_spaced({1.0}));
}
