#include "device_bridge/haply/inverse_link.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <utility>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/haply/http_request.hpp"

namespace irdm::haply {
namespace {

constexpr std::int64_t kPeriodNs = 500'000;            // from one message to the next
constexpr std::int64_t kAbsentPeriodNs = 100'000'000;  // while the device is not there
constexpr std::int64_t kSilenceNs = 1'000'000'000;     // then the connection is made anew
constexpr std::int64_t kPauseNs = 250'000'000;         // before it is tried a second time
constexpr std::int64_t kConnectNs = 4'000'000'000;     // until the first message
constexpr std::int64_t kEndNs = 300'000'000;           // for the last answer and the goodbye

constexpr const char* kStart =
    "start the Inverse Service (systemctl start haply-inverse-service), or correct `service`";

// Devices that this process has opened, by id: a service has more than one address.
std::mutex claims_mutex;
std::set<std::string> claims;

bool lay_claim(const std::string& claim) {
  const std::lock_guard<std::mutex> lock(claims_mutex);
  return claims.insert(claim).second;
}

template <typename Thing>
const Thing* find(const std::vector<Thing>& things, const std::string& id) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [&](const Thing& thing) { return thing.id == id; });
  return found != things.end() ? &*found : nullptr;
}

std::string names(const std::vector<InverseDevice>& devices) {
  std::string all;
  for (const InverseDevice& device : devices) all += (all.empty() ? "" : ", ") + device.id;
  return all.empty() ? "none" : all;
}

}  // namespace

std::string to_text(const InverseReport& report) {
  const double mean = report.answers > 0 ? report.sum / static_cast<double>(report.answers) : 0.0;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%llu answers, round trip mean %.3f, p99 %.3f, max %.3f ms; %llu messages not "
                "understood, %llu reconnects",
                static_cast<unsigned long long>(report.answers), 1e3 * mean,
                1e-6 * static_cast<double>(report.round_trip.percentile(0.99)),
                1e-6 * static_cast<double>(report.round_trip.maximum()),
                static_cast<unsigned long long>(report.bad_messages),
                static_cast<unsigned long long>(report.reconnects));
  return text.data();
}

InverseLink::InverseLink(InverseSettings settings, InverseMailbox& mailbox)
    : settings_(std::move(settings)), mailbox_(mailbox) {
  device_.id = settings_.device;
}

std::string InverseLink::label() const {
  return device_.id.empty() ? "first Haply device" : "Haply device " + device_.id;
}

void InverseLink::open() {
  constexpr std::chrono::seconds kPatience(10);
  std::future<void> opened = opened_.get_future();
  connect();
  thread_ = std::thread([this] { run(); });
  try {
    apply_scheduling(settings_.scheduling, thread_, kNetworkPriority);
    if (opened.wait_for(kPatience) != std::future_status::ready) {
      throw Error(
          settings_.device.empty() ? "first Haply device" : "Haply device " + settings_.device,
          "the service at " + host_text(settings_.service) + " does not answer", kStart);
    }
    opened.get();
  } catch (...) {
    close();
    throw;
  }
}

// What a handler throws (no memory, no threads) costs the connection.
void InverseLink::run() noexcept {
  for (;;) {
    try {
      io_.run();
      return;
    } catch (const std::exception& error) {
      try {
        fail(error.what(), "connecting again");
      } catch (...) {
        return;
      }
    }
  }
}

void InverseLink::close() noexcept {
  if (!thread_.joinable()) return;
  boost::asio::post(io_, [this] { begin_end(); });
  thread_.join();
  const std::lock_guard<std::mutex> lock(claims_mutex);
  claims.erase(claim_);
}

std::string InverseLink::trouble() const {
  const std::lock_guard<std::mutex> lock(trouble_mutex_);
  return trouble_;
}

void InverseLink::complain(const std::string& what) {
  const std::lock_guard<std::mutex> lock(trouble_mutex_);
  trouble_ = what.empty() ? "" : label() + ": " + what;
}

void InverseLink::connect() {
  phase_ = Phase::kConnecting;
  sent_ns_.clear();
  socket_ = std::make_shared<ServiceSocket>(
      io_, settings_.service,
      ServiceSocket::Listener{.message = [this](const std::string& text) { take(text); },
                              .lost =
                                  [this](const std::string& cause) {
                                    fail("no connection to the service at " +
                                             host_text(settings_.service) + ": " + cause,
                                         kStart);
                                  }});
  socket_->open();
  wake_at(monotonic_ns() + kConnectNs, &InverseLink::give_up_connecting);
}

void InverseLink::give_up_connecting() {
  fail("the service at " + host_text(settings_.service) + " says nothing", kStart);
}

// Each message but the first answers one of ours, whatever is in it.
void InverseLink::take(const std::string& text) {
  if (phase_ != Phase::kConnecting) count_answer();
  ServiceMessage message;
  try {
    message = decode(text);
  } catch (const MessageError& error) {
    ++report_.bad_messages;
    const std::string what =
        std::string("the service's message is not understood: ") + error.what();
    const char* const remedy = "use an Inverse Service 3.x, or correct `service`";
    if (phase_ == Phase::kConnecting) return fail(what, remedy);
    return complain(what + "; " + remedy);
  }
  if (phase_ == Phase::kConnecting) return take_inventory(message);
  if (phase_ != Phase::kEnding) take_update(message);
}

