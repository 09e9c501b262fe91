#include "tests/fake_libhd/fake_driver.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

namespace fake_hd {
namespace {

using Lock = std::lock_guard<std::recursive_mutex>;

constexpr unsigned kInvalidHandle = 0xFFFFFFFF;
constexpr unsigned kBadHandle = 0x0104;
constexpr unsigned kDeviceFault = 0x0300;
constexpr unsigned kAlreadyInitiated = 0x0301;
constexpr unsigned kCommError = 0x0302;
constexpr unsigned kIllegalBegin = 0x0400;
constexpr unsigned kIllegalEnd = 0x0401;
constexpr double kContact = 0.2;  // [N]
const char* const kDefaultName = "Default Device";

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::vector<MotionRow> read_motion(const std::string& path) {
  std::vector<MotionRow> rows;
  std::ifstream file(path);
  for (MotionRow row{};
       file >> row.tick >> row.position[0] >> row.position[1] >> row.position[2] >> row.buttons;) {
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

FakeDriver& FakeDriver::instance() {
  static FakeDriver driver;
  return driver;
}

FakeDriver::FakeDriver() {
  reset();
  read_environment();
}

FakeDriver::~FakeDriver() {
  stop();
}

void FakeDriver::reset() {
  stop();
  const Lock lock(mutex);
  devices_.clear();
  handles_.clear();
  errors_.clear();
  scheduled_.clear();
  current = kInvalidHandle;
  refusal = 0;
  refuses_names = false;
  refuses_rate = false;
  hand_driven = false;
  hangs = false;
  rate = 1000;
  ticks = 0;
  misuses = 0;
  first_misuse.clear();
  known(kDefaultName);
}

// For programs that are run beside a test: what the first device does, and what happens to it.
void FakeDriver::read_environment() {
  log_file = variable("FAKE_HD_LOG");
  std::istringstream names(variable("FAKE_HD_DEVICES"));
  for (std::string name; std::getline(names, name, ',');) known(name);
  if (const std::string code = variable("FAKE_HD_REFUSE"); !code.empty()) {
    refusal = static_cast<unsigned>(std::stoul(code, nullptr, 0));
  }
  for (const auto& [name, device] : devices_) {
    device->motion = read_motion(variable("FAKE_HD_MOTION"));
    if (const std::string torque = variable("FAKE_HD_TORQUE"); !torque.empty()) {
      device->max_torque = std::stod(torque);
      device->continuous_torque = 0.5 * device->max_torque;
    }
    device->event.what = variable("FAKE_HD_EVENT");
    if (!device->event.what.empty()) {
      device->event.every_frames = std::stoul(variable("FAKE_HD_EVENT_AFTER"));
      device->event.after_frames = device->event.every_frames;
    }
  }
}

FakeDevice& FakeDriver::known(const std::string& name) {
  std::unique_ptr<FakeDevice>& device = devices_[name];
  if (!device) {
    device = std::make_unique<FakeDevice>();
    device->name = name;
  }
  return *device;
}

FakeDevice* FakeDriver::find(const std::string& name) {
  const auto found = devices_.find(name.empty() ? kDefaultName : name);
  return found == devices_.end() ? nullptr : found->second.get();
}

FakeDevice* FakeDriver::of(unsigned handle) {
  if (handle < handles_.size() && handles_[handle]->open) return handles_[handle];
  raise(kBadHandle, handle);
  misuse("a handle of no open device");
  return nullptr;
}

unsigned FakeDriver::handle_of(const FakeDevice& device) const {
  for (unsigned i = 0; i < handles_.size(); ++i) {
    if (handles_[i] == &device) return i;
  }
  return kInvalidHandle;
}

unsigned FakeDriver::init(const char* name) {
  if (running_) misuse("a device is opened while the scheduler runs");
  FakeDevice* const device = find(name != nullptr ? name : "");
  unsigned error = device == nullptr ? kDeviceFault : 0;
  if (device != nullptr && refuses_names && device->name != kDefaultName) error = kDeviceFault;
  if (device != nullptr && device->open) error = kAlreadyInitiated;
  if (device != nullptr && !device->plugged) error = kCommError;
  if (refusal != 0) error = refusal;
  if (error != 0) {
    raise(error, kInvalidHandle);
    return kInvalidHandle;
  }
  device->open = true;
  handles_.push_back(device);
  current = static_cast<unsigned>(handles_.size() - 1);
  return current;
}

void FakeDriver::disable(unsigned handle) {
  FakeDevice* const device = of(handle);
  if (device == nullptr) return;
  if (running_) misuse("a device is closed while the scheduler runs");
  if (device->force_output) misuse("a device is closed with its force on");
  device->open = false;
  write_log(*device);
}

void FakeDriver::begin_frame(unsigned handle) {
  FakeDevice* const device = of(handle);
  if (device == nullptr) return;
  current = handle;
  if (std::this_thread::get_id() != tick_thread_) misuse("a frame outside the scheduler's tick");
  if (device->in_frame) {
    raise(kIllegalBegin, handle);
    return misuse("a frame in a frame");
  }
  device->in_frame = true;
  if (++device->frames_this_tick > 1) misuse("two frames of a device in a tick");
  for (const unsigned code : device->at_begin) raise(code, handle);
  const bool failed = !device->at_begin.empty() || !device->plugged;
  device->at_begin.clear();
  if (device->plugged) {
    device->move_to(ticks);
  } else {
    raise(kCommError, handle);
  }
  device->commanded = {};
  device->commanded_torque = {};
  const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
  device->log.push_back({ticks, device->position(), {}, {}, failed, now.count()});
}

void FakeDriver::end_frame(unsigned handle) {
  FakeDevice* const device = of(handle);
  if (device == nullptr) return;
  if (!device->in_frame) {
    raise(kIllegalEnd, handle);
    return misuse("the end of no frame");
  }
  device->in_frame = false;
  ++device->frames;
  for (const unsigned code : device->show()) raise(code, handle);
  for (const unsigned code : device->at_end) raise(code, handle);
  device->at_end.clear();
  device->log.back().force = device->commanded;
  device->log.back().torque = device->commanded_torque;
  if (magnitude(device->commanded) > kContact) ++device->contact_frames;
  if (device->event.after_frames > 0 && device->contact_frames >= device->event.after_frames) {
    happen(*device);
  }
}

void FakeDriver::happen(FakeDevice& device) {
  ContactEvent& event = device.event;
  const std::size_t end = std::min(event.what.find(','), event.what.size());
  const std::string what = event.what.substr(0, end);
  event.what.erase(0, end + 1);
  event.after_frames = event.what.empty() ? 0 : device.contact_frames + event.every_frames;
  if (what == "unplug") {
    device.plugged = false;
  } else if (what == "hang") {
    hangs = true;
  } else if (what == "tell") {
    std::puts("fake device: in contact");
    std::fflush(stdout);
  } else {
    device.at_begin.push_back(static_cast<unsigned>(std::stoul(what, nullptr, 0)));
  }
}

void FakeDriver::raise(unsigned code, unsigned handle) {
  errors_.push_back({code, code == kCommError ? 5 : 0, handle});
}

ErrorInfo FakeDriver::pop_error() {
  if (errors_.empty()) return {};
  const ErrorInfo newest = errors_.back();
  errors_.pop_back();
  return newest;
}

void FakeDriver::misuse(const std::string& what) {
  if (misuses++ == 0) first_misuse = what;
}

unsigned long FakeDriver::schedule(Callback callback, void* data) {
  scheduled_.push_back({next_number_, callback, data});
  return next_number_++;
}

void FakeDriver::unschedule(unsigned long number) {
  std::erase_if(scheduled_, [number](const Scheduled& entry) { return entry.number == number; });
}

void FakeDriver::start() {
  if (running_) return misuse("the scheduler is started twice");
  running_ = true;
  if (!hand_driven) thread_ = std::thread([this] { run(); });
}

void FakeDriver::stop() {
  running_ = false;
  if (thread_.joinable()) thread_.join();
}

void FakeDriver::run() {
  auto next = std::chrono::steady_clock::now();
  while (running_) {
    next += std::chrono::microseconds(1'000'000 / rate);
    std::this_thread::sleep_until(next);
    if (!hangs) tick();
  }
}

void FakeDriver::tick() {
  std::vector<Scheduled> calls;
  {
    const Lock lock(mutex);
    if (!running_) return;
    ++ticks;
    tick_thread_ = std::this_thread::get_id();
    calls = scheduled_;
  }
  for (const Scheduled& entry : calls) {
    if (entry.callback(entry.data) == 1) continue;
    const Lock lock(mutex);
    unschedule(entry.number);
  }
  finish_tick();
}

void FakeDriver::finish_tick() {
  const Lock lock(mutex);
  tick_thread_ = {};
  for (FakeDevice* device : handles_) {
    if (!device->open) continue;
    if (device->in_frame) misuse("a frame is not ended in its tick");
    device->frames_this_tick = 0;
  }
}

void FakeDriver::write_log(const FakeDevice& device) {
  if (log_file.empty()) return;
  std::ofstream file(log_file, std::ios::app);
  file.precision(std::numeric_limits<double>::max_digits10);
  for (const FrameRecord& frame : device.log) {
    file << frame.tick << ' ' << frame.failed;
    for (const double value : frame.position) file << ' ' << value;
    for (const double value : frame.force) file << ' ' << value;
    for (const double value : frame.torque) file << ' ' << value;
    file << ' ' << frame.begun_ns << '\n';
  }
  file << "misuses " << misuses << ' ' << first_misuse << '\n';
}

}  // namespace fake_hd
