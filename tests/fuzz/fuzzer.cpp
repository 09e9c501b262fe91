// The entries that libFuzzer calls: IRDM_FUZZ_HARNESS=NAME fuzzer ...
#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/harness.hpp"

namespace {

const irdm::fuzz::Harness* harness = nullptr;

// The fuzzer's clock ticks by a signal, which would make a call that waits fail: a connection, say.
bool outlast_ticks() {
  struct sigaction tick {};
  if (sigaction(SIGALRM, nullptr, &tick) != 0) return false;
  tick.sa_flags |= SA_RESTART;
  return sigaction(SIGALRM, &tick, nullptr) == 0;
}

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
  // The fuzzer has set its clock after it was initialised.
  [[maybe_unused]] static const bool once = outlast_ticks();
  harness->run({data, size});
  return 0;
}
