#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/hdf5/file.hpp"
#include "common/realtime/bounded_queue.hpp"
#include "common/realtime/event_fd.hpp"

namespace irdm {

/// Something that a black box is written for.
struct Fault {
  std::int64_t time_ns = 0;  ///< monotonic_ns()
  std::string kind = {};     ///< a few words, the same for all of a kind
  std::string detail = {};   ///< which, if there is more to say
};

/// One kind of thing that a black box keeps. Black box's thread only.
class BlackBoxPart {
 public:
  static constexpr std::int64_t kKeptNs = 2'000'000'000;

  BlackBoxPart() = default;
  BlackBoxPart(const BlackBoxPart&) = delete;
  BlackBoxPart& operator=(const BlackBoxPart&) = delete;
  virtual ~BlackBoxPart() = default;

  /// Takes what has come since the last call. The first fault in it.
  virtual std::optional<Fault> take() = 0;
  /// Keeps the last kKeptNs before that time, and before the newest that it has where that is
  /// older.
  virtual void forget(std::int64_t now_ns) = 0;
  /// Writes all that it has, times from `origin_ns` on. Throws Error.
  virtual void write(hdf5::File& file, std::int64_t origin_ns) const = 0;
};

/// Where a program leaves its black boxes.
struct BlackBoxSettings {
  std::filesystem::path folder = "blackbox";  ///< made when needed; empty: none are written
  int files = 16;                             ///< of this program in the folder at most, >= 1
};

/// Keeps the last two seconds of what its parts are told, on an ordinary thread of its own, and
/// writes them to a file when one of them sees a fault (HDF5, format "irdm-blackbox",
/// docs/files.md). A tenth of a second passes in between, so that what came of the fault is there
/// too. Of each kind of fault there is at most one file in ten seconds. A file that cannot be
/// written is a line of the log and nothing else.
class BlackBox {
 public:
  static constexpr std::int64_t kAftermathNs = 100'000'000;
  static constexpr std::int64_t kRestNs = 10'000'000'000;  ///< between files of a kind of fault

  /// @param program its name, which the files' names begin with
  /// @param parts outlive this object
  BlackBox(BlackBoxSettings settings, std::string program, std::vector<BlackBoxPart*> parts);
  BlackBox(const BlackBox&) = delete;
  BlackBox& operator=(const BlackBox&) = delete;
  ~BlackBox();  ///< finishes

  void start();
  /// A fault that no part can see. One thread, which may allocate memory.
  void report(const std::string& kind, const std::string& detail);
  /// Writes what is due, and ends the thread. When nobody tells the parts anything any more.
  void finish();

 private:
  void run();
  void look(std::int64_t now_ns);
  void begin(const Fault& fault);
  void write_due(std::int64_t now_ns, bool last);
  void write(const Fault& fault) noexcept;

  BlackBoxSettings settings_;
  std::string program_;
  std::vector<BlackBoxPart*> parts_;
  std::optional<Fault> due_;                     ///< that is to be written soon
  std::map<std::string, std::int64_t> written_;  ///< when, by kind
  BoundedQueue<Fault> reported_{8};
  EventFd stop_;
  std::thread thread_;
};

}  // namespace irdm
