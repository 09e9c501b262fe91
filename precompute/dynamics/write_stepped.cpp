#include "precompute/dynamics/write_stepped.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <exception>

#include "common/error.hpp"
#include "precompute/dynamics/stepped_columns.hpp"

namespace irdm::precompute {
namespace {

double left_at_end(const Eigen::VectorXd& driving_point) {
  const Eigen::Index tail = (driving_point.size() + 9) / 10;
  return driving_point.tail(tail).cwiseAbs().maxCoeff() / driving_point.cwiseAbs().maxCoeff();
}

void write_column(ModelFileWriter& writer, int b, const RowMatrix<double>& column,
                  Precision precision) {
  if (precision == Precision::kDouble) {
    writer.write_dense_column(b, column.data());
  } else {
    const RowMatrix<float> rounded = column.cast<float>();
    writer.write_dense_column(b, rounded.data());
  }
}

// An exception must not leave a parallel region: the first one, in the order of columns, is kept.
std::vector<RowMatrix<double>> compute(const SteppedColumns& columns, int first, int count,
                                       int threads) {
  std::vector<RowMatrix<double>> computed(static_cast<std::size_t>(count));
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
#pragma omp parallel for num_threads(threads) schedule(dynamic)
  for (int k = 0; k < count; ++k) {
    const auto slot = static_cast<std::size_t>(k);
    try {
      computed[slot] = columns.column(first + k);
    } catch (...) {
      failures[slot] = std::current_exception();
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  return computed;
}

}  // namespace

void check_time_stepping(const std::string& name, const TetMesh& mesh, const Model& model,
                         bool dense_storage) {
  if (!dense_storage) {
    throw Error(name, "method time-stepping gives R in dense form only",
                "set response.storage = \"dense\" (or --storage dense)");
  }
  if (mesh.tets.cols() != 4) {
    throw Error(name, "method time-stepping takes linear tetrahedra only",
                "set mesh.order = 1 or response.method = \"modal\"");
  }
  if (model.body.support != Support::kFloating) {
    throw Error(name, "method time-stepping takes floating bodies only",
                "set response.support = \"floating\" or response.method = \"modal\"");
  }
}

double write_stepped_columns(ModelFileWriter& writer, const TetMesh& mesh, const Model& model,
                             const SteppedWork& work, const Console& console) {
  const SteppedColumns columns(mesh, model.material, work.time_stepping, model.mesh.surface_nodes,
                               model.dt, model.steps);
  const int threads = work.threads > 0 ? work.threads : omp_get_num_procs();
  char text[128];
  std::snprintf(text, sizeof text, "time stepping: %d steps a column, force %.3g N, %d threads",
                columns.step_count(), columns.force(), threads);
  console.line(text);
  const int dof = model.degrees_of_freedom();
  writer.begin_dense(dof, model.steps, work.precision);
  Progress progress(console, "columns of R", dof);
  double left = 0.0;
  for (int first = 0; first < dof; first += threads) {
    const int count = std::min(threads, dof - first);
    const std::vector<RowMatrix<double>> computed = compute(columns, first, count, threads);
    for (int k = 0; k < count; ++k) {
      const RowMatrix<double>& column = computed[static_cast<std::size_t>(k)];
      write_column(writer, first + k, column, work.precision);
      left = std::max(left, left_at_end(column.col(first + k)));
      progress.update(first + k + 1);
    }
  }
  return left;
}

}  // namespace irdm::precompute
