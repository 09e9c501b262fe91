#include "common/quoted.hpp"

namespace irdm {
namespace {

// A byte of a character of UTF-8 that has begun before it.
bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

}  // namespace

std::string shortened(std::string_view words, std::size_t most) {
  if (words.size() <= most) return std::string(words);
  std::size_t end = most;
  while (end > 0 && most - end < 3 && continues(words[end])) --end;
  return std::string(words.substr(0, end)) + "...";
}

std::string in_quotes(std::string_view words) {
  return std::string("'").append(shortened(words)).append("'");
}

}  // namespace irdm
