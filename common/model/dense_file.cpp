#include "common/model/dense_file.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <mutex>

#include "common/config/range.hpp"
#include "common/hdf5/handle.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_check.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/modal_response.hpp"

namespace irdm {

UpperBlocks upper_half(const ResidualCompliance& all) {
  UpperBlocks upper;
  for (std::size_t i = 0; i + 1 < all.row_start.size(); ++i) {
    for (int k = all.row_start[i]; k < all.row_start[i + 1]; ++k) {
      const auto place = static_cast<std::size_t>(k);
      if (all.nodes[place] < static_cast<int>(i)) continue;
      upper.nodes.push_back(all.nodes[place]);
      const float* block = all.blocks.data() + 9 * place;
      upper.blocks.insert(upper.blocks.end(), block, block + 9);
    }
    upper.row_start.push_back(static_cast<std::int32_t>(upper.nodes.size()));
  }
  return upper;
}

// Rows are met in increasing order, so that each row's columns come out increasing.
ResidualCompliance both_halves(const UpperBlocks& upper) {
  ResidualCompliance all;
  all.row_start.assign(upper.row_start.size(), 0);
  upper.for_each([&](int i, int j, const auto&) {
    ++all.row_start[static_cast<std::size_t>(i) + 1];
    if (i != j) ++all.row_start[static_cast<std::size_t>(j) + 1];
  });
  for (std::size_t i = 1; i < all.row_start.size(); ++i) all.row_start[i] += all.row_start[i - 1];
  std::vector<int> next(all.row_start.begin(), all.row_start.end() - 1);
  all.nodes.resize(static_cast<std::size_t>(all.row_start.back()));
  all.blocks.resize(9 * all.nodes.size());
  const auto put = [&](int row, int column, const UpperBlocks::Block& block) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(row)]++);
    all.nodes[place] = column;
    Eigen::Map<UpperBlocks::Block>(all.blocks.data() + 9 * place) = block;
  };
  // Below the diagonal first: a row's columns before it come from rows that are met before it.
  upper.for_each([&](int i, int j, const auto& block) {
    put(i, j, block);
    if (i != j) put(j, i, block.transpose());
  });
  return all;
}

