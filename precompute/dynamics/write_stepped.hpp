#pragma once

#include <string>

#include "common/model/model_file.hpp"
#include "precompute/dynamics/time_stepping_config.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// Throws Error where time stepping cannot do what is asked: only floating bodies of linear
/// tetrahedra, and R in dense form.
/// @param name of the configuration file
void check_time_stepping(const std::string& name, const TetMesh& mesh, const Model& model,
                         bool dense_storage);

struct SteppedWork {
  std::string name;  ///< of the configuration file
  TimeSteppingConfig time_stepping;
  Precision precision;
  int threads;  ///< 0: all cores
};

/// Computes all columns of R by time stepping, several at a time, and writes them in order: the
/// file is the same for any number of threads. Returns how much is left where R is cut off: the
/// largest ratio of |R[s](b, b)| in the last tenth of the steps to its peak.
double write_stepped_columns(ModelFileWriter& writer, const TetMesh& mesh, const Model& model,
                             const SteppedWork& work, const Console& console);

}  // namespace irdm::precompute
