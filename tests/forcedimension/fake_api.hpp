#pragma once

#include "device_bridge/forcedimension/dhd_api.hpp"
#include "tests/fake_libdhd/fake_dhd.hpp"

namespace irdm::test {

/// The functions of the fake, looked up as in the real library.
inline const dhd::Api& fake_api() {
  static const dhd::Api kApi = dhd::load_library({IRDM_FAKE_LIBDHD});
  return kApi;
}

}  // namespace irdm::test
