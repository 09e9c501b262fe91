#pragma once

#include <string>
#include <vector>

#include "device_bridge/openhaptics/hd_api.hpp"

namespace irdm::hd {

/// Where libHD.so is looked for, in this order: what $HD_LIBRARY names and nothing else, or the
/// usual names.
std::vector<std::string> library_names();

/// Loads the first of these libraries that is there. Throws Error that says what is missing: the
/// library, one that it needs, or a function in it.
Api load_library(const std::vector<std::string>& names);

/// The one of this process, loaded when first asked for. Throws as load_library().
const Api& library();

/// Which package brings a shared object that libHD.so needs, as advice. Pure.
std::string package_of(const std::string& object);

}  // namespace irdm::hd
