#pragma once

#include <chrono>
#include <condition_variable>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>

namespace irdm::precompute {

/// Where a person sees how the work goes on: a bar that is drawn anew on a terminal, plain lines
/// elsewhere.
struct Console {
  std::ostream& out;
  bool terminal;

  /// One plain line.
  void line(const std::string& text) const;
};

/// "0.8 s", "12 s", "3 min 05 s", "2 h 10 min".
std::string format_duration(double seconds);

/// "title  37 %  [#######.............]  12 s left"
/// @param fraction of the work that is done, 0..1
/// @param elapsed_s seconds since its beginning
std::string progress_text(const std::string& title, double fraction, double elapsed_s, bool bar);

/// "title  12 s, about 14 s left"; without the estimate once that is over.
/// @param expected_s of the whole work
std::string elapsed_text(const std::string& title, double elapsed_s, double expected_s);

/// Says how long a piece of work takes whose share cannot be told, from a thread of its own: once a
/// second on a terminal, else twice as late each time from 10 s on. Ends with this object.
class ElapsedTime {
 public:
  /// @param expected_s [s]
  ElapsedTime(const Console& console, std::string title, double expected_s);
  ElapsedTime(const ElapsedTime&) = delete;
  ElapsedTime& operator=(const ElapsedTime&) = delete;
  ~ElapsedTime();

 private:
  using Clock = std::chrono::steady_clock;
  void tell();

  Console console_;
  std::string title_;
  double expected_s_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  bool over_ = false;
  std::thread thread_;
};

/// Progress of one long piece of work in `total` equal parts.
class Progress {
 public:
  Progress(const Console& console, std::string title, int total);
  /// Says that `done` parts are complete; prints at most ten times a second on a terminal, else
  /// every 10 % or 5 s, whichever is longer apart.
  void update(int done);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_due(double fraction, Clock::time_point now) const;

  Console console_;
  std::string title_;
  int total_;
  Clock::time_point start_;
  Clock::time_point last_print_;
  double last_fraction_ = 0.0;
};

}  // namespace irdm::precompute
