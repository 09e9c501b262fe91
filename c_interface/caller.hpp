#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <string_view>

#include "c_interface/irdm.h"
#include "common/geometry.hpp"

namespace irdm {

// What simulations and stylus clients take from the caller and give back.

/// Ended by a zero, cut where `size` bytes are too few. @param to may be null
inline void write_text(std::string_view text, char* to, std::size_t size) noexcept {
  if (to == nullptr || size == 0) return;
  const std::size_t length = std::min(size - 1, text.size());
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

/// Makes *handle what `make` returns, or null, and says in the message why.
/// @param what from which it is made
template <typename Handle, typename Make>
irdm_status open_handle(const char* what, Handle** handle, char* message, std::size_t size,
                        const Make& make) noexcept {
  write_text("", message, size);
  if (handle != nullptr) *handle = nullptr;
  if (what == nullptr || handle == nullptr) {
    write_text("a pointer is null", message, size);
    return IRDM_BAD_ARGUMENT;
  }
  try {
    *handle = new Handle(make());
    return IRDM_OK;
  } catch (const std::exception& error) {
    write_text(error.what(), message, size);
  } catch (...) {
    write_text("unknown error", message, size);
  }
  return IRDM_FAILED;
}

inline Vector3 tip_of(const irdm_command& command) noexcept {
  return {command.tip[0], command.tip[1], command.tip[2]};
}

/// All zero: not turned.
inline Quaternion orientation_of(const irdm_command& command) noexcept {
  const double* q = command.orientation;
  const bool turned = std::any_of(q, q + 4, [](double number) { return number != 0.0; });
  return turned ? Quaternion(q[0], q[1], q[2], q[3]) : Quaternion::Identity();
}

}  // namespace irdm
