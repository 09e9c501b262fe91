#include "device_bridge/openhaptics/hd_library.hpp"

#include <dlfcn.h>

#include <cstdlib>

#include "common/error.hpp"

namespace irdm::hd {
namespace {

const char* const kWhere = "OpenHaptics";

/// One library that was looked for.
struct Attempt {
  void* library = nullptr;
  std::string failure;
};

Attempt attempt(const std::string& name) {
  ::dlerror();
  if (void* library = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return {library, ""};
  const char* const why = ::dlerror();
  return {nullptr, why != nullptr ? why : "no reason given"};
}

template <typename Function>
void bind(void* library, const std::string& library_name, const char* name, Function& function) {
  void* const symbol = ::dlsym(library, name);
  if (symbol == nullptr) {
    throw Error(kWhere, library_name + " has no function " + name, "install OpenHaptics 3.4");
  }
  function = reinterpret_cast<Function>(symbol);
}

Api bind_all(void* library, const std::string& name) {
  Api api{};
  const auto take = [&](const char* symbol, auto& function) {
    bind(library, name, symbol, function);
  };
  take("hdInitDevice", api.init_device);
  take("hdDisableDevice", api.disable_device);
  take("hdMakeCurrentDevice", api.make_current_device);
  take("hdBeginFrame", api.begin_frame);
  take("hdEndFrame", api.end_frame);
  take("hdGetError", api.get_error);
  take("hdEnable", api.enable);
  take("hdDisable", api.disable);
  take("hdIsEnabled", api.is_enabled);
  take("hdGetIntegerv", api.get_integerv);
  take("hdGetDoublev", api.get_doublev);
  take("hdGetString", api.get_string);
  take("hdSetDoublev", api.set_doublev);
  take("hdCheckCalibration", api.check_calibration);
  take("hdUpdateCalibration", api.update_calibration);
  take("hdStartScheduler", api.start_scheduler);
  take("hdStopScheduler", api.stop_scheduler);
  take("hdSetSchedulerRate", api.set_scheduler_rate);
  take("hdScheduleAsynchronous", api.schedule_asynchronous);
  take("hdUnschedule", api.unschedule);
  return api;
}

}  // namespace

std::vector<std::string> library_names() {
  const char* const chosen = std::getenv("HD_LIBRARY");
  if (chosen != nullptr && *chosen != '\0') return {chosen};
  return {"libHD.so.3.4", "libHD.so.3", "libHD.so"};
}

std::string missing_object(const std::string& message) {
  const std::size_t end = message.find(": cannot open shared object file");
  return end == std::string::npos ? "" : message.substr(0, end);
}

std::string package_of(const std::string& object) {
  if (object.starts_with("libPhantomIOLib") || object.starts_with("libPHANToMIO") ||
      object.starts_with("libPhantomManager")) {
    return "install the vendor's device driver (Touch Device Driver for Linux)";
  }
  if (object.starts_with("libncurses.so.5")) return "install the Debian package libncurses5";
  if (object.starts_with("libtinfo.so.5")) return "install the Debian package libtinfo5";
  return "install what brings it, or add its folder to LD_LIBRARY_PATH";
}

Api load_library(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto [library, failure] = attempt(name);
    if (library != nullptr) return bind_all(library, name);
    const std::string missing = missing_object(failure);
    if (missing == name) continue;
    if (missing.empty()) {
      throw Error(kWhere, name + " cannot be loaded: " + failure,
                  "install the 64-bit OpenHaptics 3.4 and its device driver");
    }
    throw Error(kWhere, name + " is there, but needs " + missing + ", which is not",
                package_of(missing));
  }
  std::string tried;
  for (const std::string& name : names) tried += (tried.empty() ? "" : ", ") + name;
  throw Error(kWhere, "its library is not found (tried " + tried + ")",
              "install OpenHaptics 3.4 of 3D Systems, or name the library in $HD_LIBRARY");
}

const Api& library() {
  static const Api kApi = load_library(library_names());
  return kApi;
}

}  // namespace irdm::hd
