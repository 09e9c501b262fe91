#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "viewer/message.hpp"

/// Little-endian fields of the viewer's messages. Other than those of the wire between bridge and
/// server, they have no size that is known beforehand: the writer grows, the reader checks.
namespace irdm::viewer {

class Writer {
 public:
  /// Replaces what is in `bytes`.
  explicit Writer(Bytes& bytes) : bytes_(bytes) { bytes_.clear(); }

  template <std::unsigned_integral T>
  void put(T value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Vector3& v) {
    for (int axis = 0; axis < 3; ++axis) put(v[axis]);
  }
  void put(const Eigen::Vector3f& v) {
    for (int axis = 0; axis < 3; ++axis) put(v[axis]);
  }
  void put_text(const std::string& text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  void put_zeros(std::size_t count) { bytes_.resize(bytes_.size() + count); }
  /// Zeros up to the next multiple of 4 bytes.
  void align() { put_zeros((4 - bytes_.size() % 4) % 4); }

 private:
  Bytes& bytes_;
};

/// Throws MessageError when a field is not there.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes), size_(bytes.size()) {}

  template <std::unsigned_integral T>
  T get() {
    const std::span<const std::uint8_t> field = take(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value = static_cast<T>(value | static_cast<T>(static_cast<T>(field[i]) << (8 * i)));
    }
    return value;
  }
  float get_single() { return std::bit_cast<float>(get<std::uint32_t>()); }
  double get_double() { return std::bit_cast<double>(get<std::uint64_t>()); }
  Vector3 get_vector() {
    const double x = get_double();
    const double y = get_double();
    return {x, y, get_double()};
  }
  Eigen::Vector3f get_single_vector() {
    const float x = get_single();
    const float y = get_single();
    return {x, y, get_single()};
  }
  std::string get_text(std::size_t length) {
    const std::span<const std::uint8_t> field = take(length);
    return {field.begin(), field.end()};
  }
  void skip(std::size_t count) { take(count); }
  /// To the next multiple of 4 bytes from the message's start.
  void align() { skip((4 - (size_ - rest_.size()) % 4) % 4); }

  /// Before memory is taken for `count` items that the message claims to have.
  void expect(std::size_t count, std::size_t size_each) const {
    if (count > rest_.size() / size_each) throw MessageError("it is too short");
  }
  void finish() const {
    if (!rest_.empty()) throw MessageError("it is too long");
  }

 private:
  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > rest_.size()) throw MessageError("it is too short");
    const std::span<const std::uint8_t> field = rest_.first(count);
    rest_ = rest_.subspan(count);
    return field;
  }
  std::span<const std::uint8_t> rest_;
  std::size_t size_;
};

// What the messages of docs/viewer-protocol.md have in common.

enum class Type : std::uint16_t {
  kScene = 1,
  kFrame = 2,
  kHealth = 3,
  kState = 4,
  kHello = 16,
  kCommand = 17,
  kStylus = 18,
  kSettings = 19,
  kLoadScene = 20
};

void put_header(Writer& writer, Type type);
Type get_header(Reader& reader);
/// Reads the header. Throws MessageError when it is of another type.
void expect_type(Reader& reader, Type type);

/// A count of objects or styluses.
std::size_t get_count(Reader& reader, int largest);
double get_between(Reader& reader, double least, double largest);
/// Each component within +-largest.
Vector3 get_bounded_vector(Reader& reader, double largest);

/// w x y z in single precision; not normalised.
void put_orientation(Writer& writer, const Quaternion& q);
Quaternion get_orientation(Reader& reader);

inline constexpr double kMostGravity = 100.0;  ///< [m/s^2]
void put_settings(Writer& writer, const ObjectSettings& settings, const SettingsChoice& choice);
ObjectSettings get_settings(Reader& reader, SettingsChoice& choice);

}  // namespace irdm::viewer
