#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace irdm::precompute {

/// Reads a text file word by word and says file and line of what is wrong.
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

  /// Throws Error about the place that was read last.
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const;

 private:
  void skip_blanks();

  std::string name_;
  std::string text_;
  std::size_t position_ = 0;
  int line_ = 1;
  char comment_;
};

}  // namespace irdm::precompute
