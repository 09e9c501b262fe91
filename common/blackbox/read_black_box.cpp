#include "common/blackbox/read_black_box.hpp"

namespace irdm {

BlackBoxSettings read_black_box(TomlTable& table) {
  constexpr int kMostFiles = 1000;
  BlackBoxSettings settings;
  if (table.has("black_box")) {
    const bool none = table.text("black_box").empty();
    settings.folder = none ? std::filesystem::path() : table.path("black_box");
  }
  settings.files = table.integer("black_box_files", 1, kMostFiles, settings.files);
  return settings;
}

}  // namespace irdm
