// The surface with its edges rounded off, against sums over a disc laid round an edge.
#include <cmath>
#include <numbers>

#include "simulation/contact/smoothed_surface.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kTip = 0.02;          // radius [m]
constexpr double kDisc = 1.15 * kTip;  // radius [m]
constexpr double kAside = 0.0077;      // z of the way over the edge [m]

// The way from the middle of the top over its edge at +x and down the side; d from the edge [m].
Vector3 on_the_way(double d) {
  return d < 0.0 ? Vector3(kHalfEdge + d, kHalfEdge, kAside)
                 : Vector3(kHalfEdge, kHalfEdge - d, kAside);
}

struct Place {
  Vector3 position, normal;
};

// The mean of the disc's points at d, with the weights s^4 (1 - s^2)^2, and the normal of the
// surface that these means form: what lies beyond the edge moves downwards, the rest to the right.
Place summed(double d) {
  constexpr int kRings = 400;
  constexpr int kRays = 720;
  double whole = 0.0;
  double beyond = 0.0;
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < kRings; ++i) {
    const double s = (i + 0.5) / kRings;
    const double weight = s * std::pow(s, 4) * std::pow(1.0 - s * s, 2);
    for (int j = 0; j < kRays; ++j) {
      const double at = d + s * kDisc * std::cos(2.0 * std::numbers::pi * (j + 0.5) / kRays);
      sum += weight * on_the_way(at);
      whole += weight;
      if (at > 0.0) beyond += weight;
    }
  }
  return {sum / whole, Vector3(beyond, whole - beyond, 0.0).normalized()};
}

}  // namespace

TEST_CASE("rounded surface: round an edge it is the mean over the disc, with the normal of that",
          "[slow]") {
  const auto model = fem_cube({8});
  const RestSurface surface(model->mesh);
  SmoothedSurface rounded(surface, kTip);
  for (int i = -11; i <= 11; ++i) {
    const double d = 0.1 * i * kDisc;
    CAPTURE(d);
    const SmoothedSurface::Place place = rounded.at(surface.closest(on_the_way(d)).point);
    const Place expected = summed(d);
    CHECK((place.position - expected.position).norm() < 1e-3 * kDisc);
    CHECK((place.normal - expected.normal).norm() < 0.02);
  }
  // On a flat part it is the point itself.
  const SmoothedSurface::Place flat = rounded.at(surface.closest(on_the_way(-1.3 * kDisc)).point);
  CHECK((flat.position - on_the_way(-1.3 * kDisc)).norm() < 1e-15);
  CHECK((flat.normal - Vector3(0, 1, 0)).norm() < 1e-14);
}

TEST_CASE("rounded surface: an edge bends no more than a circle of 0.7 discs, and smoothly",
          "[slow]") {
  const auto model = fem_cube({8});
  const RestSurface surface(model->mesh);
  SmoothedSurface rounded(surface, kTip);
  constexpr double kStep = 0.05 * kDisc;
  SmoothedSurface::Place last = rounded.at(surface.closest(on_the_way(-1.2 * kDisc)).point);
  double last_bend = 0.0;
  double turned = 0.0;
  for (double d = -1.2 * kDisc + kStep; d < 1.2 * kDisc; d += kStep) {
    CAPTURE(d);
    const SmoothedSurface::Place place = rounded.at(surface.closest(on_the_way(d)).point);
    const double angle = std::acos(std::min(1.0, place.normal.dot(last.normal)));
    const double bend = angle * kDisc / (place.position - last.position).norm();
    CHECK(bend < 1.05 / 0.7);
    CHECK(std::abs(bend - last_bend) < 0.3);
    turned += angle;
    last = place;
    last_bend = bend;
  }
  CHECK(turned == Approx(0.5 * std::numbers::pi).epsilon(1e-3));
}
