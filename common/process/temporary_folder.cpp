#include "common/process/temporary_folder.hpp"

#include <cstdlib>
#include <system_error>

#include "common/error.hpp"

namespace irdm {

TemporaryFolder::TemporaryFolder(const std::string& prefix) {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / (prefix + "-XXXXXX")).string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw Error(name, "no temporary folder can be made", "check TMPDIR and the space left there");
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace irdm
