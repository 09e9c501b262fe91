#include "common/error.hpp"

#include "common/utf8.hpp"

namespace irdm {
namespace {

// A byte of a character of UTF-8 that has begun before it.
bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

// Words that are not UTF-8 throughout are of a binary file: none of their bytes is taken for a
// character beyond ASCII.
std::string printable(std::string_view words) {
  const bool text = is_utf8(words);
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
