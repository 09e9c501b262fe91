#include "common/error.hpp"

#include <algorithm>

namespace irdm {
namespace {

// A byte of a character of UTF-8 that has begun before it.
bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

// Bytes of the character of UTF-8 at the front; 0: there is none.
std::size_t character(std::string_view words) {
  const auto first = static_cast<unsigned char>(words.front());
  const std::size_t bytes = first < 0x80   ? 1
                            : first < 0xC2 ? 0
                            : first < 0xE0 ? 2
                            : first < 0xF0 ? 3
                            : first < 0xF5 ? 4
                                           : 0;
  if (bytes > words.size()) return 0;
  const std::string_view rest = words.substr(0, bytes).substr(std::min<std::size_t>(bytes, 1));
  return std::all_of(rest.begin(), rest.end(), continues) ? bytes : 0;
}

bool is_text(std::string_view words) {
  while (!words.empty()) {
    const std::size_t bytes = character(words);
    if (bytes == 0) return false;
    words.remove_prefix(bytes);
  }
  return true;
}

// Words that are not UTF-8 throughout are of a binary file: none of their bytes is taken for a
// character beyond ASCII.
std::string printable(std::string_view words) {
  const bool text = is_text(words);
  std::string out(words);
  for (char& c : out) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F || (byte >= 0x80 && !text)) c = '?';
  }
  return out;
}

}  // namespace

std::string shortened(std::string_view words, std::size_t most) {
  if (words.size() <= most) return printable(words);
  std::size_t end = most;
  while (end > 0 && most - end < 3 && continues(words[end])) --end;
  return printable(words.substr(0, end)) + "...";
}

std::string in_quotes(std::string_view words) {
  return std::string("'").append(shortened(words)).append("'");
}

}  // namespace irdm
