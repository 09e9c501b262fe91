#pragma once

#include "common/process/temporary_files.hpp"

namespace irdm::test {

using irdm::TemporaryFolder;

}  // namespace irdm::test
