#pragma once

#include <cstdint>
#include <filesystem>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"

namespace irdm::test {

/// Steps that a trace says it has, while it is written as well; 0 before it is begun.
inline std::uint64_t committed_so_far(const std::filesystem::path& path) {
  try {
    return hdf5::File::open(path).read<std::uint64_t>("/committed", {1})[0];
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace irdm::test
