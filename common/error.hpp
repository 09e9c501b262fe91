#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace irdm {

/// A failure that a person has to do something about, thrown at start-up and at the boundaries
/// (files, configuration, network set-up), never inside a real-time step. Its text is one line that
/// says where the fault is, what is wrong and what to do: `cube.toml:7: density is -1; give ...`.
/// Control characters, in words that are quoted from a file say, are replaced: they may mean
/// something to a terminal.
class Error : public std::runtime_error {
 public:
  /// @param where file, file:line or peer in which the fault lies
  /// @param what what is wrong there
  /// @param remedy what to do about it
  Error(const std::string& where, const std::string& what, const std::string& remedy)
      : std::runtime_error(one_line(where + ": " + what + "; " + remedy)) {}

 private:
  static std::string one_line(std::string text) {
    for (char& letter : text) {
      const auto code = static_cast<unsigned char>(letter);
      if (code < 0x20 || code == 0x7F) letter = '?';
    }
    return text;
  }
};

inline constexpr std::size_t kMostQuoted = 80;  ///< bytes of an input in a message

/// Words of an input for a message: what is beyond `most` bytes becomes "...", and each byte that
/// is no character, or one of control, "?".
std::string shortened(std::string_view words, std::size_t most = kMostQuoted);
/// The same, 'in quotes'.
std::string in_quotes(std::string_view words);

}  // namespace irdm
