#include <complex>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>
#include <tuple>

#include "common/model/model_file.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/compressed_response.hpp"
#include "common/response/stored_response.hpp"
#include "precompute/compress/compress_model.hpp"
#include "precompute/compress/dense_input.hpp"
#include "precompute/compress/measured_error.hpp"
#include "precompute/compress/pole_fit.hpp"
#include "tests/check/dense_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;
using irdm::test::ChildProcess;
using irdm::test::DenseCube;

namespace {

struct Workshop : irdm::test::TemporaryFolder {
  std::ostringstream heard;
  std::filesystem::path file(const std::string& name) const { return path() / name; }
  CompressionSummary compress(const std::string& to, const CompressSettings& settings = {}) {
    return compress_model(file("dense.h5"), file(to), file("part"), settings, {heard, false});
  }
};

Eigen::VectorXd oscillations(const std::vector<std::complex<double>>& poles,
                             const std::vector<std::complex<double>>& amplitudes, int steps) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(steps);
  for (std::size_t j = 0; j < poles.size(); ++j) {
    for (int l = 0; l < steps; ++l) y(l) += (amplitudes[j] * std::pow(poles[j], l)).real();
  }
  return y;
}

}  // namespace

TEST_CASE("pole fit finds the poles and amplitudes that a sequence was made of") {
  const std::vector<std::complex<double>> poles{std::polar(0.98, 0.3), std::polar(0.9, 1.1)};
  const std::vector<std::complex<double>> amplitudes{{1.0, -0.5}, {0.3, 0.4}};
  const Eigen::VectorXd y = oscillations(poles, amplitudes, 200);
  const PoleFit fit = fit_poles(y, 1e-9 * y.norm());
  REQUIRE(fit.pole.size() == 2);
  CHECK(fit.error < 1e-9 * y.norm());
  for (Eigen::Index j = 0; j < 2; ++j) {
    const std::size_t which = std::abs(fit.pole(j) - poles[0]) < 0.1 ? 0 : 1;
    CHECK(std::abs(fit.pole(j) - poles[which]) < 1e-8);
    CHECK(std::abs(fit.amplitude(j) - amplitudes[which]) < 1e-8);
  }
}

TEST_CASE("pole fit takes no more poles than the error needs, and none that grows") {
  const Eigen::VectorXd y =
      oscillations({std::polar(0.98, 0.3), std::polar(0.9, 1.1)}, {{1.0, 0.0}, {0.01, 0.0}}, 200);
  CHECK(fit_poles(y, 1.1 * y.norm()).pole.size() == 0);
  CHECK(fit_poles(y, 0.05 * y.norm()).pole.size() == 1);
  const Eigen::VectorXd growing = oscillations({std::polar(1.01, 0.3)}, {{1.0, 0.0}}, 200);
  CHECK(fit_poles(growing, 0.0).pole.cwiseAbs().maxCoeff() < 1.0);
}

TEST_CASE("compress: the stated errors are those of the file, twice to the same bits", "[slow]") {
  const double allowed = GENERATE(0.03, 0.001);
  Workshop work;
  DenseCube cube(200);
  cube.write(work.file("dense.h5"));
  const CompressionSummary summary = work.compress("small.h5", {.error = allowed});
  work.compress("again.h5", {.error = allowed});
  CHECK(irdm::test::file_content(work.file("small.h5")) ==
        irdm::test::file_content(work.file("again.h5")));
  CHECK_FALSE(std::filesystem::exists(work.file("part")));
  CHECK(summary.error.displacement <= allowed);
  CHECK(summary.error.force <= allowed);
  CHECK(summary.error.measured_columns == cube.model.degrees_of_freedom());

  const Model model = read_model(work.file("small.h5"), ResponseKind::kCompressed);
  const auto& response = std::get<CompressedResponse>(model.response);
  const bool integers = !response.fir_scale.empty();
  CHECK(integers == (allowed > 1e-3));
  const auto R = stored_response(model);
  double largest = 0.0;
  for (int b = 0; b < model.degrees_of_freedom(); b += 5) {
    const RowMatrix<double> column = R->column(b, 200);
    double difference = 0.0;
    double size = 0.0;
    double fir = 0.0;
    double peak = 0.0;
    for (int s = 0; s < 200; ++s) {
      for (int a = 0; a < model.degrees_of_freedom(); ++a) {
        size += cube.at(s, a, b) * cube.at(s, a, b);
        difference += std::pow(column(s, a) - cube.at(s, a, b), 2);
        fir =
            std::max(fir, s < response.fir_steps ? std::abs(column(s, a) - cube.at(s, a, b)) : 0.0);
        peak = std::max(peak, std::abs(cube.at(s, a, b)));
      }
    }
    CHECK(fir < (integers ? 2e-5 : 1e-6) * peak);
    if (integers) CHECK(fir > 1e-6 * peak);
    largest = std::max(largest, std::sqrt(difference / size));
  }
  CHECK(largest <= summary.error.displacement * (1.0 + 1e-4));
  CHECK(largest > 0.2 * summary.error.displacement);
}

