#include "precompute/modal/modal_method.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "precompute/columns/compute_columns.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/modal/dense_columns.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/lowest_modes.hpp"

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

// All modes of 4920 unknowns take 30 s on two cores (a cube of 6 quadratic cells an edge, AMD EPYC;
// OpenBLAS), and the time grows with the third power: a minute.
constexpr int kMostUnknownsForAllModes = 6200;
constexpr double kDefaultModesError = 0.01;
constexpr int kMostDefaultModes = 512;

// Cubes with up to 128 modes and the residual take 4.4 s for 7200 unknowns, 18 s for 17 200, on the
// same machine.
double fewer_modes_seconds(int unknowns) {
  return 18.0 * std::pow(unknowns / 17'200.0, 1.5);
}

}  // namespace

bool takes_fewer_modes(const PrecomputeConfig& config, int unknowns) {
  return !config.rigid && !config.modes.given() && config.response.method == Method::kModal &&
         config.response.storage == Storage::kModal && unknowns > kMostUnknownsForAllModes;
}

ModesConfig fewer_modes() {
  ModesConfig modes;
  modes.error = kDefaultModesError;
  modes.most = kMostDefaultModes;
  return modes;
}

std::string fewer_modes_text(int unknowns) {
  return "modes: all of them would take about " +
         format_duration(30.0 * std::pow(unknowns / 4920.0, 3)) +
         " on two cores, so modes.error = 0.01 by default: the lowest ones, about " +
         format_duration(fewer_modes_seconds(unknowns)) + "; modes.error = 0 computes all";
}

// A small problem says how fast the machine is now.
double all_modes_seconds(int unknowns) {
  constexpr int kSample = 600;
  constexpr double kLarge =
      0.6;  // measured: a large problem takes so much of what the cube of its size says
  const int size = std::min(unknowns, kSample);
  const Eigen::MatrixXd sample = Eigen::MatrixXd::NullaryExpr(
      size, size,
      [](Eigen::Index i, Eigen::Index j) { return std::sin(static_cast<double>(i * j + i + j)); });
  const auto begin = std::chrono::steady_clock::now();
  symmetric_eigen(sample);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  return unknowns > size ? kLarge * taken.count() * std::pow(unknowns / double(size), 3)
                         : taken.count();
}

ModalResponse compute_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                            const Model& model, const Console& console) {
  const SparseMatrix stiffness = assemble_stiffness(mesh, model.material);
  const auto unknowns = 3 * (mesh.node_count() - static_cast<int>(clamped.size()));
  const double expected_s = all_modes_seconds(unknowns);
  console.line("modes: " + std::to_string(unknowns) + " unknowns, all modes by LAPACK; about " +
               format_duration(expected_s) + " on this machine");
  const ElasticModes modes = [&] {
    const ElapsedTime elapsed(console, "all modes", expected_s);
    return model.body.support == Support::kFixed
               ? fixed_modes(stiffness, model.mesh.node_mass, clamped)
               : elastic_modes(stiffness, model.mesh.nodes, model.mesh.node_mass);
  }();
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
