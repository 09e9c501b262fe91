#include "common/number_text.hpp"

#include <sstream>

namespace irdm {

std::string number_text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

std::string styluses_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " stylus" : " styluses");
}

}  // namespace irdm
