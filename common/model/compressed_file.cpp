#include "common/model/compressed_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/lab_ranges.hpp"
#include "common/error.hpp"
#include "common/response/compressed_response.hpp"

namespace irdm {
namespace {

constexpr int kMostEarlySteps = 1024;
constexpr double kOwnAsymmetry = 0.1;  // of a node's own response, as a share of its largest
constexpr float kLongestShape = 2.0F;  // rightly 1

void require(const hdf5::File& file, bool holds, const std::string& what) {
  if (!holds) {
    throw Error(file.name(), std::string(kCompressedGroup) + " " + what,
                "make it again with irdm-precompute compress");
  }
}

void write_complex(hdf5::File& file, const char* dataset, const Eigen::VectorXcd& values) {
  file.write<double>(dataset, {static_cast<hsize_t>(values.size()), 2},
                     reinterpret_cast<const double*>(values.data()));
}

Eigen::VectorXcd read_complex(const hdf5::File& file, const char* dataset, hsize_t count) {
  const auto values = file.read<double>(dataset, {count, 2});
  Eigen::VectorXcd numbers(static_cast<Eigen::Index>(count));
  for (Eigen::Index j = 0; j < numbers.size(); ++j) {
    const auto at = static_cast<std::size_t>(2 * j);
    numbers(j) = {values[at], values[at + 1]};
  }
  return numbers;
}

bool all_within(const std::vector<float>& values, double lowest, double highest) {
  return std::ranges::all_of(values, [range = between(lowest, highest)](float value) {
    return range.contains(static_cast<double>(value));
  });
}

void check_numbers(const hdf5::File& file, const CompressedResponse& response) {
  constexpr double kMost = lab::kCompliance.highest;
  constexpr double kLargestInteger = 32768.0;
  require(file, all_within(response.early_scale, 0.0, kMost / kLargestInteger),
          "has an early_scale that is negative, not finite or out of range");
  const auto* early = std::get_if<std::vector<float>>(&response.early);
  require(file, early == nullptr || all_within(*early, -kMost, kMost),
          "has an early part that is not finite or out of range");
  require(file, response.shapes.allFinite(), "has shapes that are not finite");
  require(
      file,
      response.shapes.cols() == 0 || response.shapes.colwise().norm().maxCoeff() < kLongestShape,
      "has shapes that are much longer than 1");
}

// What a node does at its own place: symmetric, and along the force.
void check_own_responses(const hdf5::File& file, const CompressedResponse& response, int nodes) {
  for (int i = 0; i < nodes; ++i) {
    Matrix3 sum;  // over the early steps
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        sum(a, b) = with_early(response, i, a, i, b, [&](const auto* numbers, double scale) {
          double total = 0.0;
          for (int s = 0; s < response.fir_steps; ++s) total += static_cast<double>(numbers[s]);
          return scale * total;
        });
      }
    }
    require(file, sum.diagonal().minCoeff() >= 0.0, "gives way against a force");
    require(
        file,
        (sum - sum.transpose()).cwiseAbs().maxCoeff() <= kOwnAsymmetry * sum.diagonal().maxCoeff(),
        "has a node whose own response is not symmetric");
  }
}

void check_poles(const hdf5::File& file, const CompressedResponse& response) {
  require(file, response.pole.allFinite() && response.amplitude.allFinite(),
          "has poles that are not finite");
  require(file, response.amplitude.cwiseAbs().sum() <= lab::kCompliance.highest,
          "has amplitudes out of range");
  require(file, response.pole.size() == 0 || response.pole.cwiseAbs().maxCoeff() < 1.0,
          "has a pole that does not decay");
  const auto& shape = response.pole_shape;
  require(file,
          std::is_sorted(shape.begin(), shape.end()) &&
              (shape.empty() || (shape.front() >= 0 && shape.back() < response.shape_count())),
          "has poles of shapes that it has not, or not in their order");
}

}  // namespace

