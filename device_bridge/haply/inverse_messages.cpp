#include "device_bridge/haply/inverse_messages.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

namespace irdm::haply {
namespace {

using Json = nlohmann::json;

// From the service's axes (right, away, up) to D's (right, up, towards the person).
Vector3 to_device(const Vector3& v) noexcept {
  return {v.x(), v.z(), -v.y()};
}

Vector3 to_service(const Vector3& v) noexcept {
  return {v.x(), 0.0 - v.z(), v.y()};  // of 0 no -0
}

double number(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) {
    throw MessageError(std::string(key) + " is no number");
  }
  return found->get<double>();
}

// A member that is an object; an empty one where there is none.
const Json& part(const Json& object, const char* key) {
  static const Json kNothing = Json::object();
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return kNothing;
  if (!found->is_object()) throw MessageError(std::string(key) + " is no object");
  return *found;
}

std::optional<bool> flag(const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_boolean()) return std::nullopt;
  return found->get<bool>();
}

std::string text(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<Vector3> read_position(const Json& state) {
  const auto found = state.find("cursor_position");
  if (found == state.end()) return std::nullopt;
  if (!found->is_object()) throw MessageError("cursor_position is no vector");
  const Vector3 tip(number(*found, "x"), number(*found, "y"), number(*found, "z"));
  if (!tip.allFinite()) throw MessageError("cursor_position is not finite");
  return to_device(tip);
}

std::optional<InverseStatus> read_status(const Json& device) {
  const Json& told = part(device, "status");
  if (told.empty()) return std::nullopt;
  return InverseStatus{.calibrated = flag(told, "calibrated").value_or(false),
                       .ready = flag(told, "ready").value_or(false),
                       .power_supply = flag(told, "power_supply").value_or(true),
                       .in_use = flag(told, "in_use").value_or(false)};
}

InverseDevice read_device(const Json& told) {
  const Json& config = part(told, "config");
  return {.id = text(told, "device_id"),
          .type = text(config, "type"),
          .handedness = text(config, "handedness"),
          .gravity_compensation = flag(part(config, "gravity_compensation"), "enabled"),
          .status = read_status(told),
          .tip = read_position(part(told, "state"))};
}

// Of a grip that sleeps it may be missing or have no length.
std::optional<Quaternion> read_orientation(const Json& state) {
  const Json& told = part(state, "orientation");
  if (told.empty()) return std::nullopt;
  const Vector3 axis = to_device({number(told, "x"), number(told, "y"), number(told, "z")});
  const Quaternion turned(number(told, "w"), axis.x(), axis.y(), axis.z());
  const double norm = turned.norm();
  if (!std::isfinite(norm) || norm < 0.5) return std::nullopt;
  return turned.normalized();
}

// The wired grip has one button, which comes alone.
VerseGrip read_grip(const Json& told) {
  const Json& state = part(told, "state");
  VerseGrip grip{.id = text(told, "device_id"), .orientation = read_orientation(state)};
  const Json& buttons = part(state, "buttons");
  constexpr std::array kNames{"a", "b", "c"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (flag(buttons, kNames[i]).value_or(false)) grip.buttons |= 1u << i;
  }
  if (flag(state, "button").value_or(false)) grip.buttons |= 1u;
  return grip;
}

template <typename Thing, typename Read>
void read_list(const Json& message, const char* key, std::vector<Thing>& things, Read read) {
  const auto found = message.find(key);
  if (found == message.end() || found->is_null()) return;
  if (!found->is_array()) throw MessageError(std::string(key) + " is no list");
  for (const Json& told : *found) {
    if (!told.is_object()) throw MessageError(std::string(key) + " has something else in it");
    things.push_back(read(told));
  }
}

Json vector(const Vector3& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

Json force_message(const std::string& device, const Vector3& force, ForceKey key) {
  const Vector3 sent = force.allFinite() ? to_service(force) : Vector3(Vector3::Zero());
  const char* const name = key == ForceKey::kVector ? "vector" : "values";
  const Json command = {{"set_cursor_force", {{name, vector(sent)}}}};
  const Json entry = {{"device_id", device}, {"commands", command}};
  return {{"inverse3", Json::array({entry})}};
}

}  // namespace

ServiceMessage decode(std::string_view text) {
  try {
    const Json told = Json::parse(text);
    if (!told.is_object()) throw MessageError("it is no object");
    ServiceMessage message{.session = told.contains("session_id")};
    read_list(told, "inverse3", message.devices, read_device);
    for (const char* key : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
      read_list(told, key, message.grips, read_grip);
    }
    return message;
  } catch (const Json::exception&) {  // out of range as well: 1e999
    throw MessageError("it is no JSON");
  }
}

std::string encode_force(const std::string& device, const Vector3& force, ForceKey key) {
  return force_message(device, force, key).dump();
}

std::string encode_first(const std::string& device) {
  Json message = force_message(device, Vector3::Zero(), ForceKey::kVector);
  message["session"]["configure"] = {{"profile", {{"name", "irdm:bridge"}}},
                                     {"basis", {{"permutation", "XYZ"}}}};
  return message.dump();
}

std::string encode_full_state() {
  return R"({"session":{"force_render_full_state":{}}})";
}

std::string encode_gravity(const std::string& device, ForceKey key) {
  if (key == ForceKey::kVector) {
    return Json({{"enabled", true}, {"scaling_factor", 1.0}}).dump();
  }
  return Json({{"device_id", device}, {"enable", true}, {"gravity_scaling_factor", 1.0}}).dump();
}

// In the data of an envelope, or alone.
std::optional<ServiceVersion> decode_version(std::string_view answer) {
  const Json told = Json::parse(answer, nullptr, false);
  if (!told.is_object()) return std::nullopt;
  const auto data = told.find("data");
  const bool wrapped = data != told.end() && data->is_object();
  const std::string words = text(wrapped ? *data : told, "project_version");
  ServiceVersion version;
  const char* const end = words.data() + words.size();
  const auto major = std::from_chars(words.data(), end, version.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
  return minor.ec == std::errc() ? std::optional(version) : std::nullopt;
}

}  // namespace irdm::haply
