#include "device_bridge/driver_library.hpp"

#include <dlfcn.h>

#include "common/error.hpp"

namespace irdm {
namespace {

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

}  // namespace

std::string missing_object(const std::string& message) {
  const std::size_t end = message.find(": cannot open shared object file");
  return end == std::string::npos ? "" : message.substr(0, end);
}

DriverLibrary::DriverLibrary(const DriverSource& source) : source_(source) {
  std::string tried;
  for (const std::string& name : source.names) {
    const auto [library, failure] = attempt(name);
    library_ = library;
    name_ = name;
    if (library != nullptr) return;
    const std::string missing = missing_object(failure);
    if (missing.empty()) {
      throw Error(source.vendor, name + " cannot be loaded: " + failure, source.install);
    }
    if (missing != name) {
      throw Error(source.vendor, name + " is there, but needs " + missing + ", which is not",
                  source.package_of(missing));
    }
    tried += (tried.empty() ? "" : ", ") + name;
  }
  throw Error(source.vendor, "its library is not found (tried " + tried + ")", source.install);
}

void* DriverLibrary::find(const char* name) const noexcept {
  return ::dlsym(library_, name);
}

void* DriverLibrary::symbol(const char* name) const {
  if (void* const found = find(name)) return found;
  throw Error(source_.vendor, name_ + " has no function " + name, source_.install);
}

}  // namespace irdm
