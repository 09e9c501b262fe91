#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

/// An HDF5 file in which the fuzzer changes what the library lets anybody write: it takes datasets
/// and attributes away, gives them other numbers, types and shapes. Bytes of its choice would only
/// bring down HDF5 itself, which is not ours to mend.
class EditedFile {
 public:
  /// @param valid where the edits begin
  explicit EditedFile(const std::filesystem::path& valid);

  /// A file after edits, whose number the input's length gives.
  std::filesystem::path edited(Input input) const;

 private:
  std::string image_;
  std::vector<std::string> datasets_;
  std::vector<std::pair<std::string, std::string>> attributes_;  ///< owner and name
};

}  // namespace irdm::fuzz
