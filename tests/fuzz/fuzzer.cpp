// The entries that libFuzzer calls: IRDM_FUZZ_HARNESS=NAME fuzzer ...
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/harness.hpp"

namespace {

const irdm::fuzz::Harness* harness = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const name = std::getenv("IRDM_FUZZ_HARNESS");
  const auto& all = irdm::fuzz::kHarnesses;
  harness = std::ranges::find(all, std::string_view(name == nullptr ? "" : name),
                              &irdm::fuzz::Harness::name);
  if (harness != all.end()) return 0;
  std::fputs("set IRDM_FUZZ_HARNESS to one of:\n", stderr);
  for (const auto& each : all) std::fprintf(stderr, "  %s\n", each.name.data());
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  harness->run({data, size});
  return 0;
}
