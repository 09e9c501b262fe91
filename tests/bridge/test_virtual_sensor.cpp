#include <cmath>
#include <vector>

#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

std::vector<Vector3> readings(const SensorParameters& parameters, int count) {
  VirtualSensor sensor(parameters);
  std::vector<Vector3> found;
  for (int i = 0; i < count; ++i) found.push_back(sensor.measure(Vector3::Zero()));
  return found;
}

}  // namespace

TEST_CASE("a sensor without resolution and noise is exact") {
  VirtualSensor sensor({});
  const Vector3 tip(0.123456789, -1e-9, M_PI);
  CHECK(sensor.measure(tip) == tip);
}

TEST_CASE("a sensor rounds each coordinate to its resolution") {
  constexpr double kStep = 5.5e-5;
  VirtualSensor sensor({.resolution = kStep});
  for (int i = -500; i < 500; ++i) {
    const Vector3 tip = Vector3(1.1e-6, -2.3e-6, 3.7e-6) * i;
    const Vector3 measured = sensor.measure(tip);
    REQUIRE((measured - tip).cwiseAbs().maxCoeff() <= 0.5 * kStep * (1.0 + 1e-9));
    for (const double coordinate : measured) {
      const double steps = coordinate / kStep;
      REQUIRE(std::abs(steps - std::round(steps)) < 1e-9);
    }
  }
}

TEST_CASE(
    "noise has its standard deviation, no mean, and coordinates that know nothing of another") {
  constexpr double kNoise = 1e-5;
  constexpr int kCount = 20'000;
  Matrix3 covariance = Matrix3::Zero();
  Vector3 mean = Vector3::Zero();
  double next = 0.0;
  Vector3 last = Vector3::Zero();
  for (const Vector3& reading : readings({.noise = kNoise}, kCount)) {
    mean += reading / kCount;
    covariance += reading * reading.transpose() / kCount;
    next += reading.dot(last) / kCount;
    last = reading;
  }
  // Four standard errors.
  const double tolerance = 4.0 / std::sqrt(kCount);
  CHECK(mean.cwiseAbs().maxCoeff() < kNoise * tolerance);
  CHECK(((covariance / (kNoise * kNoise)) - Matrix3::Identity()).cwiseAbs().maxCoeff() <
        std::sqrt(2.0) * tolerance);
  CHECK(std::abs(next) < 3.0 * kNoise * kNoise * tolerance);
}

TEST_CASE("the same seed gives the same noise, another seed another") {
  const auto one = readings({.noise = 1e-3, .seed = 5}, 100);
  CHECK(one == readings({.noise = 1e-3, .seed = 5}, 100));
  CHECK(one != readings({.noise = 1e-3, .seed = 6}, 100));
}
