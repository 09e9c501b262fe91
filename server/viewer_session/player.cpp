#include "server/viewer_session/player.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"

namespace irdm {

Player::Player(const SimulationConfig& config, std::vector<std::string> names, double rate,
               int threads)
    : config_(config),
      names_(std::move(names)),
      dt_(config.objects.front().model->dt),
      period_ms_(std::max(1, static_cast<int>(std::lround(1000.0 / rate)))),
      threads_(threads),
      surfaces_(rest_frame(config)) {}

Player::~Player() {
  finish();
}

void Player::start() {
  thread_ = std::thread([this] { run(); });
}

void Player::finish() {
  if (!thread_.joinable()) return;
  stopping_.store(true);
  asked_.signal();
  thread_.join();
}

void Player::load(const std::filesystem::path& path) {
  ask({Request::Kind::kLoad, 0.0, path});
}
void Player::play() {
  ask({Request::Kind::kPlay});
}
void Player::pause() {
  ask({Request::Kind::kPause});
}
void Player::seek(double time) {
  ask({Request::Kind::kSeek, time});
}
void Player::set_speed(double speed) {
  ask({Request::Kind::kSpeed, speed});
}

// Hundreds of requests that wait are a page gone wild: the rest of them is lost.
void Player::ask(const Request& request) {
  requests_.push(request);
  asked_.signal();
}

void Player::run() {
  constexpr int kIdleMs = 1000;
  omp_set_num_threads(threads_);
  std::int64_t last_ns = monotonic_ns();
  while (!stopping_.load()) {
    const bool asked = asked_.wait(now_.playing ? period_ms_ : kIdleMs);
    const std::int64_t now_ns = monotonic_ns();
    const double passed = kNanosecond * static_cast<double>(now_ns - last_ns);
    last_ns = now_ns;
    const bool moved = now_.playing;
    if (moved) move(passed * now_.speed);
    Request request;
    while (requests_.pop(request)) handle(request);
    if (recording_ && (moved || asked)) show();
    if (moved || asked) status_.put(now_);
  }
}

void Player::handle(const Request& request) {
  switch (request.kind) {
    case Request::Kind::kLoad:
      return load_now(request.path);
    case Request::Kind::kPlay:
      // From the end it begins anew.
      if (time_ >= now_.length) time_ = 0.0;
      now_.playing = recording_.has_value();
      return;
    case Request::Kind::kPause:
      now_.playing = false;
      return;
    case Request::Kind::kSeek:
      time_ = std::clamp(request.value, 0.0, now_.length);
      return;
    case Request::Kind::kSpeed:
      now_.speed = request.value;
  }
}

void Player::load_now(const std::filesystem::path& path) {
  ++now_.loads;
  now_.error.clear();
  recording_.reset();
  try {
    recording_.emplace(path, config_, names_);
  } catch (const std::exception& error) {
    now_.error = error.what();
  }
  deformation_.reset();
  time_ = 0.0;
  now_.length = recording_ ? static_cast<double>(recording_->steps()) * dt_ : 0.0;
  now_.playing = recording_.has_value();
}

void Player::move(double seconds) {
  time_ += seconds;
  if (time_ < now_.length) return;
  time_ = now_.length;
  now_.playing = false;
}

void Player::show() {
  const auto step = static_cast<std::size_t>(std::max(0.0, std::ceil(time_ / dt_ - 1e-6) - 1.0));
  follow_to(std::min(step, recording_->steps() - 1));
  deformation_->compute(surfaces_.back());
  surfaces_.publish();
  surface_ready_.signal();
}

// Back in time is from the beginning again.
void Player::follow_to(std::size_t step) {
  if (!deformation_ || step + 1 < next_step_) {
    deformation_.emplace(config_);
    next_step_ = 0;
  }
  for (; next_step_ <= step && !stopping_.load(); ++next_step_) {
    recording_->step(next_step_, record_);
    deformation_->follow(record_);
  }
}

}  // namespace irdm
