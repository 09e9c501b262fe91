#include "common/program/passive_openmp.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

namespace irdm {

void wait_passively_in_openmp(char** argv) {
  for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"}) {
    if (std::getenv(name) != nullptr) return;
  }
  if (::setenv("OMP_WAIT_POLICY", "passive", 1) != 0) return;
  // By its own name, which lists of processes show.
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) ::execv(self.c_str(), argv);  // returns only on failure: go on as it is
}

}  // namespace irdm
