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

/// The error that zfp may make [m/N]: `share` of the peak of R, rounded down to a power of two as
/// zfp itself does, so that it does not hang on the last digits of the peak. 0 for share 0.
double zfp_accuracy(double share, double peak);

/// For who waits for it.
std::string half_error_text(const HalfError& error);

/// zfp_accuracy() that needs no knowledge of R: says early that a filter is missing. Throws Error.
void check_compression(double share, const std::filesystem::path& output);

}  // namespace irdm::precompute
