#include "viewer/notice_text.hpp"

#include <algorithm>

namespace irdm::viewer {
namespace {

constexpr std::string_view kBefore = " '\"(=";  // one of these before a slash begins a path

// Returns the length of the path at the front. In quotes, and at the beginning of a notice up to
// ": ", it may contain blanks.
std::size_t path_length(std::string_view path, char before) {
  std::size_t end = 0;
  if (before == '\0') {
    end = path.find(": ");
  } else if (before == '\'' || before == '"') {
    end = path.find(before);
  } else {
    end = path.find_first_of(" ;,)'\"");
  }
  return std::min(end, path.size());
}

}  // namespace

std::string file_names_only(std::string_view notice) {
  std::string out;
  char before = '\0';
  while (!notice.empty()) {
    const bool begins = before == '\0' || kBefore.find(before) != std::string_view::npos;
    std::string_view part = notice.substr(0, 1);
    if (begins && part == "/") part = notice.substr(0, path_length(notice, before));
    notice.remove_prefix(part.size());
    before = part.back();
    const std::size_t slash = part.rfind('/');
    const bool in_folder = slash != std::string_view::npos && slash > 0;
    out += in_folder ? part.substr(slash + 1) : part;
  }
  return out;
}

}  // namespace irdm::viewer
