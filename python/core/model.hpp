#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>
#include <string>

#include "common/model/model.hpp"
#include "common/response/stored_response.hpp"

namespace irdm::python {

/// A model file, read.
class PythonModel {
 public:
  /// @param response "modal", "dense" or "compressed"
  PythonModel(const std::filesystem::path& path, const std::string& response);
  /// Of a simulation; without a path.
  explicit PythonModel(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

  const Model& model() const { return *model_; }
  const std::string& path() const { return path_; }
  /// Made when it is first asked for. Throws Error of a rigid body, which has none.
  const StoredResponse& response();

 private:
  std::shared_ptr<const Model> model_;
  std::string path_;
  std::unique_ptr<StoredResponse> response_;
};

}  // namespace irdm::python
