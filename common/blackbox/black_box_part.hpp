#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/hdf5/file.hpp"

namespace irdm {

/// Something that a black box is written for.
struct Fault {
  std::int64_t time_ns = 0;  ///< monotonic_ns()
  std::string kind = {};     ///< a few words, the same for all of a kind
  std::string detail = {};   ///< which, if there is more to say
};

/// One kind of thing that a black box keeps. Black box's thread only.
class BlackBoxPart {
 public:
  static constexpr std::int64_t kKeptNs = 2'000'000'000;

  BlackBoxPart() = default;
  BlackBoxPart(const BlackBoxPart&) = delete;
  BlackBoxPart& operator=(const BlackBoxPart&) = delete;
  virtual ~BlackBoxPart() = default;

  /// Takes what has come since the last call. The first fault in it.
  virtual std::optional<Fault> take() = 0;
  /// Keeps the last kKeptNs before that time, and before the newest that it has where that is
  /// older.
  virtual void forget(std::int64_t now_ns) = 0;
  /// Writes all that it has, times from `origin_ns` on. Throws Error.
  virtual void write(hdf5::File& file, std::int64_t origin_ns) const = 0;
};

}  // namespace irdm
