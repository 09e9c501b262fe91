// Model files, with edits of the fuzzer's choice.
#include <vector>

#include "common/error.hpp"
#include "common/model/dense_file.hpp"
#include "common/model/model_file.hpp"
#include "precompute/compress/dense_input.hpp"
#include "tests/fuzz/edited_file.hpp"
#include "tests/fuzz/finite_steps.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/support/edited_numbers.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::fuzz {
namespace {

constexpr int kModes = 2;
constexpr int kResponseSteps = 3;

std::filesystem::path new_file(const char* name) {
  std::filesystem::path path = scratch_file(name, "");
  std::filesystem::remove(path);
  return path;
}

/// The order of the loads' numbers does not matter here.
template <typename Scalar>
void write_columns(const DenseResponse& response, ModelFileWriter& writer) {
  const auto& values = std::get<std::vector<Scalar>>(response.values);
  const int dof = response.degrees_of_freedom;
  for (int b = 0; b < dof; ++b) {
    const Scalar* const first =
        values.data() + static_cast<std::ptrdiff_t>(b) * dof * response.steps;
    const RowMatrix<Scalar> column =
        Eigen::Map<const RowMatrix<Scalar>>(first, dof, response.steps).transpose();
    writer.write_dense_column(b, column.data());
  }
  writer.write_dense_centrifugal(std::get<std::vector<Scalar>>(response.centrifugal).data());
  writer.write_dense_gravity(std::get<std::vector<Scalar>>(response.gravity.approach).data());
}

/// With both responses, and what rotation and gravity do.
std::filesystem::path valid_model() {
  Model model = test::synthetic_cube(1, kModes, kResponseSteps);
  test::add_centrifugal(model);
  test::add_gravity(model, true);
  const Model dense = test::with_dense_response<double>(model);
  const auto& response = std::get<DenseResponse>(dense.response);
  std::filesystem::path path = new_file("valid.h5");
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.begin_dense(response.degrees_of_freedom, response.steps, Precision::kDouble);
  write_columns<double>(response, writer);
  writer.commit();
  return path;
}

/// What takes less room: single precision, what modes that are left out add, and the compressed
/// response.
std::filesystem::path packed_model() {
  Model model = test::synthetic_cube(1, kModes, kResponseSteps);
  test::add_centrifugal(model);
  test::add_gravity(model, true);
  test::add_residual(model);
  const Model dense = test::with_dense_response<float>(model);
  const auto& response = std::get<DenseResponse>(dense.response);
  auto& modal = std::get<ModalResponse>(model.response);
  const RowMatrix<float> shapes = std::get<RowMatrix<double>>(modal.shapes).cast<float>();
  modal.shapes = shapes;
  std::filesystem::path path = new_file("packed.h5");
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(modal);
  writer.begin_dense(response.degrees_of_freedom, response.steps, Precision::kSingle);
  write_columns<float>(response, writer);
  writer.write_compressed(test::compressed_response(model), {0.01, 0.01, 0.005, 0.01, 24});
  writer.commit();
  return path;
}

/// A valid file, what it says without its columns, and its edits.
struct ModelFile {
  explicit ModelFile(const std::filesystem::path& path)
      : model(read_streamed_model(path)), edits(path) {}
  Model model;
  EditedFile edits;
};

const StreamedResponse& streamed(const Model& model) {
  return std::get<StreamedResponse>(model.response);
}

/// Of the first node and the last.
/// @param changed the file is not known to be what the model was read from
void read_columns_of_nodes(const std::filesystem::path& path, const Model& model, bool changed) {
  const StreamedResponse& response = streamed(model);
  DenseColumnFile columns(path, response);
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  std::vector<std::byte> node(3 * dof * static_cast<std::size_t>(response.steps) *
                              number_size(response));
  try {
    for (const std::size_t i : {std::size_t{0}, dof / 3 - 1}) {
      columns.read(static_cast<int>(i), node.data());
    }
  } catch (const Error&) {
    expect(changed, "columns can be read as they were");
  }
}

/// @param first of the file as it was
void read_in_columns(const std::filesystem::path& path, const Model& first) {
  read_columns_of_nodes(path, first, true);
  const Model again = read_streamed_model(path);
  expect(streamed(again).settling.size() == static_cast<std::size_t>(again.steps),
         "every step has its share that is left");
  expect(resident_bytes(streamed(again)) > 0, "what is kept takes room");
  read_columns_of_nodes(path, again, false);
}

void read_to_compress(const std::filesystem::path& path) {
  const precompute::DenseInput input(path);
  expect(input.bytes() > 0.0, "R takes room");
  for (const int b : {0, input.degrees_of_freedom() - 1}) {
    expect(input.column(b).allFinite(), "R is finite");
  }
}

/// Calls; an error is right when something was edited.
template <typename Read>
void try_to(Input edits, const Read& read) {
  try {
    read();
  } catch (const Error&) {
    expect(!edits.empty(), "a model can be read as it was written");
  }
}

void read_all(Input input, const ModelFile& file, bool compressed) {
  const std::filesystem::path path = file.edits.edited(input);
  // Its checksum would refuse all edits before anything else does.
  try {
    test::sign_model(path);
  } catch (const std::exception&) {
    // Where the edits leave nothing to sign.
  }
  std::vector<ResponseKind> kinds = {ResponseKind::kModal, ResponseKind::kDense};
  if (compressed) kinds.push_back(ResponseKind::kCompressed);
  for (const ResponseKind kind : kinds) {
    try_to(input, [&] { press(read_model(path, kind)); });
  }
  if (compressed) try_to(input, [&] { read_compression_error(hdf5::File::open(path)); });
  try_to(input, [&] { read_in_columns(path, file.model); });
  try_to(input, [&] { read_to_compress(path); });
}

}  // namespace

void model_file(Input input) {
  static const ModelFile file(valid_model());
  read_all(input, file, false);
}

void packed_model_file(Input input) {
  static const ModelFile file(packed_model());
  read_all(input, file, true);
}

}  // namespace irdm::fuzz