TEST_CASE("compress keeps as few FIR steps as shapes and poles can make up for") {
  const auto [shaken, error, kept] =
      GENERATE(std::tuple(false, 0.05, 16), std::tuple(true, 0.03, 32));
  Workshop work;
  DenseCube cube(200);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int dof = cube.model.degrees_of_freedom();
  for (int s = 16; shaken && s < 30; ++s) {  // what no poles go on from
    for (int b = 0; b < dof; ++b) {
      for (int a = 0; a <= b; ++a) {
        const double shake = uniform(random) * 0.1 * std::abs(cube.at(s, b, b));
        cube.at(s, a, b) += shake;
        if (a != b) cube.at(s, b, a) += shake;
      }
    }
  }
  cube.write(work.file("dense.h5"));
  CHECK(work.compress("small.h5", {.error = error}).fir_steps == kept);
}

TEST_CASE("a compressed response needs the scales that it was written with") {
  Workshop work;
  DenseCube cube(100);
  cube.write(work.file("dense.h5"));
  work.compress("small.h5", {.error = 0.1});
  Model model = read_model(work.file("small.h5"), ResponseKind::kCompressed);
  auto& response = std::get<CompressedResponse>(model.response);
  REQUIRE_FALSE(response.fir_scale.empty());
  const auto fir = std::get<std::vector<std::int16_t>>(response.fir);
  const auto m = static_cast<std::size_t>(response.fir_steps);
  // Of nodes 2 and 1: entry (2 3 / 2 + 1) 9 + 3 a + b.
  const std::size_t entry = 4 * 9 + 3 * 2 + 0;
  const double expected = static_cast<double>(response.fir_scale[entry]) * fir[entry * m + 1];
  CHECK(expected != 0.0);
  CHECK(fir_response(response, 2, 2, 1, 0, 1) == expected);
  CHECK(fir_response(response, 1, 0, 2, 2, 1) == expected);

  const auto write = [&](const std::string& name) {
    ModelFileWriter writer(work.file(name));
    writer.write_description(model);
    writer.write_compressed(response, {});
    writer.commit();
    return work.file(name);
  };
  response.fir_scale[entry] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_WITH(read_model(write("nan.h5"), ResponseKind::kCompressed),
                    ContainsSubstring("an early_scale that is negative, not finite"));
  response.fir_scale.resize(9);
  CHECK_THROWS_WITH(read_model(write("few.h5"), ResponseKind::kCompressed),
                    ContainsSubstring("early_scale has shape"));
  response.fir_scale.clear();
  CHECK_THROWS_WITH(read_model(write("none.h5"), ResponseKind::kCompressed),
                    ContainsSubstring("in 16 bits without its early_scale"));
  response.fir_scale.assign(fir.size() / m, 1.0F);
  response.fir = std::vector<float>(fir.size(), 1e-3F);
  CHECK_THROWS_WITH(read_model(write("single.h5"), ResponseKind::kCompressed),
                    ContainsSubstring("early_scale for an FIR part that is not in 16 bits"));
}

TEST_CASE("compress refuses what cannot be reached, and leaves nothing behind") {
  Workshop work;
  DenseCube cube(100);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int dof = cube.model.degrees_of_freedom();
  for (int b = 0; b < dof; ++b) {
    for (int s = 0; s < 100; ++s) {
      for (int a = 0; a < dof; ++a) cube.at(s, a, b) = 1e-3 * uniform(random);
    }
  }
  cube.write(work.file("dense.h5"));
  CHECK_THROWS_WITH(work.compress("small.h5", {.error = 0.01, .fir_steps = 8}),
                    ContainsSubstring("cannot be compressed to an error of 1 %"));
  CHECK_THROWS_WITH(work.compress("small.h5", {.error = 0.01, .fir_steps = 25}),
                    ContainsSubstring("100 steps, too few"));
  CHECK_FALSE(std::filesystem::exists(work.file("small.h5")));
  CHECK_FALSE(std::filesystem::exists(work.file("part")));
}

TEST_CASE("compress as a program: help, wrong usage, missing and wrong files") {
  Workshop work;
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{IRDM_PROGRAM, "compress"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    ChildProcess process(command, {.folder = work.path()});
    const int status = process.wait();
    return std::pair(status, process.err());
  };
  CHECK(run({"--help"}).first == 0);
  CHECK(run({}).first == 2);
  CHECK(run({"a.h5", "-o", "b.h5", "--error", "2"}).first == 2);
  const auto [status, err] = run({"missing.h5", "-o", "b.h5"});
  CHECK(status == 1);
  CHECK_THAT(err, ContainsSubstring("missing.h5"));
  {
    ModelFileWriter writer(work.file("bare.h5"));
    writer.write_description(DenseCube(20).model);
    writer.commit();
  }
  const auto bare = run({"bare.h5", "-o", "b.h5"});
  CHECK(bare.first == 1);
  CHECK_THAT(bare.second, ContainsSubstring("no dense response"));
}
