#include "tests/check/dense_file.hpp"

#include "common/model/model_file.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::test {

DenseCube::DenseCube(int steps)
    : model(*irdm::test::fem_cube({.cells = 2, .rayleigh_alpha = 24.0})) {
  auto& response = std::get<ModalResponse>(model.response);
  if (const auto* single = std::get_if<RowMatrix<float>>(&response.shapes)) {
    const RowMatrix<double> shapes = single->cast<double>();
    response.shapes = shapes;
  }
  model.steps = steps;
  values_ = std::get<std::vector<double>>(
      std::get<DenseResponse>(irdm::test::with_dense_response<double>(model).response).values);
}

double& DenseCube::at(int s, int a, int b) {
  return values_[static_cast<std::size_t>((b * model.degrees_of_freedom() + a) * model.steps + s)];
}

void DenseCube::write(const std::filesystem::path& path) const {
  const int dof = model.degrees_of_freedom();
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.begin_dense(dof, model.steps, Precision::kDouble);
  for (int b = 0; b < dof; ++b) {
    const RowMatrix<double> column =
        Eigen::Map<const RowMatrix<double>>(
            values_.data() + static_cast<std::ptrdiff_t>(b) * dof * model.steps, dof, model.steps)
            .transpose();
    writer.write_dense_column(b, column.data());
  }
  writer.commit();
}

}  // namespace irdm::test
