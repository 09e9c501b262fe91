#include "common/model/model_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "common/error.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_check.hpp"
#include "common/model/model_file.hpp"
#include "common/process/temporary_files.hpp"
#include "common/response/modal_response.hpp"

namespace irdm {
namespace {

// Steps of a column in a chunk: chunks of at most about 1 MB and about equal size.
hsize_t chunk_steps(hsize_t steps, hsize_t step_bytes) {
  constexpr hsize_t kChunkBytes = 1 << 20;
  const hsize_t most = std::clamp<hsize_t>(kChunkBytes / step_bytes, 1, steps);
  const hsize_t chunks = (steps + most - 1) / most;
  return (steps + chunks - 1) / chunks;
}

void wait_for_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int cause = descriptor >= 0 && ::fsync(descriptor) == 0 ? 0 : errno;
  if (descriptor >= 0) ::close(descriptor);
  if (cause != 0) {
    throw Error(path.string(),
                "cannot be written to the disk: " + std::generic_category().message(cause),
                "check its free space");
  }
}

void describe_centrifugal(hdf5::File& file, const char* dataset) {
  file.write_attribute(dataset, "order", std::string(kSpinOrder));
}

void write_elasticity(hdf5::File& file, const Material& material) {
  file.write_attribute("/material", "youngs_modulus", material.youngs_modulus);
  file.write_attribute("/material", "poisson_ratio", material.poisson_ratio);
  file.write_attribute("/material", "rayleigh_alpha", material.rayleigh_alpha);
  file.write_attribute("/material", "rayleigh_beta", material.rayleigh_beta);
}

void write_elements(hdf5::File& file, const ElementMaterials& elements) {
  if (elements.empty()) return;
  const auto write = [&](const char* dataset, const std::vector<double>& values) {
    if (!values.empty()) file.write<double>(dataset, {values.size()}, values.data());
  };
  write(kElementYoungsModulus, elements.youngs_modulus);
  write(kElementPoissonRatio, elements.poisson_ratio);
  write(kElementDensity, elements.density);
  file.write<std::int32_t>(kElementRegion, {elements.region.size()}, elements.region.data());
}

}  // namespace

bool holds_rigid_body(const hdf5::File& file) {
  if (!file.exists("/response") || !file.has_attribute("/response", kResponseKindAttribute)) {
    return false;
  }
  const std::string kind = file.read_string_attribute("/response", kResponseKindAttribute);
  if (kind == kRigidKind) return true;
  refuse_model(file.name(), "/response kind is " + in_quotes(kind) + ", which is not known");
}

void write_description(hdf5::File& file, const Model& model) {
  file.write_attribute("/", "format", std::string(kModelFormat));
  file.write_attribute("/", "version", kModelVersion);
  file.write_attribute("/", "created_by", std::string("irdm ") + IRDM_VERSION);

  const ModelMesh& mesh = model.mesh;
  const auto rows = [](const auto& matrix) { return static_cast<hsize_t>(matrix.rows()); };
  file.create_group("/mesh");
  file.write<double>("/mesh/nodes", {rows(mesh.nodes), 3}, mesh.nodes.data());
  file.write<std::int32_t>("/mesh/tets", {rows(mesh.tets), static_cast<hsize_t>(mesh.tets.cols())},
                           mesh.tets.data());
  file.write<std::int32_t>("/mesh/surface_nodes", {mesh.surface_nodes.size()},
                           mesh.surface_nodes.data());
  file.write<std::int32_t>("/mesh/triangles", {rows(mesh.triangles), 3}, mesh.triangles.data());
  file.write<double>("/mesh/node_mass", {rows(mesh.node_mass)}, mesh.node_mass.data());
  file.write_attribute("/mesh", "com_offset", {3}, mesh.com_offset.data());

  file.create_group("/body");
  file.write_attribute("/body", "mass", model.body.mass);
  const Matrix3 rows_of_inertia = model.body.inertia.transpose();  // symmetric but for rounding
  file.write_attribute("/body", "inertia", {3, 3}, rows_of_inertia.data());
  file.write_attribute("/body", "support",
                       std::string(model.body.support == Support::kFixed ? "fixed" : "floating"));

  file.create_group("/material");
  file.write_attribute("/material", "density", model.material.density);
  if (!is_rigid(model)) write_elasticity(file, model.material);
  write_elements(file, model.material.elements);

  if (!model.display.empty()) write_display(file, model.display);

  file.create_group("/response");
  file.write_attribute("/response", "dt", model.dt);
  file.write_attribute("/response", "steps", static_cast<std::int64_t>(model.steps));
  if (is_rigid(model)) {
    file.write_attribute("/response", kResponseKindAttribute, std::string(kRigidKind));
  }
}

