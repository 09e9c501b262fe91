#pragma once

#include <cstddef>
#include <string>

namespace irdm {

/// For messages: a number as a stream prints it.
std::string number_text(double value);
/// "1 stylus", "2 styluses".
std::string styluses_text(std::size_t count);

}  // namespace irdm
