#pragma once

#include "common/process/temporary_folder.hpp"

namespace irdm::test {

using irdm::TemporaryFolder;

}  // namespace irdm::test
