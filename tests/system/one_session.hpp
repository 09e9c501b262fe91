#pragma once

#include <string>

namespace irdm::test {

/// A bridge that ended with this output stayed with its server; only where the machine stood still
/// for longer than a link may be silent, the link was made anew.
void check_one_session(const std::string& bridge_output);

}  // namespace irdm::test
