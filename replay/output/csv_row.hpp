#pragma once

#include <charconv>
#include <string>

#include "common/geometry.hpp"

namespace irdm::replay {

/// One line of a table with commas between its fields. Numbers are written so that they read back
/// to the bit.
class CsvRow {
 public:
  template <typename Number>
  void add(Number value) {
    char text[32];
    add_text({text, std::to_chars(text, text + sizeof text, value).ptr});
  }
  void add(const Vector3& v) {
    for (const double value : v) add(value);
  }
  void add(const Quaternion& q) {
    add(q.w());
    add(Vector3(q.vec()));
  }
  /// @param word without a comma
  void add_text(const std::string& word) {
    if (!line_.empty()) line_ += ',';
    line_ += word;
  }
  std::string text() const { return line_ + "\n"; }

 private:
  std::string line_;
};

/// Names of a vector's columns, each after a comma.
inline std::string vector_columns(const std::string& name, const std::string& unit) {
  std::string columns;
  for (const char* axis : {"_x", "_y", "_z"}) columns += "," + name + axis + unit;
  return columns;
}

}  // namespace irdm::replay
