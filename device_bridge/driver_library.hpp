#pragma once

#include <functional>
#include <string>
#include <vector>

namespace irdm {

/// Where a vendor's driver may be found.
struct DriverSource {
  std::string vendor;              ///< for messages
  std::vector<std::string> names;  ///< to try, in this order
  std::string install;             ///< what to do when none of them is there
  /// What to do when one needs another shared object that is not there; its name is the argument.
  std::function<std::string(const std::string&)> package_of;
};

/// A vendor's driver, a shared library that is loaded at run time and kept for good: drivers do not
/// bear to be loaded a second time.
class DriverLibrary {
 public:
  /// Loads the first that is there. Throws Error that says what is missing: the library, or one
  /// that it needs.
  explicit DriverLibrary(const DriverSource& source);

  /// Looks a function up. Throws Error when the library has none of this name.
  template <typename Function>
  void bind(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(symbol(name));
  }
  /// The same; null where the library has none.
  template <typename Function>
  void bind_if_there(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(find(name));
  }

 private:
  void* symbol(const char* name) const;
  void* find(const char* name) const noexcept;

  DriverSource source_;
  std::string name_;
  void* library_ = nullptr;
};

/// The shared object that a message of dlopen misses; empty when it is about something else. Pure.
std::string missing_object(const std::string& message);

}  // namespace irdm
