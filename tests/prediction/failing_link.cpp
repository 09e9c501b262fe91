#include "tests/prediction/failing_link.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "common/wire/protocol_error.hpp"
#include "tests/support/fem_cube.hpp"

namespace irdm::test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kWay = kMillisecond;
constexpr std::int64_t kSilence = 100 * kMillisecond;  // ClientSettings' and ServerSettings'
constexpr std::int64_t kHeldBack = 300 * kMillisecond;
constexpr std::int64_t kSlow = 40 * kMillisecond;
constexpr std::int64_t kStopped = 150 * kMillisecond;
constexpr std::int64_t kJump = 1'000 * kMillisecond;
constexpr std::int64_t kWatched = 450 * kMillisecond;
constexpr int kTicksPerStep = 2;
constexpr std::uint32_t kLinkSession = 77;
constexpr double kTop = 0.06;

SimulationConfig tethered_cube() {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({.cells = 2, .youngs_modulus = 2e4});
  config.objects[0].friction = {0.6, 0.5};
  config.objects[0].tether = {500.0, 5.0};
  config.objects[0].damping = {20.0, 20.0};
  config.styluses = {{0.0, 2000.0, 0.0}};
  return config;
}

}  // namespace

std::string word(Cause cause) {
  constexpr std::array<const char*, kCauses> kWords{
      "server killed", "server stopped", "cable cut",      "silent server",
      "silent bridge", "corrupted",      "reordered",      "old frames",
      "slow reader",   "second master",  "forged",         "repeated",
      "clock ahead",   "clock back",     "bridge stopped", "blind device"};
  return kWords.at(static_cast<std::size_t>(cause));
}

/// Comes down onto the cube's top and stays there.
class FailingLink::Device : public HapticDevice {
 public:
  void open() override {}
  void close() noexcept override {}
  StylusPose read(double) noexcept override {
    if (blind) return {.tip = Vector3::Constant(std::numeric_limits<double>::quiet_NaN())};
    height = std::max(height - 5e-5, kTop - depth);
    return {.tip = Vector3(0.01, height, 0.005)};
  }
  void write(const Wrench& given) noexcept override { force = given.force.norm(); }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return 1e9; }

  double depth = 0.006;
  double height = kTop + 0.002;
  double force = 0.0;
  bool blind = false;
};

FailingLink::FailingLink(Cause cause, bool predict, std::uint64_t seed)
    : cause_(cause),
      predict_(predict),
      random_(seed),
      device_(std::make_unique<Device>()),
      loop_(*device_, {.needed_success = 0.9}),
      simulation_(tethered_cube()),
      bridged_(simulation_, 0) {
  loop_.restart(true);
  if (predict_) loop_.predict(simulation_.dt(), kMillisecond);
  answered_ns_ = now_ns_;
  device_->depth = 0.004 + 0.004 * static_cast<double>(random_() % 1000) / 1000.0;
}

FailingLink::~FailingLink() = default;

std::int64_t FailingLink::bridge_clock() const {
  if (wrong(Cause::kClockForward)) return now_ns_ + kJump;
  if (wrong(Cause::kClockBackward)) return now_ns_ - kJump;
  return now_ns_;
}

FailingLink::Outcome FailingLink::run() {
  constexpr int kLongestStart = 3000;
  Outcome outcome;
  for (int i = 0; i < kLongestStart && device_->force < 0.3; ++i) tick();
  for (std::uint64_t i = random_() % 200; i > 0; --i) tick();
  outcome.force_before = device_->force;
  outcome.horizon_ns = horizon_ns_;
  const std::int64_t since_ns = now_ns_;
  wrong_since_ns_ = since_ns;
  if (cause_ == Cause::kBridgeStopped) now_ns_ += outcome.absent_ns = kStopped;
  double before = device_->force;
  std::int64_t settled_ns = 0;
  while (now_ns_ - since_ns < kWatched) {
    tick();
    outcome.largest_rise = std::max(outcome.largest_rise, device_->force - before);
    before = device_->force;
    if (outcome.zero_ns < 0) {
      outcome.valid_ns = valid_ns_ - since_ns;
      if (device_->force == 0.0) settled_ns = outcome.zero_ns = now_ns_ - since_ns;
    } else if (now_ns_ - since_ns < settled_ns + 100 * kMillisecond) {
      outcome.force_after = std::max(outcome.force_after, device_->force);
    }
  }
  return outcome;
}

void FailingLink::tick() {
  now_ns_ += kMillisecond;
  deliver_down();
  bridge();
  const bool step_due = now_ns_ / kMillisecond % kTicksPerStep == 0;
  if (step_due && !wrong(Cause::kServerStopped) && !wrong(Cause::kServerKilled)) serve();
}

