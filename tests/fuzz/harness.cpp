#include "tests/fuzz/harness.hpp"

#include <cstdio>
#include <cstdlib>

namespace irdm::fuzz {

void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: it does not hold that %s\n", what);
  std::abort();
}

std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

}  // namespace irdm::fuzz
