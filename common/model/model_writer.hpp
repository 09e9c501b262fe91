#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "common/hdf5/file.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/model.hpp"

namespace irdm {

inline constexpr const char* kModelFormat = "irdm-model";
inline constexpr std::int64_t kModelVersion = 1;
inline constexpr const char* kDenseR = "/response/dense/R";
/// Of each column of R (number_checksum()). Files of older versions do not have it.
inline constexpr const char* kDenseColumnChecksum = "/response/dense/column_checksum";
/// What the body's own spin does, one part a product of SpinProducts. Optional.
inline constexpr const char* kDenseCentrifugal = "/response/dense/centrifugal";
inline constexpr const char* kSpinOrder = "xx yy zz yz xz xy";  ///< attribute `order` of both
inline constexpr const char* kModalCentrifugal = "/response/modal/centrifugal";

/// What gravity does to a fixed body, one part an axis of B. Optional.
inline constexpr const char* kDenseGravity = "/response/dense/gravity";
inline constexpr const char* kElementYoungsModulus = "/material/elements/youngs_modulus";
inline constexpr const char* kElementPoissonRatio = "/material/elements/poisson_ratio";
inline constexpr const char* kElementDensity = "/material/elements/density";
inline constexpr const char* kElementRegion = "/material/elements/region";
inline constexpr const char* kModalGravity = "/response/modal/gravity";
inline constexpr const char* kModalGravityRest = "/response/modal/gravity_rest";

/// Of the numbers of R in a file.
enum class Precision { kSingle, kDouble };

/// Of /response: what a rigid body has instead of a response. Other bodies do not have it.
inline constexpr const char* kResponseKindAttribute = "kind";
inline constexpr const char* kRigidKind = "rigid";

/// Whether a model file is of a rigid body. Throws Error when it says something unknown.
bool holds_rigid_body(const hdf5::File& file);

/// Mesh, body, material, dt and steps into a new file, and whether the body is rigid, which is then
/// all of the model; the response of others is ignored.
void write_description(hdf5::File& file, const Model& model);

/// Writes a model file under a temporary name beside the final one; commit() gives it its name.
/// Without commit nothing is left behind. Throws Error.
class ModelFileWriter {
 public:
  /// The temporary name ends with the process's number, so that several may write.
  explicit ModelFileWriter(const std::filesystem::path& path);
  /// Under a temporary name that only this process uses; what an earlier one left there is removed.
  ModelFileWriter(std::filesystem::path path, std::filesystem::path temporary);
  ModelFileWriter(const ModelFileWriter&) = delete;
  ModelFileWriter& operator=(const ModelFileWriter&) = delete;
  ~ModelFileWriter();

  /// As irdm::write_description().
  void write_description(const Model& model);
  void write_modal(const ModalResponse& response);
  void write_compressed(const CompressedResponse& response, const CompressionError& error);

  /// Makes room for R; then each column b is written once: (T, 3n) numbers, [s][a displacement].
  /// A chunk is a part of one column, of about 1 MB, with a Fletcher32 checksum.
  void begin_dense(int degrees_of_freedom, int steps, Precision precision);
  void write_dense_column(int b, const float* values);
  void write_dense_column(int b, const double* values);
  /// After begin_dense(): (6, T, 3n) numbers, [product][s][a displacement].
  void write_dense_centrifugal(const float* values);
  void write_dense_centrifugal(const double* values);
  /// After begin_dense(): (3, T, 3n) numbers, [axis of an acceleration that sets in and stays][s][a
  /// displacement].
  void write_dense_gravity(const float* values);
  void write_dense_gravity(const double* values);

  /// Where the file is until commit: for a signal handler that tidies up.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Completes the file, waits until the disk has it and moves it to its final name, replacing an
  /// older one: under that name there is a whole file at all times, or none.
  void commit();

 private:
  template <typename Scalar>
  void write_column(int b, const Scalar* values);
  template <typename Scalar>
  void write_centrifugal(const Scalar* values);
  template <typename Scalar>
  void write_gravity(const Scalar* values);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::optional<hdf5::File> file_;
  hsize_t dense_dof_ = 0;
  hsize_t dense_steps_ = 0;
  std::vector<std::uint64_t> column_checksums_;  ///< of dense R
};

}  // namespace irdm
