#include <limits>

#include "simulation/step/sample_path.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

Vector3 along_x(double x) {
  return Vector3(x, 0, 0);
}

}  // namespace

TEST_CASE("sample path: a told tip is where the samples are") {
  SamplePath path;
  path.begin(Vector3::Zero());
  for (int k = 1; k <= 10; ++k) path.add(along_x(0.001 * k));
  CHECK(path.follow(along_x(0.0035), kNoBound).isApprox(along_x(0.0035), 0.02));
  CHECK(path.follow(along_x(0.006), kNoBound).isApprox(along_x(0.006), 0.02));
  CHECK(path.ahead(along_x(1000.0)) == along_x(0.01));
  // Aside of the way, places are as near for longer.
  CHECK(path.follow(Vector3(0.008, 0.0005, 0), kNoBound).x() == Approx(0.008).margin(3e-4));
  // It never goes back, and not beyond the newest sample.
  CHECK(path.follow(Vector3::Zero(), kNoBound).x() >= 0.0077);
  CHECK(path.follow(along_x(1.0), kNoBound) == along_x(0.01));
}

TEST_CASE("sample path: a slow tip is followed as it goes, there and back") {
  SamplePath path;
  path.begin(Vector3::Zero());
  for (int k = 1; k <= 20; ++k) {
    const Vector3 tip = along_x(1e-5 * (k <= 10 ? k : 20 - k));
    path.add(tip);
    CHECK(path.follow(tip, kNoBound) == tip);
  }
}

TEST_CASE("sample path: who does not move has no way, whatever is told") {
  SamplePath path;
  path.begin(along_x(0.02));
  for (int k = 0; k < 100; ++k) {
    path.add(along_x(0.02));
    CHECK(path.follow(Vector3(k % 2, 1.0, 0), kNoBound) == along_x(0.02));
  }
}

TEST_CASE(
    "sample path: a way there and back is gone once, in its order, no faster than is allowed") {
  SamplePath path;
  path.begin(Vector3::Zero());
  for (const double x : {0.01, 0.02, 0.01, 0.0}) path.add(along_x(x));
  CHECK(path.follow(along_x(0.015), kNoBound).x() == Approx(0.015).margin(1e-4));
  CHECK(path.follow(along_x(0.02), kNoBound).x() == Approx(0.02).margin(1e-4));
  CHECK(path.follow(Vector3::Zero(), 0.004).x() == Approx(0.016).margin(1e-4));
  CHECK(path.follow(Vector3::Zero(), kNoBound) == Vector3::Zero());
  CHECK(path.follow(along_x(0.02), kNoBound) == Vector3::Zero());
}

TEST_CASE("sample path: of many samples the oldest are skipped") {
  SamplePath path;
  path.begin(Vector3::Zero());
  for (int k = 1; k <= 1000; ++k) path.add(along_x(0.001 * k));
  CHECK(path.follow(Vector3::Zero(), kNoBound).x() == Approx(1.0 - 0.001 * 64));
}
