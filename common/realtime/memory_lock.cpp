#include "common/realtime/memory_lock.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <system_error>

#include "common/error.hpp"

namespace irdm {

std::string lock_memory(RealTimeScheduling wanted) {
  if (wanted == RealTimeScheduling::kIgnore) return "not locked";
#ifdef IRDM_SANITIZED
  return "not locked (its shadow is too large)";
#else
  if (::mlockall(MCL_CURRENT) == 0) return "locked";
  const std::string reason = std::generic_category().message(errno);
  ::munlockall();  // it may have come half-way
  if (wanted == RealTimeScheduling::kRequire) {
    throw Error("locked memory", reason, std::string(kRealTimeRemedy));
  }
  return "not locked (" + reason + ")";
#endif
}

}  // namespace irdm
