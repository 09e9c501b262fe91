// Model files, with edits of the fuzzer's choice.
#include <cmath>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "tests/fuzz/edited_file.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::fuzz {
namespace {

/// With both responses, and what the rotation does; the order of R's numbers does not matter here.
std::filesystem::path valid_model() {
  Model model = test::synthetic_cube(1, 2, 3);
  test::add_centrifugal(model);
  const Model dense = test::with_dense_response<double>(model);
  const auto& response = std::get<DenseResponse>(dense.response);
  const auto& values = std::get<std::vector<double>>(response.values);
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  const auto steps = static_cast<std::size_t>(response.steps);
  const std::filesystem::path path = scratch_file("valid.h5", "");
  std::filesystem::remove(path);
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.begin_dense(response.degrees_of_freedom, response.steps, Precision::kDouble);
  for (std::size_t b = 0; b < dof; ++b) {
    writer.write_dense_column(static_cast<int>(b), values.data() + b * dof * steps);
  }
  writer.write_dense_centrifugal(std::get<std::vector<double>>(response.centrifugal).data());
  writer.commit();
  return path;
}

}  // namespace

void model_file(Input input) {
  static const EditedFile file(valid_model());
  const std::filesystem::path path = file.edited(input);
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    try {
      const Model model = read_model(path, kind);
      expect(model.body.mass > 0.0 && std::isfinite(model.body.mass), "a model has a mass");
      expect(model.mesh.nodes.allFinite(), "a model's nodes are somewhere");
    } catch (const Error&) {
      expect(!input.empty(), "a model can be read as it was written");
    }
  }
}

}  // namespace irdm::fuzz
