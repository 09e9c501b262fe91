#include "tests/haply/fake_world.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace irdm::test {
namespace {

using Json = FakeWorld::Json;

Json vector(const std::array<double, 3>& v) {
  return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
}

double length(const std::array<double, 3>& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

FakeWorld::FakeWorld(bool old, const std::vector<std::string>& ids) : old_(old) {
  for (const std::string& id : ids) devices_.push_back({.id = id});
}

FakeWorld::Device* FakeWorld::find(const std::string& id) {
  const auto found = std::find_if(devices_.begin(), devices_.end(),
                                  [&](const Device& device) { return device.id == id; });
  return found != devices_.end() ? &*found : nullptr;
}

// Down onto the top of a cube and up again, a second each way, as a hand that rests in between.
std::array<double, 3> FakeWorld::where(const Device& device) const {
  if (!pressing_since_) return device.position;
  const double t = std::chrono::duration<double>(Clock::now() - *pressing_since_).count();
  const double depth = std::clamp(1.5 * std::sin(t * 3.14159265), -1.0, 1.0);
  return {0.0, 0.0, 0.06 - 0.012 * depth};
}

Json FakeWorld::describe(const Device& device, bool with_config) {
  Json told = {{"device_id", device.id}};
  if (with_config) {
    told["config"] = {
        {"type", "inverse3"},
        {"port", "/dev/ttyACM0"},
        {"handedness", "right"},
        {"gravity_compensation", {{"enabled", device.gravity}, {"scaling_factor", 1.0}}}};
    if (old_) {
      told["config"]["device_info"] = {{"firmware_version", 1}, {"id", device.id}, {"model", 4}};
    } else {
      told["config"]["device_info"] = {
          {"major_version", 7}, {"minor_version", 4}, {"id", device.id}, {"device_type", 4}};
      told["config"]["basis"] = {{"permutation", "XYZ"}};
    }
  }
  const bool moves = length(device.force) > 0.0;
  told["state"] = {{"cursor_position", vector(where(device))},
                   {"cursor_velocity", vector({0, 0, 0})},
                   {"current_cursor_force", vector(device.force)},
                   {"control_mode", moves ? "force" : "idle"}};
  told["status"] = {{"calibrated", device.calibrated},
                    {"ready", device.ready},
                    {"power_supply", device.power_supply},
                    {"in_use", device.in_use},
                    {"started", true}};
  return told;
}

Json FakeWorld::describe_grip(bool with_config) const {
  Json told = {{"device_id", "61576"}};
  if (with_config) told["config"] = {{"type", "wireless_verse_grip"}};
  Json buttons;
  for (const char letter : {'a', 'b', 'c'}) {
    buttons[std::string(1, letter)] = pressed_.find(letter) != std::string::npos;
  }
  told["state"] = {
      {"orientation", {{"w", turned_[0]}, {"x", turned_[1]}, {"y", turned_[2]}, {"z", turned_[3]}}},
      {"buttons", buttons},
      {"hall", 0},
      {"battery_level", 0.9}};
  told["status"] = {{"connected", true}, {"awake", true}, {"ready", true}};
  return told;
}

std::string FakeWorld::state(bool with_config) {
  if (!garbage_.empty()) return garbage_;
  Json told;
  if (with_config && !old_) told["session_id"] = sessions_;
  told["inverse3"] = Json::array();
  for (const Device& device : devices_) {
    if (device.plugged) told["inverse3"].push_back(describe(device, with_config));
  }
  told["wireless_verse_grip"] = Json::array();
  if (grip_) told["wireless_verse_grip"].push_back(describe_grip(with_config));
  constexpr const char* kMark = "@x@";
  if (!number_.empty()) {
    for (Json& device : told["inverse3"]) device["state"]["cursor_position"]["x"] = kMark;
  }
  std::string text = told.dump();
  const std::string mark = std::string("\"") + kMark + "\"";
  for (std::size_t at = 0; (at = text.find(mark)) != std::string::npos;) {
    text.replace(at, mark.size(), number_);
  }
  return text;
}

std::string FakeWorld::full_state() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++sessions_;
  return state(true);
}

std::chrono::milliseconds FakeWorld::delay() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return delay_;
}

std::size_t FakeWorld::listen() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++listeners_;
  return events_.size();
}

std::string FakeWorld::event(std::size_t number) {
  std::unique_lock<std::mutex> lock(mutex_);
  event_told_.wait(lock, [&] { return events_.size() > number; });
  return events_[number];
}