void InverseLink::count_answer() {
  if (sent_ns_.empty()) return;
  const std::int64_t taken_ns = monotonic_ns() - sent_ns_.front();
  sent_ns_.pop_front();
  ++report_.answers;
  report_.sum += kNanosecond * static_cast<double>(taken_ns);
  report_.round_trip.add(taken_ns);
}

void InverseLink::take_inventory(const ServiceMessage& inventory) {
  if (claim_.empty() && !choose(inventory)) return;
  last_good_ns_ = next_turn_ns_ = monotonic_ns();
  const InverseDevice* const device = find(inventory.devices, device_.id);
  if (device == nullptr) {
    withhold();
    phase_ = Phase::kAbsent;
    complain("is not there; check power and cable");
    return turn();
  }
  set_up(inventory, *device);
}

// Once. False: refused.
bool InverseLink::choose(const ServiceMessage& inventory) {
  const InverseDevice* chosen = nullptr;
  for (const InverseDevice& device : inventory.devices) {
    const bool wanted = settings_.device.empty() || device.id == settings_.device;
    if (!wanted || device.id.empty()) continue;
    if (lay_claim(device.id)) {
      chosen = &device;
      break;
    }
    if (!settings_.device.empty()) {
      refuse("is open already", "give each [[device]] a name of its own");
      return false;
    }
  }
  if (chosen == nullptr) {
    refuse(
        "the service has no such device, or it is open already; found: " + names(inventory.devices),
        "check power and cable, and give the id that Haply Hub shows as name");
    return false;
  }
  device_ = *chosen;
  claim_ = device_.id;
  return true;
}

// Waits for the service's HTTP. One that is connected to again is known: it hears zero at once.
void InverseLink::set_up(const ServiceMessage& inventory, const InverseDevice& device) {
  device_.status = device.status;
  if (!waited_for_) {
    if (!device.gravity_compensation.value_or(true)) turn_gravity_on();
    return begin_exchange();
  }
  const auto answer = http_request(settings_.service, boost::beast::http::verb::get, "/version");
  const auto version = answer ? decode_version(*answer) : std::nullopt;
  if (version && version->major != 3) {
    return refuse("the service's version " + std::to_string(version->major) + "." +
                      std::to_string(version->minor) + " is not known",
                  "use an Inverse Service 3.x");
  }
  const bool new_words = version ? version->minor >= 5 : inventory.session;
  key_ = new_words ? ForceKey::kVector : ForceKey::kValues;
  if (!device.gravity_compensation.value_or(false)) turn_gravity_on();
  if (device.status && device.status->in_use) {
    spdlog::warn("{}: another program commands it, too; end that", label());
  }
  const std::string hand = device.handedness.empty() ? "" : ", " + device.handedness + "-handed";
  spdlog::info("{}: {}{}, Inverse Service {}", label(),
               device.type.empty() ? "inverse3" : device.type, hand,
               version ? "3." + std::to_string(version->minor) : "of unknown version");
  begin_exchange();
}

// 3.5 has it below the device, on the same port; before, it is on the port of the HTTP service.
void InverseLink::turn_gravity_on() {
  const bool new_words = key_ == ForceKey::kVector;
  ServerAddress address = settings_.service;
  if (!new_words) address.port = settings_.old_http_port;
  const std::string target = new_words ? "/inverse3/" + device_.id + "/config/gravity_compensation"
                                       : "/gravity_compensation";
  if (!http_request(address, boost::beast::http::verb::post, target,
                    encode_gravity(device_.id, key_))) {
    spdlog::warn("{}: its gravity compensation is off; turn it on in Haply Hub", label());
  }
}

void InverseLink::begin_exchange() {
  phase_ = Phase::kExchanging;
  withhold();
  const std::int64_t now_ns = monotonic_ns();
  last_good_ns_ = next_turn_ns_ = now_ns;
  send(key_ == ForceKey::kVector ? encode_first(device_.id)
                                 : encode_force(device_.id, Vector3::Zero(), key_),
       now_ns);
  wait(kPeriodNs);
}

void InverseLink::take_update(const ServiceMessage& update) {
  const InverseDevice* const device = find(update.devices, device_.id);
  if (phase_ == Phase::kAbsent) {
    last_good_ns_ = monotonic_ns();
    if (device == nullptr) return;
    socket_->drop();
    return connect();  // for a first message, with its configuration
  }
  if (device == nullptr) {
    withhold();
    phase_ = Phase::kAbsent;
    return complain("is unplugged, no force; check power and cable");
  }
  if (device->tip) return take_state(*device, update);
  ++report_.bad_messages;
  complain("the service tells no position, no force; update it");
}

