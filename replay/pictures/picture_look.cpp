#include "replay/pictures/picture_look.hpp"

#include <array>
#include <charconv>

#include "common/error.hpp"
#include "common/quoted.hpp"

namespace irdm::replay {
namespace {

// Two numbers with a letter between them, and nothing else.
template <typename Number>
std::optional<std::array<Number, 2>> two_numbers(const std::string& text, char between) {
  std::array<Number, 2> numbers{};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, numbers[0]);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != between) return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, numbers[1]);
  if (second.ec != std::errc{} || second.ptr != end) return std::nullopt;
  return numbers;
}

}  // namespace

void read_size(const std::string& text, PictureLook& look) {
  const auto size = two_numbers<int>(text, 'x');
  const auto fits = [](int length) { return length >= 64 && length <= 8192; };
  if (!size || !fits(size->front()) || !fits(size->back())) {
    throw Error("--size " + shortened(text), "is no size of a picture",
                "give WIDTHxHEIGHT, each from 64 to 8192 pixels");
  }
  look.width = size->front();
  look.height = size->back();
}

PictureCamera read_camera(const std::string& text) {
  const auto angles = two_numbers<double>(text, ',');
  if (!angles || !(angles->front() >= -360.0 && angles->front() <= 360.0) ||
      !(angles->back() >= -90.0 && angles->back() <= 90.0)) {
    throw Error("--camera " + shortened(text), "is no direction",
                "give AZIMUTH,ELEVATION in degrees, the second from -90 to 90");
  }
  return {angles->front(), angles->back()};
}

}  // namespace irdm::replay
