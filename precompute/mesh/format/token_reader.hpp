#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/error.hpp"

namespace irdm::precompute {

/// Bound of every count in a mesh file.
inline constexpr std::int64_t kMaxCount = 100'000'000;

/// The bytes of a file. Throws Error when it is missing, unreadable or empty.
std::string file_content(const std::filesystem::path& path);

/// Returns the content of a text file without the byte order mark that some editors write before
/// it. Throws Error as file_content() does.
std::string text_content(const std::filesystem::path& path);

/// Reads a text file, or one with binary blocks between the text, word by word and says file and
/// line of what is wrong.
class TokenReader {
 public:
  /// Reads the whole file; from `comment` (if not 0) to the end of a line everything is skipped.
  /// Throws Error when the file is missing, unreadable or empty.
  explicit TokenReader(const std::filesystem::path& path, char comment = 0);

  bool at_end();
  /// The next word. Throws Error at the end of the file: it is truncated.
  std::string_view word();
  /// A whole number. Throws Error when the next word is not one.
  std::int64_t integer();
  /// A whole number in a range, for instance a count; `meaning` names it in the message.
  std::int64_t integer(std::int64_t lowest, std::int64_t highest, const std::string& meaning);
  /// A number, finite or not. Throws Error when the next word is not one.
  double number();
  void skip(std::int64_t words);
  /// Skips words until `wanted` has been read. Throws Error at the end of the file.
  void skip_past(std::string_view wanted);
  /// What is left of the line, which may be nothing, and the end of the line.
  std::string_view rest_of_line();
  /// Binary data: bytes that begin in the next line. Throws Error when the file has less.
  std::string_view bytes(std::size_t count);
  /// The same right after what was read last.
  std::string_view more_bytes(std::size_t count);

  /// Throws Error about the place that was read last.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

 private:
  void skip_blanks();
  bool ends_line(std::size_t at) const;

  std::string name_;
  std::string text_;
  std::size_t position_ = 0;
  int line_ = 1;
  char comment_;
};

}  // namespace irdm::precompute
