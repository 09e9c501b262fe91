#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/fake_libhd/fake_device.hpp"

namespace fake_hd {

struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};

using Callback = unsigned (*)(void*);

/// The state of the fake driver, and its scheduler. Every function of the interface takes `mutex`;
/// callbacks run without it. What a program does wrong is counted as misuse, the first in words.
class FakeDriver {
 public:
  static FakeDriver& instance();

  void reset();  ///< as if just loaded; the scheduler is stopped
  FakeDevice& known(const std::string& name);
  FakeDevice* find(const std::string& name);
  FakeDevice* of(unsigned handle);  ///< open; nullptr and an error otherwise
  FakeDevice* current_device() { return of(current); }
  unsigned handle_of(const FakeDevice& device) const;

  unsigned init(const char* name);
  void disable(unsigned handle);
  void begin_frame(unsigned handle);
  void end_frame(unsigned handle);
  void raise(unsigned code, unsigned handle);
  ErrorInfo pop_error();
  void misuse(const std::string& what);
  bool running() const { return running_; }

  void start();
  void stop();
  unsigned long schedule(Callback callback, void* data);
  void unschedule(unsigned long number);
  /// One tick of the scheduler on the calling thread.
  void tick();

  std::recursive_mutex mutex;
  unsigned current = 0xFFFFFFFF;
  unsigned refusal = 0;            ///< error of the next hdInitDevice
  bool refuses_names = false;      ///< any device but the default one
  bool refuses_rate = false;       ///< any rate but 1000
  bool hand_driven = false;        ///< ticks come from the test only
  std::atomic<bool> hangs{false};  ///< the scheduler calls nobody
  unsigned long rate = 1000;
  unsigned long ticks = 0;
  unsigned long misuses = 0;
  std::string first_misuse;
  std::string log_file;

 private:
  struct Scheduled {
    unsigned long number;
    Callback callback;
    void* data;
  };
  FakeDriver();
  ~FakeDriver();
  void read_environment();
  void run();
  void finish_tick();
  void happen(FakeDevice& device);
  void write_log(const FakeDevice& device);

  std::map<std::string, std::unique_ptr<FakeDevice>> devices_;
  std::vector<FakeDevice*> handles_;
  std::vector<ErrorInfo> errors_;
  std::vector<Scheduled> scheduled_;
  unsigned long next_number_ = 1;
  std::thread::id tick_thread_;
  std::thread thread_;
  std::atomic<bool> running_{false};
};

using Lock = std::lock_guard<std::recursive_mutex>;

inline FakeDriver& driver() {
  return FakeDriver::instance();
}

}  // namespace fake_hd
