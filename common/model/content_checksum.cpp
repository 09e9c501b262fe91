#include "common/model/content_checksum.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "common/checksum.hpp"
#include "common/model/compressed_file.hpp"
#include "common/model/model_check.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {
namespace {

constexpr const char* kName = "content_sha256";
constexpr hsize_t kBlockBytes = 4 << 20;  // read at a time

template <typename T>
void add_dataset(Sha256& sha, const hdf5::File& file, const std::string& path) {
  if (!file.exists(path)) return;
  const hdf5::Shape shape = file.stored_shape(path);
  if (shape.empty()) refuse_model(file.name(), path + " has no axes");
  sha.update(path.c_str(), path.size() + 1);
  for (const hsize_t extent : shape) {
    const auto wide = static_cast<std::uint64_t>(extent);
    sha.update(&wide, sizeof wide);
  }
  const hsize_t row =
      std::accumulate(shape.begin() + 1, shape.end(), hsize_t{1}, std::multiplies<>());
  if (row == 0) return;
  const hsize_t block = std::clamp<hsize_t>(kBlockBytes / (row * sizeof(T)), 1, shape[0] + 1);
  std::vector<T> values(block * row);
  hdf5::Shape start(shape.size(), 0);
  hdf5::Shape count = shape;
  for (start[0] = 0; start[0] < shape[0]; start[0] += count[0]) {
    count[0] = std::min(block, shape[0] - start[0]);
    file.read_slab<T>(path, start, count, values.data());
    sha.update(values.data(), count[0] * row * sizeof(T));
  }
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
  if (file.exists(kCompressedFir) && file.stores_integers(kCompressedFir)) {
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
  add_dataset<std::uint64_t>(sha, file, kDenseColumnChecksum);
  return sha.hexadecimal();
}

std::optional<std::string> stored_content_checksum(const hdf5::File& file) {
  if (H5Aexists(file.id(), kName) <= 0) return std::nullopt;
  return file.read_string_attribute("/", kName);
}

void store_content_checksum(hdf5::File& file) {
  file.write_attribute("/", kName, content_checksum(file));
}

void require_content_checksum(const hdf5::File& file) {
  const auto stored = stored_content_checksum(file);
  if (!stored || content_checksum(file) == *stored) return;
  refuse_model(file.name(), "was changed after it was written: its content_sha256 does not match");
}

template <typename Scalar>
std::uint64_t number_checksum(const Scalar* numbers, std::size_t count) {
  constexpr std::uint64_t kPrime = 0x100000001B3;
  std::uint64_t hash = 0xCBF29CE484222325;
  const auto* bytes = reinterpret_cast<const std::byte*>(numbers);
  for (std::size_t left = count * sizeof(Scalar); left > 0;) {
    std::uint64_t word = 0;
    const std::size_t size = std::min(left, sizeof word);
    std::memcpy(&word, bytes, size);
    hash = (hash ^ word) * kPrime;
    bytes += size;
    left -= size;
  }
  return hash;
}

ColumnChecksums::ColumnChecksums(const hdf5::File& file, std::size_t columns) : name_(file.name()) {
  if (!file.exists(kDenseColumnChecksum)) return;
  checksums_ = file.read<std::uint64_t>(kDenseColumnChecksum, {columns});
}

template <typename Scalar>
void ColumnChecksums::compare(std::size_t b, const Scalar* column, std::size_t count) const {
  if (empty() || number_checksum(column, count) == checksums_.at(b)) return;
  refuse_model(name_, std::string(kDenseR) + " was changed after it was written: column " +
                          std::to_string(b) + " has another checksum");
}

template std::uint64_t number_checksum(const float*, std::size_t);
template std::uint64_t number_checksum(const double*, std::size_t);
template void ColumnChecksums::compare(std::size_t, const float*, std::size_t) const;
template void ColumnChecksums::compare(std::size_t, const double*, std::size_t) const;

}  // namespace irdm
