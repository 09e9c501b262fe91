#include "tests/system/one_session.hpp"
#include "tests/support/catch.hpp"

#include "tests/system/stage.hpp"

namespace irdm::test {

void check_one_session(const std::string& bridge_output) {
  INFO(bridge_output);
  const double stalls = number_after(bridge_output, ", stalls ");
  CHECK(number_after(bridge_output, "sessions ") == 1 + stalls);
  CHECK(number_after(bridge_output, "reconnects ") == stalls);
  CHECK(number_after(bridge_output, "protocol errors ") == 0);
}

}  // namespace irdm::test
