#include "precompute/mesh/format/token_reader.hpp"

#include <cctype>
#include <charconv>
#include <fstream>
#include <iterator>

#include "common/config/input_file.hpp"
#include "common/error.hpp"

namespace irdm::precompute {
namespace {

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

// Reads the whole word as a number; from_chars knows no leading plus sign.
template <typename Number>
bool parse(std::string_view word, Number& value) {
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace

std::string file_content(const std::filesystem::path& path) {
  const std::string name = path.string();
  require_file(path);
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw Error(name, "cannot be read", "check its permissions");
  if (text.empty()) throw Error(name, "is empty", "write the mesh again");
  return text;
}

std::string text_content(const std::filesystem::path& path) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string text = file_content(path);
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

TokenReader::TokenReader(const std::filesystem::path& path, char comment)
    : name_(path.string()), text_(text_content(path)), comment_(comment) {
  if (at_end()) throw Error(name_, "is empty", "write the mesh again");
}

void TokenReader::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (comment_ != 0 && c == comment_) {
      position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
    } else if (is_blank(c)) {
      line_ += ends_line(position_) ? 1 : 0;
      ++position_;
    } else {
      return;
    }
  }
}

bool TokenReader::at_end() {
  skip_blanks();
  return position_ == text_.size();
}

std::string_view TokenReader::word() {
  if (at_end()) fail("the file ends too early", "it is truncated: write the mesh again");
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_blank(text_[position_])) ++position_;
  return std::string_view(text_).substr(start, position_ - start);
}

std::int64_t TokenReader::integer() {
  const std::string_view text = word();
  std::int64_t value = 0;
  if (!parse(text, value)) {
    fail(in_quotes(text) + " is not a whole number", "write the mesh again");
  }
  return value;
}

std::int64_t TokenReader::integer(std::int64_t lowest, std::int64_t highest,
                                  const std::string& meaning) {
  const std::int64_t value = integer();
  if (value < lowest || value > highest) {
    fail(meaning + " is " + std::to_string(value),
         "it must lie from " + std::to_string(lowest) + " to " + std::to_string(highest));
  }
  return value;
}

double TokenReader::number() {
  const std::string_view text = word();
  double value = 0.0;
  if (!parse(text, value)) {
    fail(in_quotes(text) + " is not a number", "write the mesh again");
  }
  return value;
}

void TokenReader::skip(std::int64_t words) {
  for (std::int64_t i = 0; i < words; ++i) word();
}

void TokenReader::skip_past(std::string_view wanted) {
  while (word() != wanted) {
  }
}

std::string_view TokenReader::rest_of_line() {
  const std::size_t start = position_;
  const std::size_t end = std::min(text_.find_first_of("\r\n", start), text_.size());
  const bool two_bytes = text_.compare(end, 2, "\r\n") == 0;
  position_ = std::min(end + (two_bytes ? 2 : 1), text_.size());
  line_ += end < text_.size() ? 1 : 0;
  std::string_view line = std::string_view(text_).substr(start, end - start);
  if (comment_ != 0) line = line.substr(0, line.find(comment_));
  return line;
}

// Lines end with LF, CR LF or, as on old Macintoshes, CR alone.
bool TokenReader::ends_line(std::size_t at) const {
  return text_[at] == '\n' || (text_[at] == '\r' && text_.compare(at, 2, "\r\n") != 0);
}

std::string_view TokenReader::bytes(std::size_t count) {
  rest_of_line();
  return more_bytes(count);
}

std::string_view TokenReader::more_bytes(std::size_t count) {
  if (count > text_.size() - position_) {
    fail("the file ends too early", "it is truncated: write the mesh again");
  }
  const std::string_view found = std::string_view(text_).substr(position_, count);
  position_ += count;
  return found;
}

void TokenReader::fail(const std::string& what, const std::string& remedy) const {
  throw Error(name_ + ":" + std::to_string(line_), what, remedy);
}

}  // namespace irdm::precompute
