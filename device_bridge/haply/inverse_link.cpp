#include "device_bridge/haply/inverse_link.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/haply/http_request.hpp"

namespace irdm::haply {
namespace {

constexpr std::int64_t kPeriodNs = 500'000;             // from one message to the next
constexpr std::int64_t kAbsentPeriodNs = 100'000'000;   // while the device is not there
constexpr std::int64_t kSilenceNs = 1'000'000'000;      // then the connection is made anew
constexpr std::int64_t kPauseNs = 250'000'000;          // before it is tried a second time
constexpr std::int64_t kEventsPauseNs = 1'000'000'000;  // before events are listened to again
constexpr std::int64_t kConnectNs = 4'000'000'000;      // until the first message
constexpr std::int64_t kEndNs = 300'000'000;            // for the last answer and the goodbye

constexpr const char* kStart =
    "start the Inverse Service (systemctl start haply-inverse-service), or correct `service`";

}  // namespace

InverseLink::InverseLink(InverseSettings settings, InverseMailbox& mailbox)
    : settings_(std::move(settings)),
      trouble_(label_of(settings_.device)),
      exchange_(mailbox, trouble_, report_) {}

void InverseLink::open() {
  constexpr std::chrono::seconds kPatience(10);
  waiting_.emplace();
  std::future<void> opened = waiting_->get_future();
  connect();
  thread_ = std::thread([this] { run(); });
  try {
    apply_scheduling(settings_.scheduling, thread_, kNetworkPriority);
    if (opened.wait_for(kPatience) != std::future_status::ready) {
      throw Error(label_of(settings_.device),
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
  boost::asio::post(io_, [this] {
    if (phase_ != Phase::kExchanging && phase_ != Phase::kAbsent) return io_.stop();
    phase_ = Phase::kEnding;
    ending_.deadline_ns = monotonic_ns() + kEndNs;
  });
  thread_.join();
}

void InverseLink::connect() {
  phase_ = Phase::kConnecting;
  exchange_.connect();
  const std::string service = "the service at " + host_text(settings_.service);
  socket_ = std::make_shared<ServiceSocket>(
      io_, settings_.service,
      ServiceSocket::Listener{.message = [this](const std::string& text) { take(text); },
                              .lost =
                                  [this, service](const std::string& cause) {
                                    fail("no connection to " + service + ": " + cause, kStart);
                                  }});
  socket_->open();
  alarm_.set(monotonic_ns() + kConnectNs,
             [this, service] { fail(service + " says nothing", kStart); });
}

// Of the events nothing depends alone: without them the states tell, if later.
void InverseLink::listen_to_events() {
  events_alarm_.cancel();
  if (events_ != nullptr) events_->drop();
  events_.reset();
  if (opened_->key != ForceKey::kVector) return;
  ServerAddress address = settings_.service;
  address.port = settings_.events_port;
  events_ = std::make_shared<ServiceSocket>(
      io_, address,
      ServiceSocket::Listener{.message = [this](const std::string& text) { take_event(text); },
                              .lost =
                                  [this](const std::string&) {
                                    events_alarm_.set(monotonic_ns() + kEventsPauseNs,
                                                      [this] { listen_to_events(); });
                                  }});
  events_->open();
}

// Each message but the first answers one of ours, whatever is in it.
void InverseLink::take(const std::string& text) {
  if (phase_ != Phase::kConnecting) exchange_.answered(monotonic_ns());
  ServiceMessage message;
  try {
    message = decode(text);
  } catch (const MessageError& error) {
    ++report_.bad_messages;
    const std::string what =
        std::string("the service's message is not understood: ") + error.what();
    const char* const remedy = "use an Inverse Service 3.x, or correct `service`";
    if (phase_ == Phase::kConnecting) return fail(what, remedy);
    return trouble_.tell(what + "; " + remedy);
  }
  if (phase_ == Phase::kConnecting) return take_inventory(message);
  if (phase_ != Phase::kEnding) take_update(message);
}

// The first connection sets the device up and waits for the service's HTTP. On a later one it is
// known: it hears zero at once.
void InverseLink::take_inventory(const ServiceMessage& inventory) {
  if (!opened_) {
    try {
      opened_.emplace(open_device(inventory, settings_, socket_->peer()));
    } catch (const Error&) {
      return refuse(std::current_exception());
    }
    trouble_.rename(label_of(opened_->device.id));
    return begin_exchange(opened_->device);
  }
  const InverseDevice* const device = find_by_id(inventory.devices, opened_->device.id);
  if (device == nullptr) return be_absent("is not there; check power and cable");
  if (!device->gravity_compensation.value_or(true)) {
    turn_gravity_on(device->id, opened_->key, settings_, socket_->peer());
  }
  begin_exchange(*device);
}

void InverseLink::begin_exchange(const InverseDevice& device) {
  phase_ = Phase::kExchanging;
  listen_to_events();
  const std::int64_t now_ns = monotonic_ns();
  last_good_ns_ = next_turn_ns_ = now_ns;
  send(exchange_.begin({device.id, settings_.grip, opened_->key}, device.status), now_ns);
  wait(kPeriodNs);
}

void InverseLink::be_absent(const std::string& what) {
  exchange_.withhold();
  phase_ = Phase::kAbsent;
  trouble_.tell(what);
  last_good_ns_ = next_turn_ns_ = monotonic_ns();
  wait(kPeriodNs);
}

void InverseLink::take_update(const ServiceMessage& update) {
  const InverseDevice* const device = find_by_id(update.devices, opened_->device.id);
  if (phase_ == Phase::kAbsent) {
    last_good_ns_ = monotonic_ns();
    if (device == nullptr) return;
    socket_->drop();
    return connect();  // for a first message, with its configuration
  }
  if (device == nullptr) return be_absent("is unplugged, no force; check power and cable");
  if (!device->tip) {
    ++report_.bad_messages;
    return trouble_.tell("the service tells no position, no force; update it");
  }
  last_good_ns_ = monotonic_ns();
  exchange_.take(*device, update.grips, last_good_ns_);
  if (waiting_) waiting_->set_value();
  waiting_.reset();
}

void InverseLink::take_event(const std::string& text) {
  const std::optional<InverseEvent> event = decode_event(text);
  if (!event || !opened_) return;
  if (event->meaning == EventMeaning::kNotice) {
    spdlog::warn("{}: the service says: {}", trouble_.label(), event->text);
  }
  if (event->device != opened_->device.id || phase_ != Phase::kExchanging) return;
  if (event->meaning == EventMeaning::kLost) {
    // The service may still have it.
    if (!socket_->writing()) send(exchange_.last(), monotonic_ns());
    be_absent("is lost, no force; check power and cable");
  } else if (event->meaning != EventMeaning::kNotice) {
    exchange_.lock(event->meaning == EventMeaning::kLocked);
  }
}

void InverseLink::turn() {
  const std::int64_t now_ns = monotonic_ns();
  if (phase_ == Phase::kEnding) return end_turn(now_ns);
  if (now_ns - last_good_ns_ > kSilenceNs) {
    return fail("no state from the service for a second", kStart);
  }
  if (phase_ == Phase::kAbsent) {
    if (exchange_.all_answered() && !socket_->writing()) send(encode_full_state(), now_ns);
    return wait(kAbsentPeriodNs);
  }
  if (!socket_->writing()) {
    if (auto message = exchange_.next(now_ns)) send(std::move(*message), now_ns);
  }
  wait(kPeriodNs);
}

void InverseLink::send(std::string text, std::int64_t now_ns) {
  exchange_.sent(now_ns);
  socket_->write(std::move(text));
}

void InverseLink::wait(std::int64_t period_ns) {
  next_turn_ns_ = std::max(next_turn_ns_ + period_ns, monotonic_ns());
  alarm_.set(next_turn_ns_, [this] { turn(); });
}

// Before open() has ended it is told there, afterwards as a trouble.
void InverseLink::refuse(const std::exception_ptr& error) {
  waiting_->set_exception(error);
  waiting_.reset();
  io_.stop();
}

void InverseLink::fail(const std::string& cause, const std::string& remedy) {
  socket_->drop();
  if (phase_ == Phase::kEnding) return io_.stop();
  if (waiting_) {
    return refuse(std::make_exception_ptr(Error(trouble_.label(), cause, remedy)));
  }
  exchange_.withhold();
  trouble_.tell(cause + "; " + remedy);
  ++report_.reconnects;
  const std::int64_t pause_ns = phase_ == Phase::kConnecting ? kPauseNs : 0;
  alarm_.set(monotonic_ns() + pause_ns, [this] { connect(); });
}

// Zero is the last that the service hears.
void InverseLink::end_turn(std::int64_t now_ns) {
  if (now_ns > ending_.deadline_ns) return io_.stop();
  if (!ending_.said_zero && !socket_->writing()) {
    ending_.said_zero = true;
    send(exchange_.last(), now_ns);
  } else if (ending_.said_zero && exchange_.all_answered() && !std::exchange(ending_.left, true)) {
    socket_->leave([this] { io_.stop(); });
  }
  wait(kPeriodNs);
}

}  // namespace irdm::haply
