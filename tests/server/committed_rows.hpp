#pragma once

#include <filesystem>

namespace irdm::test {

/// Every row that counts is what was recorded: row k is record(k). Returns how many do.
std::size_t check_committed(const std::filesystem::path& path);

}  // namespace irdm::test
