#pragma once

#include <filesystem>
#include <memory>

#include "common/hdf5/file.hpp"
#include "common/response/stored_response.hpp"

namespace irdm::precompute {

/// Dense R of a model file, one column at a time: it may be larger than the memory.
class DenseInput {
 public:
  /// Throws Error when the file has no dense R, or one of another shape.
  explicit DenseInput(const std::filesystem::path& path);

  const std::string& name() const { return file_.name(); }
  /// What else the file holds, without a response.
  const Model& description() const { return model_; }
  int degrees_of_freedom() const { return model_.degrees_of_freedom(); }
  int steps() const { return model_.steps; }
  /// Bytes of R as it is stored, without compression by a filter.
  double bytes() const;
  /// R[s](:, b), (T, 3n) [m/N]. Throws Error where a number is not finite.
  RowMatrix<float> column(int b) const;

 private:
  hdf5::File file_;
  Model model_;
  std::unique_ptr<StoredResponse> R_;
};

}  // namespace irdm::precompute
