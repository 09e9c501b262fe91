#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/blackbox/black_box_part.hpp"
#include "common/realtime/bounded_queue.hpp"
#include "common/realtime/event_fd.hpp"

namespace irdm {

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
