#include "common/model/residual_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/config/lab_ranges.hpp"
#include "common/model/model_fault.hpp"
#include "common/model/upper_blocks.hpp"

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

}  // namespace irdm