namespace {

void require_dense(const hdf5::File& file, bool holds, const std::string& what) {
  if (!holds) refuse_model(file.name(), what);
}

/// [s][a] of column b.
template <typename Scalar>
void read_column(const hdf5::File& file, const std::string& dataset, hsize_t b, hsize_t steps,
                 hsize_t dof, Scalar* column) {
  file.read_slab<Scalar>(dataset, {b, 0, 0}, {1, steps, dof}, column);
  require_dense(file,
                std::all_of(column, column + steps * dof,
                            [](Scalar value) {
                              return lab::kCompliance.contains(static_cast<double>(value));
                            }),
                dataset + " has numbers that are not finite or beyond " +
                    number_text(lab::kCompliance.highest));
}

// [s][a] to [a][s], in squares that stay in the cache.
template <typename Scalar>
void turn(const Scalar* column, hsize_t steps, hsize_t dof, Scalar* to) {
  constexpr hsize_t kSquare = 32;
  for (hsize_t s0 = 0; s0 < steps; s0 += kSquare) {
    for (hsize_t a0 = 0; a0 < dof; a0 += kSquare) {
      for (hsize_t a = a0; a < std::min(dof, a0 + kSquare); ++a) {
        for (hsize_t s = s0; s < std::min(steps, s0 + kSquare); ++s) {
          to[a * steps + s] = column[s * dof + a];
        }
      }
    }
  }
}

/// @param see called with the number of each column and the column
template <typename Scalar, typename See>
std::vector<Scalar> read_columns(const hdf5::File& file, const std::string& dataset,
                                 hsize_t columns, hsize_t steps, hsize_t dof, const See& see) {
  std::vector<Scalar> values(columns * steps * dof);
  std::vector<Scalar> column(steps * dof);
  for (hsize_t b = 0; b < columns; ++b) {
    read_column(file, dataset, b, steps, dof, column.data());
    see(b, column.data());
    turn(column.data(), steps, dof, values.data() + b * dof * steps);
  }
  return values;
}

// Of loads on the whole body; empty where there is none.
template <typename Scalar>
std::vector<Scalar> read_load(const hdf5::File& file, const std::string& dataset, hsize_t count,
                              hsize_t dof, hsize_t steps) {
  if (!file.exists(dataset)) return {};
  require_dense(file, file.stored_shape(dataset) == hdf5::Shape({count, steps, dof}),
                dataset + " must have the shape (" + std::to_string(count) + ", steps, 3n)");
  return read_columns<Scalar>(file, dataset, count, steps, dof, [](hsize_t, const Scalar*) {});
}

template <typename Scalar, typename Response>
void read_loads(const hdf5::File& file, Response& response) {
  const auto dof = static_cast<hsize_t>(response.degrees_of_freedom);
  const auto steps = static_cast<hsize_t>(response.steps);
  response.centrifugal = read_load<Scalar>(file, kDenseCentrifugal, kSpinProducts, dof, steps);
  std::vector<Scalar> gravity = read_load<Scalar>(file, kDenseGravity, 3, dof, steps);
  if (gravity.empty()) return;
  response.gravity =
      gravity_response(std::move(gravity), response.degrees_of_freedom, response.steps);
}

// All but R itself.
template <typename Response>
void read_frame(const hdf5::File& file, const Model& model, Response& response) {
  if (!file.exists(kDenseR)) {
    throw Error(file.name(), "has no dense response",
                "use engine = \"modal\" or precompute with storage = \"dense\" or \"both\"");
  }
  const auto dof = static_cast<hsize_t>(model.degrees_of_freedom());
  const auto steps = static_cast<hsize_t>(model.steps);
  require_dense(file, file.stored_shape(kDenseR) == hdf5::Shape({dof, steps, dof}),
                "/response/dense/R must have the shape (3n, steps, 3n)");
  response.degrees_of_freedom = model.degrees_of_freedom();
  response.steps = model.steps;
  if (file.element_size(kDenseR) == sizeof(double)) {
    read_loads<double>(file, response);
  } else {
    read_loads<float>(file, response);
  }
}

void require_sound(const hdf5::File& file, const DenseSamples& samples) {
  if (const auto fault = samples.fault()) {
    refuse_model(file.name(), std::string(kDenseR) + " " + *fault);
  }
}

// Calls with a number of the kind that the file has.
template <typename Function>
void with_number(std::size_t size, const Function& function) {
  if (size == sizeof(float)) {
    function(0.0F);
  } else {
    function(0.0);
  }
}

// R[0] and the sum of what follows it, of column b.
template <typename Scalar>
void keep(const std::vector<Scalar>& column, std::size_t b, StreamedResponse& response,
          std::vector<Scalar>& first) {
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  std::copy_n(column.begin(), dof, first.begin() + static_cast<std::ptrdiff_t>(b * dof));
  std::vector<double> sum(dof, 0.0);
  for (std::size_t i = dof; i < column.size(); ++i) sum[i % dof] += static_cast<double>(column[i]);
  std::ranges::transform(sum, response.rest.begin() + static_cast<std::ptrdiff_t>(b * dof),
                         [](double value) { return static_cast<float>(value); });
}

template <typename Scalar>
Eigen::MatrixXf as_single(const std::vector<Scalar>& first, const StreamedResponse& response) {
  const Eigen::Index dof = response.degrees_of_freedom;
  Eigen::MatrixXf matrix(dof, dof);
  for (Eigen::Index b = 0; b < dof; ++b) {
    for (Eigen::Index a = 0; a < dof; ++a) {
      matrix(a, b) = static_cast<float>(first[static_cast<std::size_t>(b * dof + a)]);
    }
  }
  return matrix;
}

}  // namespace

void check_dense_form(const hdf5::File& file) {
  constexpr H5Z_filter_t kZfp = 32013;  // registered at the HDF Group
  if (!file.exists(kDenseR)) return;
  const bool half = file.element_size(kDenseR) < sizeof(float);
  if (!half && !file.has_filter(kDenseR, kZfp)) return;
  throw Error(file.name(),
              std::string(kDenseR) + (half ? " is in half precision" : " is compressed by zfp") +
                  ", which is not read",
              "compute the model again; irdm-precompute compress makes dense R small");
}

