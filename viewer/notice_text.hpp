#pragma once

#include <string>
#include <string_view>

namespace irdm::viewer {

/// Returns a notice in which each absolute path is replaced by its last name: viewers, onlookers
/// among them, need not know the server's folders.
std::string file_names_only(std::string_view notice);

}  // namespace irdm::viewer
