#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "precompute/columns/column_file.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// Joins column files into the dense R of a model file. The same columns give the same bytes
/// however they were divided. Throws Error, naming the file, when they are not of the same mesh,
/// material and settings, overlap, or leave columns out.
/// @param parts in any order
/// @param temporary name of the file until it is complete; what is there is removed
/// Returns how much is left where R is cut off: the largest ratio of |R[s](b, b)| in the last tenth
/// of the steps to its peak.
double assemble(const std::vector<std::filesystem::path>& parts,
                const std::filesystem::path& output, const std::filesystem::path& temporary,
                const Console& console);

}  // namespace irdm::precompute
