#include "common/model/residual_file.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/model/upper_blocks.hpp"

namespace irdm {
namespace {

[[noreturn]] void damaged(const hdf5::File& file, const std::string& what) {
  throw Error(file.name(), std::string(kModalResidual) + " " + what,
              "make the model again with irdm-precompute");
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
  upper.for_each([&](int i, int j, const auto& block) {
    if (!block.allFinite()) damaged(file, "has numbers that are not finite");
    if (i == j && (block.diagonal().minCoeff() < 0.0F || block != block.transpose())) {
      damaged(file, "has a node whose own compliance is not symmetric or negative");
    }
  });
}

ModeReduction read_reduction(const hdf5::File& file) {
  const auto number = [&](const char* name) {
    const double value = file.read_double_attribute(kModalResidual, name);
    if (!std::isfinite(value) || value < 0.0) damaged(file, std::string("has no ") + name);
    return value;
  };
  ModeReduction reduction;
  reduction.elastic_modes =
      static_cast<int>(file.read_integer_attribute(kModalResidual, "elastic_modes"));
  reduction.samples = static_cast<int>(file.read_integer_attribute(kModalResidual, "samples"));
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
