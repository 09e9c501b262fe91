#pragma once

#include <string>

#include "common/error.hpp"

namespace irdm {

/// Throws Error about a model file that is not what docs/files.md says.
[[noreturn]] inline void refuse_model(const std::string& file, const std::string& what) {
  throw Error(file, what, "make the model again with irdm-precompute");
}

}  // namespace irdm
