#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/bounded_queue.hpp"
#include "common/realtime/event_fd.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "simulation/deformation/deformation.hpp"
#include "trace/recording.hpp"

namespace irdm {

/// How playing goes.
struct PlayerStatus {
  std::uint64_t loads = 0;  ///< recordings that were asked for so far, with and without success
  std::string error = {};   ///< why the last of them cannot be shown; empty: it can
  double length = 0.0;      ///< of what is loaded [s]; 0: nothing
  double speed = 1.0;
  bool playing = false;
};

/// Shows recorded runs: computes every surface again from the forces of the trace, as the
/// deformation thread does from those of a live run. A thread of its own under normal scheduling;
/// the requests are made by one other thread and wait for nothing.
/// Large: the state of a playback and the hand-over of each request, between two threads.
class Player {
 public:
  /// @param names of the objects
  Player(const SimulationConfig& config, std::vector<std::string> names, double rate, int threads);
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;
  ~Player();

  void start();
  void finish();

  /// Reads a recording and plays it from its beginning.
  void load(const std::filesystem::path& path);
  void play();
  void pause();
  void seek(double time);        ///< [s]
  void set_speed(double speed);  ///< > 0, 1: as it was

  /// The newest surface, for one reader, and a signal whenever there is one.
  TripleBuffer<SurfaceFrame>& surfaces() noexcept { return surfaces_; }
  EventFd& surface_ready() noexcept { return surface_ready_; }
  /// For one reader.
  TripleBuffer<PlayerStatus>& status() noexcept { return status_; }

 private:
  struct Request {
    enum class Kind { kLoad, kPlay, kPause, kSeek, kSpeed } kind = Kind::kPlay;
    double value = 0.0;
    std::filesystem::path path = {};
  };
  void ask(const Request& request);
  void run();
  void handle(const Request& request);
  void load_now(const std::filesystem::path& path);
  void move(double seconds);
  void show();
  void follow_to(std::size_t step);

  SimulationConfig config_;
  std::vector<std::string> names_;
  double dt_;
  int period_ms_;
  int threads_;
  BoundedQueue<Request> requests_{256};
  EventFd asked_;
  std::atomic<bool> stopping_{false};
  TripleBuffer<SurfaceFrame> surfaces_;
  EventFd surface_ready_;
  TripleBuffer<PlayerStatus> status_;

  // Player's thread.
  std::optional<Recording> recording_;
  std::optional<Deformation> deformation_;
  std::size_t next_step_ = 0;  ///< of the recording, that the deformation has not followed
  double time_ = 0.0;          ///< [s]
  PlayerStatus now_;
  StepRecord record_;
  std::thread thread_;
};

}  // namespace irdm