DenseResponse read_dense(const hdf5::File& file, const Model& model) {
  DenseResponse response;
  read_frame(file, model, response);
  const auto dof = static_cast<hsize_t>(response.degrees_of_freedom);
  const auto steps = static_cast<hsize_t>(response.steps);
  DenseSamples samples(response.degrees_of_freedom, response.steps);
  const ColumnChecksums checksums(file, dof);
  with_number(file.element_size(kDenseR), [&]<typename Scalar>(Scalar) {
    response.values =
        read_columns<Scalar>(file, kDenseR, dof, steps, dof, [&](hsize_t b, const Scalar* column) {
          checksums.compare(b, column, steps * dof);
          samples.add(static_cast<int>(b), column);
        });
  });
  require_sound(file, samples);
  return response;
}

StreamedResponse read_streamed(const hdf5::File& file, const Model& model) {
  StreamedResponse response;
  read_frame(file, model, response);
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  const auto steps = static_cast<std::size_t>(response.steps);
  response.rest.resize(dof * dof);
  DenseSamples samples(response.degrees_of_freedom, response.steps);
  const ColumnChecksums checksums(file, dof);
  with_number(file.element_size(kDenseR), [&]<typename Scalar>(Scalar) {
    std::vector<Scalar> first(dof * dof);
    std::vector<Scalar> column(steps * dof);
    for (std::size_t b = 0; b < dof; ++b) {
      read_column(file, kDenseR, b, steps, dof, column.data());
      checksums.compare(b, column.data(), column.size());
      samples.add(static_cast<int>(b), column.data());
      keep(column, b, response, first);
      response.fingerprints.push_back(number_checksum(column.data(), column.size()));
    }
    require_sound(file, samples);
    const auto size = static_cast<Eigen::Index>(dof);
    const double ratio =
        settling_ratio(as_single(first, response),
                       Eigen::Map<const Eigen::MatrixXf>(response.rest.data(), size, size));
    response.settling = settling_profile(ratio, response.steps);
    response.first = std::move(first);
  });
  return response;
}

std::size_t number_size(const StreamedResponse& response) {
  return std::visit([]<typename Scalar>(const std::vector<Scalar>&) { return sizeof(Scalar); },
                    response.first);
}

std::size_t resident_bytes(const StreamedResponse& response) {
  const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
  return bytes(response.fingerprints) + std::visit(bytes, response.first) +
         std::visit(bytes, response.centrifugal) + std::visit(bytes, response.gravity.approach) +
         static_cast<std::size_t>(response.gravity.sag.size()) * sizeof(double) +
         bytes(response.rest) + bytes(response.settling);
}

namespace {

hdf5::File open_locked(const std::filesystem::path& path) {
  const std::lock_guard lock(hdf5::library_mutex());
  return hdf5::File::open(path);
}

}  // namespace

DenseColumnFile::DenseColumnFile(const std::filesystem::path& path,
                                 const StreamedResponse& response)
    : file_(open_locked(path)),
      dof_(static_cast<hsize_t>(response.degrees_of_freedom)),
      steps_(static_cast<hsize_t>(response.steps)),
      number_size_(number_size(response)),
      fingerprints_(response.fingerprints),
      column_(dof_ * steps_ * number_size_) {}

DenseColumnFile::~DenseColumnFile() {
  const std::lock_guard lock(hdf5::library_mutex());
  const hdf5::File closed = std::move(file_);
}

template <typename Scalar>
void DenseColumnFile::read_as(int node, Scalar* to) {
  auto* column = reinterpret_cast<Scalar*>(column_.data());
  for (hsize_t axis = 0; axis < 3; ++axis) {
    {
      const std::lock_guard lock(hdf5::library_mutex());
      hdf5::prepare_library();
      read_column(file_, kDenseR, 3 * static_cast<hsize_t>(node) + axis, steps_, dof_, column);
    }
    require_dense(file_,
                  number_checksum(column, dof_ * steps_) ==
                      fingerprints_[3 * static_cast<hsize_t>(node) + axis],
                  std::string(kDenseR) + " has changed since it was opened");
    turn(column, steps_, dof_, to + axis * dof_ * steps_);
  }
}

void DenseColumnFile::read(int node, void* to) {
  with_number(number_size_,
              [&]<typename Scalar>(Scalar) { read_as(node, static_cast<Scalar*>(to)); });
}

}  // namespace irdm
