#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace irdm::wire {

enum class ProtocolFault {
  kWrongMagic,    ///< not this protocol
  kWrongVersion,  ///< see VersionMismatch
  kUnknownType,   ///< type not defined in this version
  kTooLong,       ///< payload beyond kMaxPayload
  kWrongLength,   ///< payload not as long as its type demands
  kChecksum,      ///< CRC32C differs
  kBadValue,      ///< a field outside its range
  kNotFinite,     ///< a number that is infinite or not a number
  kUnexpected,    ///< a message that has no place at this point of the session
  kBackward,      ///< a sequence that does not grow
  kTruncated,     ///< a frame that was begun and not finished in time
};

/// The peer broke the protocol; the connection cannot go on.
class ProtocolError : public std::runtime_error {
 public:
  ProtocolError(ProtocolFault fault, const std::string& what)
      : std::runtime_error(what), fault_(fault) {}
  ProtocolFault fault() const noexcept { return fault_; }

 private:
  ProtocolFault fault_;
};

/// The two sides have no version in common.
class VersionMismatch : public ProtocolError {
 public:
  VersionMismatch(std::uint16_t theirs_min, std::uint16_t theirs_max, std::uint16_t ours_min,
                  std::uint16_t ours_max)
      : ProtocolError(ProtocolFault::kWrongVersion,
                      "peer speaks protocol version " + range(theirs_min, theirs_max) +
                          ", this program " + range(ours_min, ours_max)),
        theirs_min_(theirs_min),
        theirs_max_(theirs_max) {}
  std::uint16_t theirs_min() const noexcept { return theirs_min_; }
  std::uint16_t theirs_max() const noexcept { return theirs_max_; }

 private:
  static std::string range(std::uint16_t low, std::uint16_t high) {
    return low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high);
  }
  std::uint16_t theirs_min_;
  std::uint16_t theirs_max_;
};

}  // namespace irdm::wire