std::optional<std::string> FakeWorld::answer(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Json message = Json::parse(text, nullptr, false);
  bool full = false;
  if (!message.is_object()) {
    ++misuses_;
    misuse_ = "no JSON";
  } else {
    take(message);
    full = message.contains("session") && message["session"].contains("force_render_full_state");
  }
  if (silent_) return std::nullopt;
  return state(full);
}

// A session's own settings are new in 3.5 (CFG).
void FakeWorld::take(const Json& message) {
  if (old_ && message.contains("session") && message["session"].contains("configure")) {
    ++misuses_;
    misuse_ = "session.configure";
  }
  if (!message.contains("inverse3")) return;
  for (const Json& entry : message["inverse3"]) {
    Device* const device = find(entry.value("device_id", ""));
    if (device == nullptr) {
      ++misuses_;
      misuse_ = "unknown device";
    } else if (device->plugged && entry.contains("commands")) {
      take_force(*device, entry["commands"]);
    }
  }
}

void FakeWorld::take_force(Device& device, const Json& commands) {
  const auto command = commands.find("set_cursor_force");
  const char* const key = old_ ? "values" : "vector";
  const char* const other = old_ ? "vector" : "values";
  if (command == commands.end() || !command->contains(key) || command->contains(other)) {
    ++misuses_;
    misuse_ = commands.dump();
    return;
  }
  std::array<double, 3> force{};
  constexpr std::array kAxes{"x", "y", "z"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const Json& number = (*command)[key][kAxes[i]];
    if (!number.is_number() || !std::isfinite(number.get<double>())) {
      ++misuses_;
      misuse_ = "a force that is no number";
      return;
    }
    force[i] = number.get<double>();
  }
  device.force = force;
  device.largest = std::max(device.largest, length(force));
  ++device.forces;
}

std::optional<std::string> FakeWorld::answer_http(const std::string& method,
                                                  const std::string& target,
                                                  const std::string& body) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (method == "GET" && target == "/version" && !old_) {
    return R"({"project_name":"haply-inverse-service","project_version":"3.5.0.0"})";
  }
  const Json told = Json::parse(body, nullptr, false);
  if (method != "POST" || !told.is_object()) return std::nullopt;
  if (old_) {
    Device* const device = find(told.value("device_id", ""));
    if (target != "/gravity_compensation" || device == nullptr) return std::nullopt;
    device->gravity = told.value("enable", false);
    return R"({"ok":true})";
  }
  for (Device& device : devices_) {
    if (target != "/inverse3/" + device.id + "/config/gravity_compensation") continue;
    device.gravity = told.value("enabled", false);
    return Json({{"ok", true}, {"data", told}}).dump();
  }
  return std::nullopt;
}

std::string FakeWorld::obey(const std::string& line) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::istringstream words(line);
  std::string order, id;
  words >> order;
  if (order == "silent") words >> silent_;
  if (order == "grip") words >> grip_;
  if (order == "garbage" || order == "number") {
    std::string& text = order == "garbage" ? garbage_ : number_;
    text.clear();
    std::getline(words >> std::ws, text);
  }
  if (order == "event") {
    std::getline(words >> std::ws, events_.emplace_back());
    event_told_.notify_all();
  }
  if (order == "listeners") return std::to_string(listeners_);
  if (order == "press") words >> pressed_;
  if (order == "release") pressed_.clear();
  if (order == "turn") {
    for (double& part : turned_) words >> part;
  }
  if (order == "late") {
    int milliseconds = 0;
    words >> milliseconds;
    delay_ = std::chrono::milliseconds(milliseconds);
  }
  if (order == "hand") pressing_since_ = Clock::now();
  if (order == "misuses") return std::to_string(misuses_) + " " + misuse_;
  if (order == "plugged" || order == "place" || order == "status" || order == "told") {
    words >> id;
    Device* const device = find(id);
    if (device == nullptr) return "no such device";
    if (order == "plugged") {
      words >> device->plugged;
      if (!device->plugged) device->force = {};  // nothing reaches it any more (CMD)
    }
    if (order == "place") {
      for (double& part : device->position) words >> part;
    }
    if (order == "status") {
      words >> device->calibrated >> device->ready >> device->power_supply >> device->in_use;
    }
    if (order == "told") {
      std::ostringstream text;
      text.precision(17);
      text << device->force[0] << ' ' << device->force[1] << ' ' << device->force[2] << ' '
           << device->forces << ' ' << device->gravity << ' ' << device->largest;
      return text.str();
    }
  }
  return "ok";
}

}  // namespace irdm::test
