#pragma once

#include <string>

namespace irdm {

/// For messages: a number as a stream prints it.
std::string number_text(double value);

}  // namespace irdm
