#pragma once

#include <filesystem>

#include "precompute/config.hpp"
#include "precompute/progress.hpp"
#include "precompute/summary.hpp"

namespace irdm::precompute {

/// The whole way from a configuration to a model file: mesh, finite elements, modes, R. Warnings go
/// to stderr, progress to `console`. The file appears under its name only when it is complete.
/// Throws Error.
Summary precompute_model(const PrecomputeConfig& config, const std::filesystem::path& output,
                         const Console& console);

}  // namespace irdm::precompute
