#pragma once

#include <filesystem>

#include "common/model/model.hpp"

namespace irdm::test {

/// A cube as irdm-precompute makes it (2 cells an edge), with R in memory to be spoilt.
struct DenseCube {
  Model model;  ///< modal

  explicit DenseCube(int steps = 500);
  double& at(int s, int a, int b);
  /// Writes the model with R alone, in double precision.
  void write(const std::filesystem::path& path) const;

 private:
  std::vector<double> values_;
};

}  // namespace irdm::test
