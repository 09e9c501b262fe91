#include "precompute/progress.hpp"

#include <cmath>
#include <cstdio>
#include <ostream>

namespace irdm::precompute {
namespace {

double seconds_between(std::chrono::steady_clock::time_point from,
                       std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

std::string bar_text(double fraction) {
  constexpr std::size_t kWidth = 30;
  const auto filled = static_cast<std::size_t>(std::lround(fraction * kWidth));
  return '[' + std::string(filled, '#') + std::string(kWidth - filled, '.') + ']';
}

}  // namespace

void Console::line(const std::string& text) const {
  out << text << std::endl;
}

std::string format_duration(double seconds) {
  char text[64];
  const auto whole = std::lround(seconds);
  if (seconds < 9.95) {
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  } else if (whole < 120) {
    std::snprintf(text, sizeof text, "%ld s", whole);
  } else if (whole < 7200) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
  }
  return text;
}

std::string progress_text(const std::string& title, double fraction, double elapsed_s, bool bar) {
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * fraction);
  std::string text = title + "  " + percent;
  if (bar) text += "  " + bar_text(fraction);
  if (fraction >= 1.0) return text + "  " + format_duration(elapsed_s);
  if (fraction > 0.0) {
    text += "  " + format_duration(elapsed_s * (1.0 - fraction) / fraction) + " left";
  }
  return text;
}

std::string elapsed_text(const std::string& title, double elapsed_s, double expected_s) {
  std::string text = title + "  " + format_duration(elapsed_s);
  if (elapsed_s < expected_s)
    text += ", about " + format_duration(expected_s - elapsed_s) + " left";
  return text;
}

ElapsedTime::ElapsedTime(const Console& console, std::string title, double expected_s)
    : console_(console),
      title_(std::move(title)),
      expected_s_(expected_s),
      thread_([this] { tell(); }) {}

ElapsedTime::~ElapsedTime() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
  const std::string text = title_ + "  " + format_duration(seconds_between(start_, Clock::now()));
  console_.line(console_.terminal ? '\r' + text + "\x1b[K" : text);
}

void ElapsedTime::tell() {
  constexpr auto kFirst = std::chrono::seconds(10);
  constexpr auto kOnTerminal = std::chrono::seconds(1);
  Clock::duration pause = console_.terminal ? kOnTerminal : kFirst;
  std::unique_lock<std::mutex> lock(mutex_);
  while (!changed_.wait_for(lock, pause, [this] { return over_; })) {
    const double elapsed_s = seconds_between(start_, Clock::now());
    const std::string text = elapsed_text(title_, elapsed_s, expected_s_);
    if (console_.terminal) {
      console_.out << '\r' << text << "\x1b[K" << std::flush;
    } else {
      console_.line(text);
      pause = Clock::now() - start_;
    }
  }
}

Progress::Progress(const Console& console, std::string title, int total)
    : console_(console),
      title_(std::move(title)),
      total_(total),
      start_(Clock::now()),
      last_print_(start_) {}

bool Progress::is_due(double fraction, Clock::time_point now) const {
  if (fraction >= 1.0) return true;
  const double pause = seconds_between(last_print_, now);
  if (console_.terminal) return pause >= 0.1;
  return pause >= 5.0 && fraction - last_fraction_ >= 0.1;
}

void Progress::update(int done) {
  const double fraction = static_cast<double>(done) / total_;
  const Clock::time_point now = Clock::now();
  if (!is_due(fraction, now)) return;
  const std::string text =
      progress_text(title_, fraction, seconds_between(start_, now), console_.terminal);
  if (console_.terminal) {
    console_.out << '\r' << text << "\x1b[K" << (done == total_ ? "\n" : "") << std::flush;
  } else {
    console_.line(text);
  }
  last_print_ = now;
  last_fraction_ = fraction;
}

}  // namespace irdm::precompute
