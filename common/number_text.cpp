#include "common/number_text.hpp"

#include <sstream>

namespace irdm {

std::string number_text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

}  // namespace irdm
