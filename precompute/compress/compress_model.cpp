#include "precompute/compress/compress_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <span>

#include "common/error.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/compressed_response.hpp"
#include "precompute/blas.hpp"
#include "precompute/compress/joint_shapes.hpp"
#include "precompute/compress/measured_error.hpp"
#include "precompute/compress/pole_fit.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMostAttempts = 6;
constexpr int kInitialFirSteps = 16;

// Shares of the allowed error, root mean square over the columns; the largest column's is about
// twice that.
constexpr double kOfSpace = 0.30;
constexpr double kOfTime = 0.10;
constexpr double kOfShapes = 0.25;
constexpr double kOfPoles = 0.20;

constexpr float kLargestInteger = 32767.0F;

struct Parts {
  RowMatrix<double> shapes;  // (3n, r)
  RowMatrix<double> tail;    // (L, r)
};

Parts identify(const DenseInput& input, const Survey& found, double error, const Console& console) {
  const int r = directions_for(found.space_values, kOfSpace * error);
  const int K = directions_for(found.time_values, kOfTime * error);
  const Core core = project(input, found, r, K, console);
  const double tail_norm = core.matrices.cast<double>().norm();
  const JointShapes joint = joint_shapes(core, kOfShapes * error * found.norm / tail_norm, console);
  Parts parts;
  product(core.space.cast<double>(), Of::kItself, joint.shapes, Of::kItself, parts.shapes);
  product(core.time, Of::kItself, joint.responses, Of::kItself, parts.tail);
  return parts;
}

std::vector<PoleFit> fit_all(const Parts& parts, double error, const Console& console) {
  const auto count = static_cast<int>(parts.tail.cols());
  std::vector<PoleFit> fits(static_cast<std::size_t>(count));
  const double each = error / std::sqrt(static_cast<double>(count));
  constexpr int kAtOnce = 32;
  Progress progress(console, "poles", count);
  for (int first = 0; first < count; first += kAtOnce) {
    const int last = std::min(first + kAtOnce, count);
#pragma omp parallel for schedule(dynamic)
    for (int i = first; i < last; ++i) {
      fits[static_cast<std::size_t>(i)] = fit_poles(parts.tail.col(i), each);
    }
    progress.update(last);
  }
  return fits;
}

// The numbers of each entry in 32767ths of its largest.
void set_integers(const std::vector<float>& fir, CompressedResponse& response) {
  const auto steps = static_cast<std::size_t>(response.fir_steps);
  std::vector<std::int16_t> integers(fir.size());
  for (std::size_t first = 0; first < fir.size(); first += steps) {
    const std::span<const float> entry(fir.data() + first, steps);
    float largest = 0.0F;
    for (const float value : entry) largest = std::max(largest, std::abs(value));
    const float scale = largest / kLargestInteger;
    response.fir_scale.push_back(scale);
    if (!(scale > 0.0F)) continue;
    std::ranges::transform(
        entry, integers.begin() + static_cast<std::ptrdiff_t>(first), [scale](float value) {
          const float share = std::round(value / scale);
          return static_cast<std::int16_t>(std::clamp(share, -kLargestInteger, kLargestInteger));
        });
  }
  response.fir = std::move(integers);
}

// Shapes that need no pole are left out.
CompressedResponse assemble(const Survey& found, const Parts& parts,
                            const std::vector<PoleFit>& fits) {
  CompressedResponse response;
  response.fir_steps = found.fir_steps;
  set_integers(found.fir, response);
  std::vector<Eigen::Index> used;
  std::vector<std::complex<double>> poles, amplitudes;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].pole.size() == 0) continue;
    for (Eigen::Index j = 0; j < fits[i].pole.size(); ++j) {
      response.pole_shape.push_back(static_cast<int>(used.size()));
      poles.push_back(fits[i].pole(j));
      amplitudes.push_back(fits[i].amplitude(j));
    }
    used.push_back(static_cast<Eigen::Index>(i));
  }
  response.shapes = parts.shapes(Eigen::all, used).cast<float>();
  const auto count = static_cast<Eigen::Index>(poles.size());
  response.pole = Eigen::Map<const Eigen::VectorXcd>(poles.data(), count);
  response.amplitude = Eigen::Map<const Eigen::VectorXcd>(amplitudes.data(), count);
  return response;
}

