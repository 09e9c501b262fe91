#include "device_bridge/haply/inverse_events.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace irdm::haply {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<EventMeaning> meaning_of(const std::string& name, const std::string& safety) {
  if (name == "device-disconnected") return EventMeaning::kLost;
  if (name == "device-safety-triggered") {
    if (safety == "ebrake_triggered") return EventMeaning::kLocked;
    if (safety == "ebrake_released") return EventMeaning::kUnlocked;
    return std::nullopt;
  }
  constexpr std::array kNotices{"device-busy", "device-battery-low", "device-battery-critical",
                                "device-sleep"};
  const bool notice = std::find(kNotices.begin(), kNotices.end(), name) != kNotices.end();
  return notice ? std::optional(EventMeaning::kNotice) : std::nullopt;
}

}  // namespace

std::optional<InverseEvent> decode_event(std::string_view text) {
  const Json told = Json::parse(text, nullptr, false);
  if (!told.is_object()) return std::nullopt;
  const auto found = told.find("data");
  const Json data = found != told.end() && found->is_object() ? *found : Json::object();
  const std::string name = text_of(told, "name");
  const auto meaning = meaning_of(name, text_of(data, "safety_type"));
  if (!meaning) return std::nullopt;
  const std::string message = text_of(told, "message");
  return InverseEvent{*meaning, text_of(data, "device_id"),
                      message.empty() ? name : name + ": " + message};
}

}  // namespace irdm::haply
