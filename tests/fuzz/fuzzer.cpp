// The entry that libFuzzer calls, for one harness.
#include <cstddef>

#include "tests/fuzz/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  irdm::fuzz::IRDM_FUZZ_HARNESS({data, size});
  return 0;
}
