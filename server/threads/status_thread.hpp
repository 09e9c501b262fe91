#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "common/realtime/event_fd.hpp"
#include "common/wire/message.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"

namespace irdm {

/// Tells once a second, to the bridges, how a run in real time goes, and now and then to the log.
class StatusThread {
 public:
  /// The threads of the run; they must outlive this object.
  struct Parts {
    ForceThread& force;
    NetworkServer& network;
    const DeformationThread& deformation;
    const RecorderThread* recorder;  ///< null: not recorded
  };
  /// @param log_period of lines in the log, to the second [s]; 0: none
  StatusThread(const Parts& parts, double log_period);
  ~StatusThread();

  void start();
  void finish();

 private:
  void run();
  wire::Status gather();
  float surface_rate();
  void log_prediction_period();
  void log_withheld();
  void log_faults();

  Parts parts_;
  int prediction_period_ = 1;  ///< that was told last; and the next two
  std::uint64_t withheld_ = 0;
  std::array<StylusFaults, kMaxStyluses> faults_ = {};
  std::int64_t log_period_ns_;
  std::uint64_t frames_ = 0;  ///< and the next: at the last gathering
  std::int64_t gathered_ns_ = 0;
  EventFd stop_;
  std::thread thread_;
};

/// One line for log, report and page.
/// @param steps ForceThreadReport::withheld
std::string withheld_line(std::uint64_t steps);

/// Lines for log and report: what has grown.
/// @param s the stylus
std::vector<std::string> fault_lines(std::size_t s, const StylusFaults& before,
                                     const StylusFaults& now);

/// One line for the log.
/// @param cache_misses Simulation::cache_misses()
std::string status_line(const wire::Status& status, const NetworkStats& network,
                        std::uint64_t cache_misses);

}  // namespace irdm
