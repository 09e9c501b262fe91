#include <filesystem>

#include "common/error.hpp"
#include "common/wire/secret_key.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {

void key_file(Input input) {
  const std::filesystem::path path = scratch_file("it.key", text_of(input));
  using std::filesystem::perms;
  std::filesystem::permissions(path, perms::owner_read | perms::owner_write);
  if (input.empty()) std::filesystem::remove(path);
  try {
    wire::read_key_file(path);
    expect(input.size() >= 2 * wire::SecretKey().size(), "a key has 64 digits");
  } catch (const Error&) {
  }
}

}  // namespace irdm::fuzz
