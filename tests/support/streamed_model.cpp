#include "tests/support/streamed_model.hpp"

#include <numeric>

#include "common/model/model_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {
namespace {

// [s][a] of column b, as the writer wants it.
template <typename Number>
RowMatrix<Number> file_column(const DenseResponse& response, const std::vector<Number>& values,
                              int b) {
  RowMatrix<Number> column(response.steps, response.degrees_of_freedom);
  std::size_t at = static_cast<std::size_t>(b) * static_cast<std::size_t>(column.size());
  for (Eigen::Index a = 0; a < column.cols(); ++a) {
    for (Eigen::Index s = 0; s < column.rows(); ++s) {
      column(s, a) = values[at++];
    }
  }
  return column;
}

template <typename Number>
void write_columns(const DenseResponse& response, const std::vector<Number>& values,
                   ModelFileWriter& writer) {
  for (int b = 0; b < response.degrees_of_freedom; ++b) {
    writer.write_dense_column(b, file_column(response, values, b).data());
  }
}

// [column][s][a].
template <typename Number>
std::vector<Number> file_columns(const DenseResponse& response, const std::vector<Number>& values,
                                 int count) {
  std::vector<Number> all;
  for (int p = 0; p < count; ++p) {
    const RowMatrix<Number> column = file_column(response, values, p);
    all.insert(all.end(), column.data(), column.data() + column.size());
  }
  return all;
}

template <typename Number>
void write_spin(const DenseResponse& response, const std::vector<Number>& values,
                ModelFileWriter& writer) {
  if (values.empty()) return;
  writer.write_dense_centrifugal(file_columns(response, values, 6).data());
}

template <typename Number>
void write_gravity(const DenseResponse& response, const std::vector<Number>& approach,
                   ModelFileWriter& writer) {
  if (approach.empty()) return;
  std::vector<Number> all = file_columns(response, approach, 3);
  const int dof = response.degrees_of_freedom;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto column = static_cast<int>(i / static_cast<std::size_t>(dof));
    const auto a = static_cast<Eigen::Index>(i % static_cast<std::size_t>(dof));
    all[i] += static_cast<Number>(response.gravity.sag(a, column / response.steps));
  }
  writer.write_dense_gravity(all.data());
}

}  // namespace

void write_dense_model(const Model& dense, const std::filesystem::path& path) {
  const auto& response = std::get<DenseResponse>(dense.response);
  ModelFileWriter writer(path);
  writer.write_description(dense);
  const bool single = std::holds_alternative<std::vector<float>>(response.values);
  writer.begin_dense(response.degrees_of_freedom, response.steps,
                     single ? Precision::kSingle : Precision::kDouble);
  std::visit([&](const auto& values) { write_columns(response, values, writer); }, response.values);
  std::visit([&](const auto& values) { write_spin(response, values, writer); },
             response.centrifugal);
  std::visit([&](const auto& values) { write_gravity(response, values, writer); },
             response.gravity.approach);
  writer.commit();
}

ScriptedSupply::ScriptedSupply(const DenseResponse& response)
    : values_(response.values),
      node_numbers_(3 * static_cast<std::size_t>(response.degrees_of_freedom) *
                    static_cast<std::size_t>(response.steps)),
      taken_(static_cast<std::size_t>(response.degrees_of_freedom / 3), 0) {}

const void* ScriptedSupply::acquire(int node) noexcept {
  if (!there(node)) return nullptr;
  const auto index = static_cast<std::size_t>(node);
  ++taken_[index];
  return std::visit(
      [&](const auto& values) -> const void* { return values.data() + index * node_numbers_; },
      values_);
}

int ScriptedSupply::taken() const {
  return std::accumulate(taken_.begin(), taken_.end(), 0);
}

StreamedModel::StreamedModel(Model model) {
  const TemporaryFolder folder;
  write_dense_model(model, folder.path() / "dense.h5");
  Model read = read_streamed_model(folder.path() / "dense.h5");
  // Rounded once more than what the file was made of.
  std::get<DenseResponse>(model.response).gravity =
      std::get<StreamedResponse>(read.response).gravity;
  dense = std::make_shared<const Model>(std::move(model));
  supply = std::make_shared<ScriptedSupply>(std::get<DenseResponse>(dense->response));
  std::get<StreamedResponse>(read.response).columns = supply;
  streamed = std::make_shared<const Model>(std::move(read));
}

}  // namespace irdm::test
