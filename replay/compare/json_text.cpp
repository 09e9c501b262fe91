#include "replay/compare/json_text.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace irdm::replay {
namespace {

// The shortest that reads back to the bit. What is not finite is null: JSON knows no word for it.
std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string in_quotes(std::string_view text) {
  std::string all = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') all += '\\';
    if (code < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", code);
      all += escape;
    } else {
      all += letter;
    }
  }
  return all + "\"";
}

}  // namespace

JsonObject& JsonObject::put(std::string_view key, const std::string& value) {
  text_ += (text_.empty() ? "" : ", ") + in_quotes(key) + ": " + value;
  return *this;
}

JsonObject& JsonObject::add(std::string_view key, double value) {
  return put(key, number(value));
}

JsonObject& JsonObject::add(std::string_view key, std::size_t value) {
  return put(key, std::to_string(value));
}

JsonObject& JsonObject::add(std::string_view key, bool value) {
  return put(key, value ? "true" : "false");
}

JsonObject& JsonObject::add(std::string_view key, const std::string& value) {
  return put(key, in_quotes(value));
}

JsonObject& JsonObject::add(std::string_view key, const std::vector<double>& values) {
  std::string all;
  for (const double value : values) all += (all.empty() ? "" : ", ") + number(value);
  return put(key, "[" + all + "]");
}

JsonObject& JsonObject::add(std::string_view key, const JsonObject& value) {
  return put(key, value.text());
}

JsonObject& JsonObject::add(std::string_view key, const std::vector<JsonObject>& values) {
  std::string all;
  for (const JsonObject& value : values) all += (all.empty() ? "\n" : ",\n") + value.text();
  return put(key, "[" + all + "]");
}

JsonObject& JsonObject::add_null(std::string_view key) {
  return put(key, "null");
}

}  // namespace irdm::replay
