#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/bounded_queue.hpp"
#include "common/realtime/event_fd.hpp"
#include "common/realtime/triple_buffer.hpp"
#include "server/prepared_run.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

/// What a SceneLoader has done.
struct SceneLoaderStatus {
  std::uint64_t done = 0;               ///< requests carried out, with and without success
  std::string notice = {};              ///< what came of the last of them, for a person
  std::vector<std::string> names = {};  ///< of the scenes to choose from
};

/// Prepares scenes of a folder, and saves into it, while a run goes on: on a thread of its own
/// under normal scheduling. It outlives the runs; one thread at a time asks (the viewer's), one
/// takes what is prepared (the main thread).
class SceneLoader {
 public:
  /// Reads a scene and prepares its run. Throws Error.
  using Prepare = std::function<std::unique_ptr<PreparedRun>(const SceneSource&)>;

  /// @param folder none: there is nothing to choose
  SceneLoader(std::optional<std::filesystem::path> folder, Prepare prepare);
  SceneLoader(const SceneLoader&) = delete;
  SceneLoader& operator=(const SceneLoader&) = delete;
  ~SceneLoader();

  bool possible() const noexcept { return folder_.has_value(); }
  /// The name that a scene's file has in the list; empty: it is not in the folder.
  std::string name_of(const SceneSource& source) const;

  void start();
  /// Waits for a scene that is being read.
  void finish();

  /// Whether a scene or its models are being read, which cannot be interrupted. Any thread.
  bool loading() const noexcept { return loading_.load(); }

  // Whoever asks; nothing waits.
  bool busy();
  const SceneLoaderStatus& status();
  /// These do nothing while busy().
  void load(const std::string& name);
  void save(const SceneSource& source, const Settings& initial, const Settings& settings);
  /// Requests to save since the program began.
  std::size_t saves() const noexcept { return saves_; }

  /// Signalled when a scene is prepared.
  EventFd& ready() noexcept { return ready_; }
  /// That scene; null: there is none.
  std::unique_ptr<PreparedRun> take();

 private:
  struct Request {
    std::string name = {};  ///< to load; empty: to save the rest
    SceneSource source = {};
    Settings initial = {};
    Settings settings = {};
  };
  bool ask(const Request& request);
  void run();
  void handle(const Request& request);
  std::string load_now(const std::string& name);
  std::string save_now(const Request& request);

  std::optional<std::filesystem::path> folder_;
  Prepare prepare_;
  BoundedQueue<Request> requests_{2};
  EventFd asked_;
  EventFd ready_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> loading_{false};
  TripleBuffer<SceneLoaderStatus> status_;
  std::uint64_t asked_count_ = 0;     ///< of whoever asks
  std::size_t saves_ = 0;             ///< of whoever asks
  SceneLoaderStatus now_;             ///< of the loader's thread
  std::atomic<bool> waiting_{false};  ///< a prepared scene waits to be taken
  std::mutex prepared_mutex_;
  std::unique_ptr<PreparedRun> prepared_;
  std::thread thread_;
};

}  // namespace irdm
