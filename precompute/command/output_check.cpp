#include "precompute/command/output_check.hpp"

#include "common/error.hpp"

namespace irdm::precompute {

void check_output(const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs) {
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    throw Error(output.string(), "is a folder", "give the output the name of a file");
  }
  if (!std::filesystem::is_directory(std::filesystem::absolute(output).parent_path(), ignored)) {
    throw Error(output.string(), "cannot be created",
                "check that the folder exists and is writable");
  }
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(input, output, ignored)) continue;
    throw Error(output.string(), "is the input itself", "give the output another name");
  }
}

}  // namespace irdm::precompute
