#include "common/model/content_checksum.hpp"

#include <cstdint>

#include "common/checksum.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {
namespace {

constexpr const char* kName = "content_sha256";

template <typename T>
void add_dataset(Sha256& sha, const hdf5::File& file, const std::string& path) {
  if (!file.exists(path)) return;
  const hdf5::Shape shape = file.shape(path);
  const std::vector<T> values = file.read<T>(path, hdf5::Shape(shape.size(), 0));
  sha.update(path.c_str(), path.size() + 1);
  for (const hsize_t extent : shape) {
    const auto wide = static_cast<std::uint64_t>(extent);
    sha.update(&wide, sizeof wide);
  }
  sha.update(values.data(), values.size() * sizeof(T));
}

// Of single or double precision.
void add_reals(Sha256& sha, const hdf5::File& file, const std::string& path) {
  if (file.exists(path) && file.element_size(path) == sizeof(float)) {
    add_dataset<float>(sha, file, path);
  } else {
    add_dataset<double>(sha, file, path);
  }
}

void add_name(Sha256& sha, const std::string& object, const std::string& name) {
  const std::string full = object + "@" + name;
  sha.update(full.c_str(), full.size() + 1);
}

void add_numbers(Sha256& sha, const hdf5::File& file, const std::string& object,
                 const std::string& name, std::size_t count) {
  if (!file.exists(object)) return;
  const std::vector<double> values = file.read_doubles_attribute(object, name, count);
  add_name(sha, object, name);
  sha.update(values.data(), count * sizeof(double));
}

void add_text(Sha256& sha, const hdf5::File& file, const std::string& object,
              const std::string& name) {
  if (!file.exists(object)) return;
  const std::string text = file.read_string_attribute(object, name);
  add_name(sha, object, name);
  sha.update(text.data(), text.size());
}

}  // namespace

std::string content_checksum(const hdf5::File& file) {
  Sha256 sha;
  add_dataset<double>(sha, file, "/mesh/nodes");
  add_dataset<std::int32_t>(sha, file, "/mesh/tets");
  add_dataset<std::int32_t>(sha, file, "/mesh/surface_nodes");
  add_dataset<std::int32_t>(sha, file, "/mesh/triangles");
  add_dataset<double>(sha, file, "/mesh/node_mass");
  add_numbers(sha, file, "/mesh", "com_offset", 3);
  add_numbers(sha, file, "/body", "mass", 1);
  add_numbers(sha, file, "/body", "inertia", 9);
  add_text(sha, file, "/body", "support");
  const bool rigid = holds_rigid_body(file);
  for (const char* name :
       {"youngs_modulus", "poisson_ratio", "density", "rayleigh_alpha", "rayleigh_beta"}) {
    if (rigid && std::string(name) != "density") continue;
    add_numbers(sha, file, "/material", name, 1);
  }
  add_dataset<double>(sha, file, kElementYoungsModulus);
  add_dataset<double>(sha, file, kElementPoissonRatio);
  add_dataset<double>(sha, file, kElementDensity);
  add_dataset<std::int32_t>(sha, file, kElementRegion);
  add_numbers(sha, file, "/response", "dt", 1);
  add_numbers(sha, file, "/response", "steps", 1);
  if (rigid) add_text(sha, file, "/response", kResponseKindAttribute);
  add_dataset<double>(sha, file, "/response/modal/angular_frequency");
  add_dataset<double>(sha, file, "/response/modal/decay_rate");
  add_reals(sha, file, "/response/modal/shapes");
  add_dataset<double>(sha, file, kModalCentrifugal);
  add_reals(sha, file, kDenseCentrifugal);
  add_dataset<double>(sha, file, kModalGravity);
  add_dataset<double>(sha, file, kModalGravityRest);
  add_reals(sha, file, kDenseGravity);
  add_dataset<std::int32_t>(sha, file, kResidualRowStart);
  add_dataset<std::int32_t>(sha, file, kResidualNodes);
  add_dataset<float>(sha, file, kResidualBlocks);
  if (file.exists(kCompressedFirScale)) {
    add_dataset<float>(sha, file, kCompressedFirScale);
    add_dataset<std::int16_t>(sha, file, kCompressedFir);
  } else {
    add_dataset<float>(sha, file, kCompressedFir);
  }
  add_dataset<float>(sha, file, kCompressedShapes);
  add_dataset<std::int32_t>(sha, file, kCompressedPoleShape);
  add_dataset<double>(sha, file, kCompressedPole);
  add_dataset<double>(sha, file, kCompressedAmplitude);
  add_dataset<float>(sha, file, kDisplayPositions);
  add_dataset<float>(sha, file, kDisplayNormals);
  add_dataset<std::int32_t>(sha, file, kDisplayTriangles);
  add_dataset<std::int32_t>(sha, file, kDisplayNodes);
  add_dataset<float>(sha, file, kDisplayWeights);
  add_dataset<float>(sha, file, kDisplayTextureCoordinates);
  add_dataset<std::uint8_t>(sha, file, kDisplayTexture);
  return sha.hexadecimal();
}

std::optional<std::string> stored_content_checksum(const hdf5::File& file) {
  if (H5Aexists(file.id(), kName) <= 0) return std::nullopt;
  return file.read_string_attribute("/", kName);
}

void store_content_checksum(hdf5::File& file) {
  file.write_attribute("/", kName, content_checksum(file));
}

}  // namespace irdm
