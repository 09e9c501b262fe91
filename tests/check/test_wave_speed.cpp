#include <vector>

#include "precompute/check/lines.hpp"
#include "precompute/check/wave_speed.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

Model cube_in_double(const irdm::test::FemCube& cube) {
  Model model = *irdm::test::fem_cube(cube);
  auto& response = std::get<ModalResponse>(model.response);
  if (const auto* single = std::get_if<RowMatrix<float>>(&response.shapes)) {
    const RowMatrix<double> shapes = single->cast<double>();
    response.shapes = shapes;
  }
  return model;
}

}  // namespace

TEST_CASE("speeds of the paper's material and Rayleigh's for well-known Poisson ratios") {
  const WaveSpeeds paper = theoretical_speeds({2000.0, 0.49, 110.0, 8.0, 2e-4});
  CHECK(paper.shear == Approx(std::sqrt(2000.0 / (2.98 * 110.0))));
  CHECK(paper.dilatational == Approx(17.64).epsilon(1e-3));
  // Viktorov, Rayleigh and Lamb Waves, 1967: 0.9194 for 1/4; (3 - sqrt 5) for 0 under the root,
  // exact.
  const WaveSpeeds quarter = theoretical_speeds({1000.0, 0.25, 100.0, 0.0, 0.0});
  CHECK(quarter.rayleigh / quarter.shear == Approx(0.9194).epsilon(1e-4));
  const WaveSpeeds zero = theoretical_speeds({1000.0, 0.0, 100.0, 0.0, 0.0});
  CHECK(zero.rayleigh / zero.shear == Approx(std::sqrt(3.0 - std::sqrt(5.0))).epsilon(1e-9));
}

TEST_CASE("a pulse that travels over the surface is found with its speed") {
  Model model = irdm::test::synthetic_cube(12, 3, 200);
  model.body.support = Support::kFixed;  // the pulse is all that moves
  const int b = wave_source(model);
  const Vector3 source = model.mesh.rest_position(b / 3);
  CHECK(source.norm() == Approx(0.06));
  const double speed = GENERATE(2.0, 6.0);
  const double dt = GENERATE(0.0005, 0.002);
  RowMatrix<double> column = RowMatrix<double>::Zero(100, model.degrees_of_freedom());
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const double passes = (model.mesh.rest_position(i) - source).norm() / speed;
    for (int s = 0; s < 100; ++s) {
      const double t = (s + 1) * dt - passes - 0.01;
      column(s, 3 * i) = std::exp(-0.5 * t * t / (0.003 * 0.003));
    }
  }
  const MeasuredWave wave = measure_wave(model, b, column, dt);
  CHECK(wave.nodes > 50);
  CHECK(wave.peak.speed() == Approx(speed).epsilon(0.05));
  CHECK(wave.main.speed() == Approx(speed).epsilon(0.02));
  CHECK(wave.arrival.speed() == Approx(speed).epsilon(0.1));
  CHECK(wave.main.error < 0.02 / speed);
}

TEST_CASE("a response whose waves are faster than any of its material fails") {
  Model model = cube_in_double({.cells = 6});
  const double dt = wave_interval(model);
  const auto R = stored_response(std::get<ModalResponse>(model.response), dt);
  CHECK(wave_line(model, *R, dt, 10000).verdict == Verdict::kOk);
  model.material.youngs_modulus *= 0.01;  // waves of a tenth of the speed that it has
  INFO(wave_line(model, *R, dt, 10000).found);
  CHECK(wave_line(model, *R, dt, 10000).verdict == Verdict::kFail);
}

// Where the passages do not lie on a line, no speed is sound or wrong but by luck.
TEST_CASE("a mesh that is too coarse for its waves, or damps them away, is not judged", "[slow]") {
  for (const int cells : {4, 6}) {
    const auto moduli = cells == 4 ? std::vector{2e4, 1e5, 1e6, 1e7} : std::vector{2e4, 1e7};
    for (const double youngs_modulus : moduli) {
      const Model model =
          cube_in_double({.cells = cells, .youngs_modulus = youngs_modulus, .poisson_ratio = 0.45});
      const double dt = wave_interval(model);
      const auto R = stored_response(std::get<ModalResponse>(model.response), dt);
      const Line line = wave_line(model, *R, dt, 10000);
      INFO(cells << " cells, E = " << youngs_modulus << ": " << line.found);
      CHECK(line.verdict == Verdict::kNone);
    }
  }
}