void write_compressed(hdf5::File& file, const CompressedResponse& response,
                      const CompressionError& error) {
  const auto dof = static_cast<hsize_t>(response.shapes.rows());
  const auto steps = static_cast<hsize_t>(response.fir_steps);
  std::visit(
      [&]<typename Scalar>(const std::vector<Scalar>& early) {
        file.write<Scalar>(kCompressedEarly, {early.size() / 9 / steps, 9, steps}, early.data());
      },
      response.early);
  if (!response.early_scale.empty()) {
    file.write<float>(kCompressedEarlyScale, {response.early_scale.size() / 9, 9},
                      response.early_scale.data());
  }
  file.write<float>(kCompressedShapes, {dof, static_cast<hsize_t>(response.shapes.cols())},
                    response.shapes.data());
  file.write<std::int32_t>(kCompressedPoleShape, {response.pole_shape.size()},
                           response.pole_shape.data());
  write_complex(file, kCompressedPole, response.pole);
  write_complex(file, kCompressedAmplitude, response.amplitude);
  file.write_attribute(kCompressedGroup, "early_steps", static_cast<std::int64_t>(steps));
  file.write_attribute(kCompressedGroup, "requested_error", error.requested);
  file.write_attribute(kCompressedGroup, "displacement_error", error.displacement);
  file.write_attribute(kCompressedGroup, "displacement_error_rms", error.displacement_rms);
  file.write_attribute(kCompressedGroup, "force_error", error.force);
  file.write_attribute(kCompressedGroup, "measured_columns",
                       static_cast<std::int64_t>(error.measured_columns));
}

CompressedResponse read_compressed(const hdf5::File& file, const Model& model) {
  if (!file.exists(kCompressedGroup)) {
    throw Error(file.name(), "has no compressed response",
                "use another engine, or make one with irdm-precompute compress");
  }
  CompressedResponse response;
  const std::int64_t early = file.read_integer_attribute(kCompressedGroup, "early_steps");
  require(file, early >= 1 && early <= kMostEarlySteps, "has fir_steps out of range");
  response.fir_steps = static_cast<int>(early);
  const auto nodes = static_cast<std::size_t>(model.mesh.surface_node_count());
  const hdf5::Shape shape{early_entries(nodes) / 9, 9, static_cast<hsize_t>(early)};
  require(file, file.stored_shape(kCompressedEarly) == shape, "has an early part of another shape");
  const bool integers = file.stores_integers(kCompressedEarly);
  require(file, integers == file.exists(kCompressedEarlyScale),
          integers ? "has an early part in 16 bits without its early_scale"
                   : "has an early_scale for an early part that is not in 16 bits");
  if (integers) {
    response.early = file.read<std::int16_t>(kCompressedEarly, shape);
    response.early_scale = file.read<float>(kCompressedEarlyScale, {shape[0], shape[1]});
  } else {
    response.early = file.read<float>(kCompressedEarly, shape);
  }
  const auto dof = static_cast<hsize_t>(model.degrees_of_freedom());
  const auto shapes = file.read<float>(kCompressedShapes, {dof, 0});
  response.shapes = Eigen::Map<const RowMatrix<float>>(
      shapes.data(), static_cast<Eigen::Index>(dof),
      static_cast<Eigen::Index>(shapes.size() / std::max<std::size_t>(1, dof)));
  response.pole_shape = file.read<std::int32_t>(kCompressedPoleShape, {0});
  response.pole = read_complex(file, kCompressedPole, response.pole_shape.size());
  response.amplitude = read_complex(file, kCompressedAmplitude, response.pole_shape.size());
  check_numbers(file, response);
  check_own_responses(file, response, model.mesh.surface_node_count());
  check_poles(file, response);
  return response;
}

CompressionError read_compression_error(const hdf5::File& file) {
  const auto number = [&](const char* name) {
    return file.read_double_attribute(kCompressedGroup, name);
  };
  return {number("requested_error"), number("displacement_error"), number("displacement_error_rms"),
          number("force_error"),
          static_cast<int>(file.read_integer_attribute(kCompressedGroup, "measured_columns"))};
}

}  // namespace irdm
