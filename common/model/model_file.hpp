#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/hdf5/file.hpp"
#include "common/model/model.hpp"

/// The model file (HDF5, format "irdm-model", docs/files.md).
namespace irdm {

enum class Precision { kSingle, kDouble };
enum class ResponseKind { kModal, kDense };

/// Reads a model file and, of its responses, the one that is asked for. Everything is checked:
/// shapes, index ranges, finite numbers, positive mass. Throws Error.
Model read_model(const std::filesystem::path& path, ResponseKind kind);

/// The same without any response: what is small in a file of any size.
Model read_model_description(const std::filesystem::path& path);

/// Writes a model file under a temporary name beside the final one; commit() gives it its name.
/// Without commit nothing is left behind. Throws Error.
class ModelFileWriter {
 public:
  explicit ModelFileWriter(std::filesystem::path path);
  ModelFileWriter(const ModelFileWriter&) = delete;
  ModelFileWriter& operator=(const ModelFileWriter&) = delete;
  ~ModelFileWriter();

  /// Mesh, body, material, dt and steps; the model's response is ignored.
  void write_description(const Model& model);
  void write_modal(const ModalResponse& response);

  /// Makes room for R; then each column b is written once: (T, 3n) numbers, [s][a displacement].
  void begin_dense(int degrees_of_freedom, int steps, Precision precision);
  void write_dense_column(int b, const float* values);
  void write_dense_column(int b, const double* values);

  /// Where the file is until commit: for a signal handler that tidies up.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Completes the file and moves it to its final name, replacing an older one.
  void commit();

 private:
  template <typename Scalar>
  void write_column(int b, const Scalar* values);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::optional<hdf5::File> file_;
  hsize_t dense_dof_ = 0;
  hsize_t dense_steps_ = 0;
};

}  // namespace irdm
