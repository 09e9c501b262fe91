#pragma once

#include "viewer/byte_stream.hpp"

/// What the messages of docs/viewer-protocol.md have in common.
namespace irdm::viewer {

enum class Type : std::uint16_t {
  kScene = 1,
  kFrame = 2,
  kHealth = 3,
  kState = 4,
  kHello = 16,
  kCommand = 17,
  kStylus = 18,
  kSettings = 19
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

inline constexpr double kMostGravity = 100.0;  ///< [m/s^2]
void put_settings(Writer& writer, const ObjectSettings& settings, const SettingsChoice& choice);
ObjectSettings get_settings(Reader& reader, SettingsChoice& choice);

}  // namespace irdm::viewer
