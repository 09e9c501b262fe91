#pragma once

#include <filesystem>

#include "common/model/compressed_file.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

struct CompressSettings {
  double error = 1e-2;  ///< share, of displacement and of force: see CompressionError
  /// m, steps of R that are kept as they are; below T / 4. 0: 16, and twice as many again where
  /// the error is not reached otherwise.
  int fir_steps = 0;
};

struct CompressionSummary {
  CompressionError error;
  int fir_steps = 0;
  int shapes = 0;
  int poles = 0;
  double input_bytes = 0.0;   ///< of dense R
  double output_bytes = 0.0;  ///< of the compressed response
};

/// Makes R small and writes a model file that holds it in the compressed form alone. The error is
/// measured against the input; where it is larger than asked for the work is done again, finer.
/// Throws Error, and writes nothing, where it cannot be reached.
/// @param temporary name of the file until it is complete
CompressionSummary compress_model(const std::filesystem::path& input,
                                  const std::filesystem::path& output,
                                  const std::filesystem::path& temporary,
                                  const CompressSettings& settings, const Console& console);

}  // namespace irdm::precompute
