#include "precompute/columns/compute_columns.hpp"

#include <atomic>
#include <exception>
#include <mutex>
#include <sstream>

#include "common/hdf5/file.hpp"
#include "precompute/blas.hpp"

namespace irdm::precompute {

std::string settings_text(const PrecomputeConfig& config, const std::vector<int>& clamped) {
  std::ostringstream text;
  text.precision(17);
  const bool stepping = config.response.method == Method::kTimeStepping;
  text << "method " << (stepping ? "time-stepping" : "modal") << "\nclamped";
  for (const int node : clamped) text << ' ' << node;
  text << '\n';
  if (!stepping) return text.str();
  const TimeSteppingConfig& steps = config.time_stepping;
  text << "model " << (steps.model == Elasticity::kLinear ? "linear" : "corotational")
       << "\nfirst_step " << steps.first_step << "\nlast_step " << steps.last_step << "\nhold "
       << steps.hold << "\nforce " << steps.force << "\nrotation_weights "
       << (steps.rotation_weights == RotationWeights::kMass ? "mass" : "none") << '\n';
  return text.str();
}

namespace {

void store_block(const Columns& columns, const ColumnRange& block, const ColumnRange& wanted,
                 ColumnStore& store) {
  hdf5::prepare_library();
  std::visit(
      [&](const auto& values) {
        const Eigen::Index steps = values.rows() / block.count();
        for (int b = std::max(block.begin, wanted.begin); b < std::min(block.end, wanted.end);
             ++b) {
          store.put(b, values.row((b - block.begin) * steps).data());
        }
      },
      columns);
  store.flush();
}

}  // namespace

void compute_columns(const ColumnSource& source, const ColumnRange& range, int threads,
                     ColumnStore& store) {
  if (range.count() <= 0) return;
  const SingleThreadedBlas single;
  const int first = range.begin / source.block_size();
  const int last = (range.end - 1) / source.block_size();
  std::atomic<bool> failed = false;
  std::exception_ptr failure;  // an exception must not leave a parallel region
  std::mutex storing;
#pragma omp parallel for ordered schedule(dynamic, 1) num_threads(threads)
  for (int k = first; k <= last; ++k) {
    Columns columns;
    std::exception_ptr mine;
    try {
      if (!failed) columns = source.block(k);
    } catch (...) {
      mine = std::current_exception();
    }
#pragma omp ordered
    {
      const std::scoped_lock lock(storing);
      try {
        if (mine && !failed) std::rethrow_exception(mine);
        if (!failed) store_block(columns, source.block_range(k), range, store);
      } catch (...) {
        failure = std::current_exception();
        failed = true;
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace irdm::precompute