double bytes(const CompressedResponse& response) {
  const double fir = std::visit(
      [](const auto& numbers) {
        return static_cast<double>(numbers.size() * sizeof(numbers.front()));
      },
      response.fir);
  const double scales = 4.0 * static_cast<double>(response.fir_scale.size());
  return fir + scales + 4.0 * static_cast<double>(response.shapes.size()) +
         36.0 * response.pole_count();
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
  return text;
}

[[noreturn]] void not_reached(const std::string& name, const CompressionError& error) {
  throw Error(name,
              "cannot be compressed to an error of " + percent(error.requested) + ": " +
                  percent(error.displacement) + " of displacement and " + percent(error.force) +
                  " of force is the best that was reached",
              "allow more with --error, or keep more steps as they are with --fir-steps; R that "
              "is not reciprocal or not linear cannot be compressed (irdm-precompute check)");
}

void check_fir_steps(const DenseInput& input, int fir_steps) {
  if (fir_steps >= 1 && 4 * fir_steps < input.steps()) return;
  throw Error(input.name(),
              "has " + std::to_string(input.steps()) + " steps, too few to keep " +
                  std::to_string(fir_steps) + " of them and compress the rest",
              "use fewer --fir-steps, or precompute more steps");
}

double larger(const CompressionError& error) {
  return std::max(error.displacement, error.force);
}

}  // namespace

CompressionSummary compress_model(const std::filesystem::path& input,
                                  const std::filesystem::path& output,
                                  const std::filesystem::path& temporary,
                                  const CompressSettings& settings, const Console& console) {
  const DenseInput dense(input);
  const bool automatic = settings.fir_steps == 0;
  const int most_fir_steps = (dense.steps() - 1) / 4;
  const int fir_steps =
      automatic ? std::min(kInitialFirSteps, std::max(1, most_fir_steps)) : settings.fir_steps;
  check_fir_steps(dense, fir_steps);
  Survey found = survey(dense, fir_steps, console);
  double finer = 1.0;
  CompressionError best;
  best.requested = settings.error;
  best.displacement = best.force = 1e300;
  int attempts = 0;  // with as many FIR steps
  int in_vain = 0;
  double previous = std::numeric_limits<double>::infinity();
  while (true) {
    const double aim = finer * settings.error;
    const Parts parts = identify(dense, found, aim, console);
    CompressedResponse response =
        assemble(found, parts, fit_all(parts, kOfPoles * aim * found.norm, console));
    CompressionError error = measure_error(response, dense, console);
    if (larger(error) > settings.error) {  // perhaps by what 16 bits leave out
      response.fir = found.fir;
      response.fir_scale.clear();
      error = measure_error(response, dense, console);
    }
    error.requested = settings.error;
    console.line("  " + std::to_string(response.shape_count()) + " shapes, " +
                 std::to_string(response.pole_count()) + " poles: error " +
                 percent(error.displacement) + " of displacement (rms " +
                 percent(error.displacement_rms) + "), " + percent(error.force) + " of force");
    if (larger(error) <= settings.error) {
      ModelFileWriter writer(output, temporary);
      writer.write_description(dense.description());
      writer.write_compressed(response, error);
      writer.commit();
      return {error,         found.fir_steps, response.shape_count(), response.pole_count(),
              dense.bytes(), bytes(response)};
    }
    // Shapes and poles take little room beside FIR steps: more of them as long as they help as
    // much as they have to.
    ++attempts;
    const double expected =
        larger(error) * std::pow(larger(error) / previous, kMostAttempts - attempts);
    previous = larger(error);
    in_vain = larger(error) < 0.95 * larger(best) ? 0 : in_vain + 1;
    if (larger(error) < larger(best)) best = error;
    if (automatic && 2 * found.fir_steps <= most_fir_steps && expected > settings.error) {
      found = survey(dense, 2 * found.fir_steps, console);
      attempts = in_vain = 0;
      previous = std::numeric_limits<double>::infinity();
    } else if (attempts < kMostAttempts && in_vain < 2) {
      finer *= std::clamp(0.7 * settings.error / larger(error), 0.15, 0.6);
    } else {
      break;
    }
  }
  not_reached(dense.name(), best);
}

}  // namespace irdm::precompute
