#pragma once

#include <mutex>

namespace irdm::hdf5 {

/// Held by whoever uses the library while other threads may: it is not thread safe. Never by a
/// real-time thread.
inline std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace irdm::hdf5
