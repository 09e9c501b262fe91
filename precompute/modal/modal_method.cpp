#include "precompute/modal/modal_method.hpp"

#include <cmath>

#include "precompute/columns/compute_columns.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/modal/dense_columns.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {
namespace {

class ModelStore final : public ColumnStore {
 public:
  ModelStore(ModelFileWriter& writer, Progress& progress) : writer_(writer), progress_(progress) {}
  void put(int b, const float* values) override { write(b, values); }
  void put(int b, const double* values) override { write(b, values); }

 private:
  template <typename Scalar>
  void write(int b, const Scalar* values) {
    writer_.write_dense_column(b, values);
    progress_.update(b + 1);
  }
  ModelFileWriter& writer_;
  Progress& progress_;
};

void write_dense(ModelFileWriter& writer, const ModalResponse& response, const Model& model,
                 const ResponseConfig& config, int threads, const Console& console) {
  const auto columns = modal_columns(response, model, config.precision);
  writer.begin_dense(columns->columns(), model.steps, config.precision);
  Progress progress(console, "columns of R", columns->columns());
  ModelStore store(writer, progress);
  compute_columns(*columns, {0, columns->columns()}, threads, store);
  std::visit(
      [&](const auto& values) {
        if (values.rows() > 0) writer.write_dense_centrifugal(values.data());
      },
      columns->centrifugal());
  std::visit(
      [&](const auto& values) {
        if (values.rows() > 0) writer.write_dense_gravity(values.data());
      },
      columns->gravity());
}

}  // namespace

ModalResponse compute_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                            const Model& model, const Console& console) {
  const SparseMatrix stiffness = assemble_stiffness(mesh, model.material);
  // Measured: 26 s for 4080 unknowns on two cores.
  const auto unknowns = 3 * (static_cast<std::size_t>(mesh.node_count()) - clamped.size());
  const double estimate = 26.0 * std::pow(static_cast<double>(unknowns) / 4080.0, 3);
  console.line("modes: " + std::to_string(unknowns) + " unknowns, all modes by LAPACK; about " +
               format_duration(estimate) + " on two cores");
  const ElasticModes modes = model.body.support == Support::kFixed
                                 ? fixed_modes(stiffness, model.mesh.node_mass, clamped)
                                 : elastic_modes(stiffness, model.mesh.nodes, model.mesh.node_mass);
  ModalResponse response = modal_response(modes, model.mesh.surface_nodes, model.material);
  add_body_loads(modes, model, response);
  return response;
}

std::unique_ptr<ColumnSource> modal_columns(const ModalResponse& response, const Model& model,
                                            Precision precision) {
  if (precision == Precision::kSingle) {
    return std::make_unique<DenseColumns<float>>(response, model.dt, model.steps);
  }
  return std::make_unique<DenseColumns<double>>(response, model.dt, model.steps);
}

void write_modal_response(ModelFileWriter& writer, ModalResponse response, const Model& model,
                          const ResponseConfig& config, int threads, const Console& console) {
  if (config.storage != Storage::kModal) {
    write_dense(writer, response, model, config, threads, console);
  }
  if (config.storage == Storage::kDense) return;
  if (config.precision == Precision::kSingle) {
    const RowMatrix<float> shapes = std::get<RowMatrix<double>>(response.shapes).cast<float>();
    response.shapes = shapes;
  }
  writer.write_modal(response);
}

}  // namespace irdm::precompute