void FailingLink::bridge() {
  if (wrong(Cause::kServerKilled)) linked_ = false;
  if (linked_ && now_ns_ - answered_ns_ > kSilence) linked_ = false;
  if (!linked_) intake_.end();
  device_->blind = wrong(Cause::kBlindDevice);
  loop_.read(0.0);
  const StylusSample sample = loop_.take_sample(bridge_clock());
  intake_.sent(sample);
  samples_.emplace_back(now_ns_ + kWay, sample);
  loop_.end_steps(bridge_clock());
  loop_.apply(bridge_clock(), intake_.input());
  if (const AppliedForces* applied = loop_.applied()) {
    applied_.emplace_back(now_ns_ + kWay, *applied);
  }
}

// Bytes come in order, as on any stream.
void FailingLink::deliver_down() {
  if (wrong(Cause::kCableCut) || wrong(Cause::kSilentServer)) return;
  if (wrong(Cause::kOldFrames) && now_ns_ < *wrong_since_ns_ + kHeldBack) return;
  while (linked_ && !down_.empty() && down_.front().time_ns <= now_ns_) {
    if (wrong(Cause::kSlowReader)) {
      if (now_ns_ < next_slow_ns_) return;
      next_slow_ns_ = now_ns_ + kSlow;
    }
    if (wrong(Cause::kReordered)) {
      if (!down_.front().overtaken) {
        if (down_.size() < 2) return;
        std::swap(down_[0], down_[1]);
        down_[1].overtaken = true;
        down_[1].time_ns = now_ns_;
      }
    }
    wire::FrameBytes bytes = down_.front().bytes;
    if (!wrong(Cause::kRepeated)) down_.pop_front();
    if (wrong(Cause::kCorrupted)) bytes.storage[random_() % bytes.size] ^= 1 << random_() % 8;
    std::span<const std::uint8_t> rest = bytes.view();
    try {
      while (const std::optional<wire::Frame> frame = reader_.read(rest)) take(*frame);
    } catch (const wire::ProtocolError&) {
      linked_ = false;
    }
    if (wrong(Cause::kRepeated)) return;
  }
}

void FailingLink::take(const wire::Frame& frame) {
  if (frame.header.session != kLinkSession) {
    throw wire::ProtocolError(wire::ProtocolFault::kUnexpected, "another session");
  }
  // As wire::Connection does.
  if (last_frame_ && frame.header.sequence <= *last_frame_) {
    throw wire::ProtocolError(wire::ProtocolFault::kBackward, "an older frame");
  }
  last_frame_ = frame.header.sequence;
  bool good = false;
  if (const auto* force = std::get_if<wire::ForceMessage>(&frame.message)) {
    const auto before = intake_.answered();
    const bool news = intake_.take(force->force, bridge_clock(), report_);
    if (news && intake_.answered() > before) answered_ns_ = now_ns_;
    good = news && !predict_ && bridge_clock() - force->force.sample_time_ns < horizon_ns_;
  } else if (const auto* model = std::get_if<wire::ContactModelMessage>(&frame.message)) {
    good = check(model->model, {.dt = simulation_.dt()}) == ContactModelFault::kNone;
    if (!good) return;
    horizon_ns_ = static_cast<std::int64_t>(1e9 * model->model.dt * model->model.horizon);
    good = bridge_clock() - frame.header.send_time_ns < horizon_ns_;
    loop_.receive(model->model, bridge_clock());
  }
  if (good) valid_ns_ = now_ns_;
}

void FailingLink::serve() {
  const bool deaf = wrong(Cause::kCableCut) || wrong(Cause::kSilentBridge);
  while (!deaf && !samples_.empty() && samples_.front().first <= now_ns_) {
    newest_ = samples_.front().second;
    samples_.pop_front();
    heard_ns_ = now_ns_;
    command_ = {.present = true, .buttons = newest_.buttons, .tip = newest_.tip, .given = {}};
  }
  while (!deaf && !applied_.empty() && applied_.front().first <= now_ns_) {
    history_.take(applied_.front().second);
    applied_.pop_front();
  }
  if (now_ns_ - heard_ns_ > kSilence) command_.present = false;
  const std::array commands{bridged_.next(command_, predict_ ? 1 : 0, history_)};
  simulation_.step(commands, record_);
  if (!command_.present) return;
  StylusForce answer{.force_step = record_.force_step,
                     .sample_sequence = newest_.sequence,
                     .sample_time_ns = newest_.time_ns,
                     .contact = record_.stylus[0].contact,
                     .force = record_.stylus[0].force,
                     .proxy = record_.stylus[0].proxy};
  if (wrong(Cause::kForged)) answer.sample_sequence += 1'000'000;
  const std::uint32_t session = wrong(Cause::kSecondMaster) ? kLinkSession + 1 : kLinkSession;
  send_down(wire::ForceMessage{0, answer}, session);
  if (!predict_) return;
  bridged_.predict_horizon(model_);
  send_down(wire::ContactModelMessage{0, model_}, session);
}

void FailingLink::send_down(const wire::Message& message, std::uint32_t session) {
  down_.push_back(
      {now_ns_ + kWay, wire::encode_frame(message, session, frames_++, now_ns_), false});
}

}  // namespace irdm::test