ModelFileWriter::ModelFileWriter(const std::filesystem::path& path)
    : path_(path), temporary_(fresh_part_name(path)) {
  file_ = hdf5::File::create(temporary_);
}

ModelFileWriter::ModelFileWriter(std::filesystem::path path, std::filesystem::path temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  file_ = hdf5::File::create(temporary_);
}

ModelFileWriter::~ModelFileWriter() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void ModelFileWriter::write_description(const Model& model) {
  irdm::write_description(*file_, model);
}

void ModelFileWriter::write_modal(const ModalResponse& response) {
  const auto modes = static_cast<hsize_t>(response.mode_count());
  file_->write<double>("/response/modal/angular_frequency", {modes},
                       response.angular_frequency.data());
  file_->write<double>("/response/modal/decay_rate", {modes}, response.decay_rate.data());
  std::visit(
      [&]<typename Scalar>(const RowMatrix<Scalar>& shapes) {
        file_->write<Scalar>("/response/modal/shapes", {static_cast<hsize_t>(shapes.rows()), modes},
                             shapes.data());
      },
      response.shapes);
  if (!response.residual.empty()) write_residual(*file_, response.residual);
  if (response.centrifugal.rows() > 0) {
    file_->write<double>(kModalCentrifugal, {modes, kSpinProducts}, response.centrifugal.data());
    describe_centrifugal(*file_, kModalCentrifugal);
  }
  if (response.gravity.rows() == 0) return;
  file_->write<double>(kModalGravity, {modes, 3}, response.gravity.data());
  if (response.gravity_rest.rows() == 0) return;
  file_->write<double>(kModalGravityRest, {static_cast<hsize_t>(response.gravity_rest.rows()), 3},
                       response.gravity_rest.data());
}

void ModelFileWriter::write_compressed(const CompressedResponse& response,
                                       const CompressionError& error) {
  irdm::write_compressed(*file_, response, error);
}

void ModelFileWriter::begin_dense(int degrees_of_freedom, int steps, Precision precision) {
  dense_dof_ = static_cast<hsize_t>(degrees_of_freedom);
  dense_steps_ = static_cast<hsize_t>(steps);
  column_checksums_.assign(dense_dof_, 0);
  const hdf5::Shape shape{dense_dof_, dense_steps_, dense_dof_};
  const bool single = precision == Precision::kSingle;
  const hdf5::Layout layout{
      .chunk = {1, chunk_steps(dense_steps_, dense_dof_ * (single ? 4 : 8)), dense_dof_},
      .fletcher32 = true};
  if (single) {
    file_->create_dataset<float>(kDenseR, shape, layout);
  } else {
    file_->create_dataset<double>(kDenseR, shape, layout);
  }
}

template <typename Scalar>
void ModelFileWriter::write_column(int b, const Scalar* values) {
  file_->write_slab<Scalar>(kDenseR, {static_cast<hsize_t>(b), 0, 0}, {1, dense_steps_, dense_dof_},
                            values);
  column_checksums_.at(static_cast<std::size_t>(b)) =
      number_checksum(values, dense_steps_ * dense_dof_);
}

void ModelFileWriter::write_dense_column(int b, const float* values) {
  write_column(b, values);
}
void ModelFileWriter::write_dense_column(int b, const double* values) {
  write_column(b, values);
}

template <typename Scalar>
void ModelFileWriter::write_centrifugal(const Scalar* values) {
  file_->write<Scalar>(kDenseCentrifugal, {kSpinProducts, dense_steps_, dense_dof_}, values);
  describe_centrifugal(*file_, kDenseCentrifugal);
}

void ModelFileWriter::write_dense_centrifugal(const float* values) {
  write_centrifugal(values);
}
void ModelFileWriter::write_dense_centrifugal(const double* values) {
  write_centrifugal(values);
}

template <typename Scalar>
void ModelFileWriter::write_gravity(const Scalar* values) {
  file_->write<Scalar>(kDenseGravity, {3, dense_steps_, dense_dof_}, values);
}

void ModelFileWriter::write_dense_gravity(const float* values) {
  write_gravity(values);
}
void ModelFileWriter::write_dense_gravity(const double* values) {
  write_gravity(values);
}

void ModelFileWriter::commit() {
  if (!column_checksums_.empty()) {
    file_->write<std::uint64_t>(kDenseColumnChecksum, {column_checksums_.size()},
                                column_checksums_.data());
  }
  write_model_units(*file_);
  store_content_checksum(*file_);
  file_->require_in_place();
  file_->close();
  wait_for_disk(temporary_);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) {
    throw Error(path_.string(), "cannot be given its name: " + error.message(),
                "check permissions of the folder");
  }
  file_.reset();
}

}  // namespace irdm
