#include "common/model/compressed_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_check.hpp"
#include "common/response/compressed_response.hpp"

namespace irdm {
namespace {

[[noreturn]] void damaged(const hdf5::File& file, const std::string& what) {
  refuse_model(file.name(), std::string(kModalResidual) + " " + what);
}

void check_pattern(const hdf5::File& file, const UpperBlocks& upper) {
  const auto& start = upper.row_start;
  if (start.front() != 0 || !std::is_sorted(start.begin(), start.end()) ||
      start.back() != static_cast<std::int32_t>(upper.nodes.size())) {
    damaged(file, "has rows that are none");
  }
  for (int i = 0; i < upper.rows(); ++i) {
    const auto* begin = upper.nodes.data() + start[static_cast<std::size_t>(i)];
    const auto* end = upper.nodes.data() + start[static_cast<std::size_t>(i) + 1];
    const bool increasing = std::adjacent_find(begin, end, std::greater_equal<>()) == end;
    if (begin == end || *begin != i || *(end - 1) >= upper.rows() || !increasing) {
      damaged(file, "has columns that are none");
    }
  }
}

void check_blocks(const hdf5::File& file, const UpperBlocks& upper) {
  constexpr double kRounding = 1e-3;
  Eigen::Matrix3Xd own = Eigen::Matrix3Xd::Zero(3, upper.rows());
  upper.for_each([&](int i, int j, const auto& block) {
    if (!block.allFinite() ||
        block.cwiseAbs().maxCoeff() > static_cast<float>(lab::kCompliance.highest)) {
      damaged(file,
              "has numbers that are not finite or beyond " + number_text(lab::kCompliance.highest));
    }
    if (i != j) return;
    if (block.diagonal().minCoeff() < 0.0F || block != block.transpose()) {
      damaged(file, "has a node whose own compliance is not symmetric or negative");
    }
    own.col(i) = block.diagonal().template cast<double>();
  });
  // Of a positive semidefinite matrix no entry is above the geometric mean of the two diagonals.
  upper.for_each([&](int i, int j, const auto& block) {
    const Matrix3 most = (own.col(i) * own.col(j).transpose()).cwiseSqrt();
    if ((block.template cast<double>().cwiseAbs().array() > (1.0 + kRounding) * most.array())
            .any()) {
      damaged(file, "has nodes that give way to each other more than to themselves");
    }
  });
}

ModeReduction read_reduction(const hdf5::File& file) {
  const auto number = [&](const char* name) {
    const double value = file.read_double_attribute(kModalResidual, name);
    if (!std::isfinite(value) || value < 0.0) damaged(file, std::string("has no ") + name);
    return value;
  };
  const auto count = [&](const char* name) {
    const std::int64_t value = file.read_integer_attribute(kModalResidual, name);
    if (value < 0 || value > std::numeric_limits<int>::max()) {
      damaged(file, std::string("has no ") + name);
    }
    return static_cast<int>(value);
  };
  ModeReduction reduction;
  reduction.elastic_modes = count("elastic_modes");
  reduction.samples = count("samples");
  reduction.cut_off = number("cut_off");
  reduction.contact_radius = number("contact_radius");
  reduction.residual_radius = number("residual_radius");
  reduction.press_time = number("press_time");
  reduction.force_error = number("force_error");
  reduction.shape_error = number("shape_error");
  reduction.added_compliance = number("added_compliance");
  return reduction;
}

}  // namespace

void write_residual(hdf5::File& file, const ResidualCompliance& residual) {
  const UpperBlocks upper = upper_half(residual);
  file.write<std::int32_t>(kResidualRowStart, {upper.row_start.size()}, upper.row_start.data());
  file.write<std::int32_t>(kResidualNodes, {upper.nodes.size()}, upper.nodes.data());
  file.write<float>(kResidualBlocks, {upper.nodes.size(), 3, 3}, upper.blocks.data());
  const ModeReduction& reduction = residual.reduction;
  const auto whole = [&](const char* name, int value) {
    file.write_attribute(kModalResidual, name, static_cast<std::int64_t>(value));
  };
  whole("elastic_modes", reduction.elastic_modes);
  whole("samples", reduction.samples);
  file.write_attribute(kModalResidual, "cut_off", reduction.cut_off);
  file.write_attribute(kModalResidual, "contact_radius", reduction.contact_radius);
  file.write_attribute(kModalResidual, "residual_radius", reduction.residual_radius);
  file.write_attribute(kModalResidual, "press_time", reduction.press_time);
  file.write_attribute(kModalResidual, "force_error", reduction.force_error);
  file.write_attribute(kModalResidual, "shape_error", reduction.shape_error);
  file.write_attribute(kModalResidual, "added_compliance", reduction.added_compliance);
}

ResidualCompliance read_residual(const hdf5::File& file, int surface_nodes) {
  if (!file.exists(kModalResidual)) return {};
  UpperBlocks upper;
  upper.row_start =
      file.read<std::int32_t>(kResidualRowStart, {static_cast<hsize_t>(surface_nodes) + 1});
  upper.nodes = file.read<std::int32_t>(kResidualNodes, {0});
  upper.blocks = file.read<float>(kResidualBlocks, {upper.nodes.size(), 3, 3});
  check_pattern(file, upper);
  check_blocks(file, upper);
  ResidualCompliance residual = both_halves(upper);
  residual.reduction = read_reduction(file);
  return residual;
}

namespace {

constexpr int kMostFirSteps = 1024;
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
  require(file, all_within(response.fir_scale, 0.0, kMost / kLargestInteger),
          "has an early_scale that is negative, not finite or out of range");
  const auto* fir = std::get_if<std::vector<float>>(&response.fir);
  require(file, fir == nullptr || all_within(*fir, -kMost, kMost),
          "has an FIR part that is not finite or out of range");
  require(file, response.shapes.allFinite(), "has shapes that are not finite");
  require(
      file,
      response.shapes.cols() == 0 || response.shapes.colwise().norm().maxCoeff() < kLongestShape,
      "has shapes that are much longer than 1");
}

// What a node does at its own place: symmetric, and along the force.
void check_own_responses(const hdf5::File& file, const CompressedResponse& response, int nodes) {
  for (int i = 0; i < nodes; ++i) {
    Matrix3 sum;  // over the FIR steps
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        sum(a, b) = with_fir(response, i, a, i, b, [&](const auto* numbers, double scale) {
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
      [&]<typename Scalar>(const std::vector<Scalar>& fir) {
        file.write<Scalar>(kCompressedFir, {fir.size() / 9 / steps, 9, steps}, fir.data());
      },
      response.fir);
  if (!response.fir_scale.empty()) {
    file.write<float>(kCompressedFirScale, {response.fir_scale.size() / 9, 9},
                      response.fir_scale.data());
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
  const std::int64_t fir_steps = file.read_integer_attribute(kCompressedGroup, "early_steps");
  require(file, fir_steps >= 1 && fir_steps <= kMostFirSteps, "has early_steps out of range");
  response.fir_steps = static_cast<int>(fir_steps);
  const auto nodes = static_cast<std::size_t>(model.mesh.surface_node_count());
  const hdf5::Shape shape{fir_entries(nodes) / 9, 9, static_cast<hsize_t>(fir_steps)};
  require(file, file.stored_shape(kCompressedFir) == shape, "has an FIR part of another shape");
  const bool integers = file.stores_integers(kCompressedFir);
  require(file, integers == file.exists(kCompressedFirScale),
          integers ? "has an FIR part in 16 bits without its early_scale"
                   : "has an early_scale for an FIR part that is not in 16 bits");
  if (integers) {
    response.fir = file.read<std::int16_t>(kCompressedFir, shape);
    response.fir_scale = file.read<float>(kCompressedFirScale, {shape[0], shape[1]});
  } else {
    response.fir = file.read<float>(kCompressedFir, shape);
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