void InverseLink::take_state(const InverseDevice& device, const ServiceMessage& update) {
  last_good_ns_ = reading_.time_ns = monotonic_ns();
  reading_.tip = *device.tip;
  const VerseGrip* grip = settings_.grip.empty() && !update.grips.empty()
                              ? &update.grips.front()
                              : find(update.grips, settings_.grip);
  reading_.buttons = grip != nullptr ? grip->buttons : 0;
  if (grip != nullptr && grip->orientation) reading_.orientation = *grip->orientation;
  if (device.status) device_.status = device.status;
  tell_status(device_.status.value_or(InverseStatus{}));
  mailbox_.reading.put(reading_);
  if (std::exchange(waited_for_, false)) opened_.set_value();
}

// What was not ready begins anew.
void InverseLink::tell_status(const InverseStatus& status) {
  const bool ready = status.ready && status.calibrated && status.power_supply;
  if (ready && !reading_.ready) ++reading_.generation;
  reading_.ready = ready;
  if (ready) return complain("");
  if (!status.power_supply) return complain("has no power supply, no force; plug it in");
  if (!status.calibrated) {
    return complain(
        "is not calibrated, no force; rest the grip in its place until the light is "
        "steady");
  }
  complain("is not ready, no force; look into Haply Hub");
}

// No force until it is ready again.
void InverseLink::withhold() {
  reading_.ready = false;
  mailbox_.reading.put(reading_);
}

void InverseLink::turn() {
  const std::int64_t now_ns = monotonic_ns();
  if (phase_ == Phase::kEnding) return end_turn(now_ns);
  if (now_ns - last_good_ns_ > kSilenceNs) {
    return fail("no state from the service for a second", kStart);
  }
  if (phase_ == Phase::kAbsent) {
    if (sent_ns_.empty() && !socket_->writing()) send(encode_full_state(), now_ns);
    return wait(kAbsentPeriodNs);
  }
  send_force(now_ns);
  wait(kPeriodNs);
}

// An answer that is late is not waited for: what was sent last would stay on.
void InverseLink::send_force(std::int64_t now_ns) {
  if (socket_->writing()) return;
  if (sent_ns_.empty()) {
    return send(encode_force(device_.id, newest_force(now_ns), key_), now_ns);
  }
  if (sent_ns_.size() > 1 || now_ns - sent_ns_.front() <= kLongestAgeNs) return;
  withhold();
  complain("the service does not answer, no force; restart it");
  send(encode_force(device_.id, Vector3::Zero(), key_), now_ns);
}

Vector3 InverseLink::newest_force(std::int64_t now_ns) {
  mailbox_.force.receive();
  const InverseForce& newest = mailbox_.force.front();
  const bool usable = reading_.ready && newest.generation == reading_.generation &&
                      now_ns - newest.time_ns <= kLongestAgeNs;
  return usable ? newest.force : Vector3(Vector3::Zero());
}

void InverseLink::send(std::string text, std::int64_t now_ns) {
  sent_ns_.push_back(now_ns);
  socket_->write(std::move(text));
}

void InverseLink::wait(std::int64_t period_ns) {
  next_turn_ns_ = std::max(next_turn_ns_ + period_ns, monotonic_ns());
  wake_at(next_turn_ns_, &InverseLink::turn);
}

// One at a time: an earlier one that is due already does nothing.
void InverseLink::wake_at(std::int64_t time_ns, void (InverseLink::*then)()) {
  const std::uint64_t alarm = ++alarm_;
  timer_.expires_at(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns)));
  timer_.async_wait([this, alarm, then](boost::system::error_code error) {
    if (!error && alarm == alarm_) (this->*then)();
  });
}

// Before open() has ended it is told there, afterwards as a trouble.
void InverseLink::refuse(const std::string& what, const std::string& remedy) {
  if (!std::exchange(waited_for_, false)) return fail(what, remedy);
  opened_.set_exception(std::make_exception_ptr(Error(label(), what, remedy)));
  io_.stop();
}

void InverseLink::fail(const std::string& cause, const std::string& remedy) {
  socket_->drop();
  if (phase_ == Phase::kEnding) return io_.stop();
  if (waited_for_) return refuse(cause, remedy);
  withhold();
  complain(cause + "; " + remedy);
  ++report_.reconnects;
  const std::int64_t pause_ns = phase_ == Phase::kConnecting ? kPauseNs : 0;
  wake_at(monotonic_ns() + pause_ns, &InverseLink::connect);
}

void InverseLink::begin_end() {
  if (phase_ != Phase::kExchanging) return io_.stop();
  phase_ = Phase::kEnding;
  end_ns_ = monotonic_ns() + kEndNs;
}

// Zero is the last that the service hears.
void InverseLink::end_turn(std::int64_t now_ns) {
  if (now_ns > end_ns_) return io_.stop();
  if (!said_zero_ && !socket_->writing()) {
    said_zero_ = true;
    send(encode_force(device_.id, Vector3::Zero(), key_), now_ns);
  } else if (said_zero_ && sent_ns_.empty() && !std::exchange(left_, true)) {
    socket_->leave([this] { io_.stop(); });
  }
  wait(kPeriodNs);
}

}  // namespace irdm::haply
