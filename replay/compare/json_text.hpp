#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace irdm::replay {

/// Writes one JSON object, key by key in the order of the calls.
class JsonObject {
 public:
  JsonObject& add(std::string_view key, double value);  ///< null where it is not finite
  JsonObject& add(std::string_view key, std::size_t value);
  JsonObject& add(std::string_view key, bool value);
  JsonObject& add(std::string_view key, const char* value) { return add(key, std::string(value)); }
  JsonObject& add(std::string_view key, const std::string& value);
  JsonObject& add(std::string_view key, const std::vector<double>& values);
  JsonObject& add(std::string_view key, const JsonObject& value);
  JsonObject& add(std::string_view key, const std::vector<JsonObject>& values);  ///< a line each
  JsonObject& add_null(std::string_view key);

  std::string text() const { return "{" + text_ + "}"; }

 private:
  JsonObject& put(std::string_view key, const std::string& value);

  std::string text_;
};

}  // namespace irdm::replay
