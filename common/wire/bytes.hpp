#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "common/geometry.hpp"
#include "common/wire/protocol_error.hpp"

/// Little-endian fields in a row of bytes. Running past the end is a broken invariant of this
/// program (sizes are checked before), reported as std::logic_error.
namespace irdm::wire {

/// Whether a byte is a printable character of ASCII, the blank included.
inline bool is_printable(std::uint8_t byte) noexcept {
  return byte >= 0x20 && byte < 0x7F;
}

class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  void put(T value) {
    const std::span<std::uint8_t> field = take(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      field[i] = static_cast<std::uint8_t>(value >> (8 * i));
    }
  }
  void put(std::int64_t value) { put(static_cast<std::uint64_t>(value)); }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const Vector3& v) {
    for (int axis = 0; axis < 3; ++axis) put(v[axis]);
  }
  /// As w, x, y, z.
  void put(const Quaternion& q) {
    put(q.w());
    put(q.x());
    put(q.y());
    put(q.z());
  }
  /// Cut to `size` bytes, or filled up with zeros; what is not printable ASCII becomes '?'.
  void put_text(const std::string& text, std::size_t size) {
    const std::span<std::uint8_t> field = take(size);
    std::fill(field.begin(), field.end(), std::uint8_t{0});
    std::transform(text.begin(),
                   text.begin() + static_cast<std::ptrdiff_t>(std::min(text.size(), size)),
                   field.begin(), [](char letter) {
                     const auto byte = static_cast<std::uint8_t>(letter);
                     return is_printable(byte) ? byte : static_cast<std::uint8_t>('?');
                   });
  }
  void put_zeros(std::size_t size) { put_text("", size); }

 private:
  std::span<std::uint8_t> take(std::size_t size) {
    if (size > bytes_.size()) throw std::logic_error("field outside its payload");
    const std::span<std::uint8_t> field = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return field;
  }
  std::span<std::uint8_t> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  T get() {
    const std::span<const std::uint8_t> field = take(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value = static_cast<T>(value | static_cast<T>(static_cast<T>(field[i]) << (8 * i)));
    }
    return value;
  }
  std::int64_t get_signed() { return static_cast<std::int64_t>(get<std::uint64_t>()); }
  float get_single() { return std::bit_cast<float>(get<std::uint32_t>()); }
  double get_number() { return std::bit_cast<double>(get<std::uint64_t>()); }
  Vector3 get_vector() {
    Vector3 v;
    for (int axis = 0; axis < 3; ++axis) v[axis] = get_number();
    return v;
  }
  Quaternion get_quaternion() {
    Quaternion q;
    q.w() = get_number();
    q.x() = get_number();
    q.y() = get_number();
    q.z() = get_number();
    return q;
  }
  /// Up to the first zero. Throws ProtocolError where a byte before it is not printable ASCII: the
  /// text may end up in a log.
  std::string get_text(std::size_t size) {
    std::string text;
    for (const std::uint8_t byte : take(size)) {
      if (byte == 0) break;
      if (!is_printable(byte)) {
        throw ProtocolError(ProtocolFault::kBadValue, "a text is not printable ASCII");
      }
      text += static_cast<char>(byte);
    }
    return text;
  }
  void skip(std::size_t size) { take(size); }

 private:
  std::span<const std::uint8_t> take(std::size_t size) {
    if (size > bytes_.size()) throw std::logic_error("field outside its payload");
    const std::span<const std::uint8_t> field = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return field;
  }
  std::span<const std::uint8_t> bytes_;
};

}  // namespace irdm::wire
