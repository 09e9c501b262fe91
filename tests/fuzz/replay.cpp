// Gives a harness every file of some folders, without a fuzzer: fuzz_replay HARNESS FOLDER...
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/harness.hpp"

namespace {

std::vector<std::uint8_t> content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

int main(int argc, char** argv) {
  using irdm::fuzz::kHarnesses;
  const auto* harness = argc < 3 ? kHarnesses.end()
                                 : std::ranges::find(kHarnesses, std::string_view(argv[1]),
                                                     &irdm::fuzz::Harness::name);
  if (harness == kHarnesses.end()) {
    std::fputs("usage: fuzz_replay HARNESS FOLDER...; harnesses:\n", stderr);
    for (const auto& each : kHarnesses) std::fprintf(stderr, "  %s\n", each.name.data());
    return 2;
  }
  int count = 0;
  for (int i = 2; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (!entry.is_regular_file()) continue;
      std::printf("%s\n", entry.path().c_str());
      std::fflush(stdout);  // the last name is the culprit's
      const std::vector<std::uint8_t> bytes = content(entry.path());
      harness->run(bytes);
      ++count;
    }
  }
  return count > 0 ? 0 : 1;
}
