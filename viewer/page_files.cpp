#include "viewer/page_files.hpp"

#include <fstream>
#include <sstream>

#include "common/checksum.hpp"
#include "common/error.hpp"

namespace irdm::viewer {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string> kTypes = {
    {".html", "text/html; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".svg", "image/svg+xml"},
};
const std::string kImmutableFolder = "/assets/";  // build.mjs puts a checksum into names there

std::string content(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || !text) {
    throw Error(path.string(), "cannot be read",
                "check its permissions, or start with --no-viewer");
  }
  return text.str();
}

std::string etag_of(const std::string& body) {
  constexpr std::size_t kDigits = 24;
  Sha256 sum;
  sum.update(body.data(), body.size());
  std::string etag = "\"";
  etag += sum.hexadecimal().substr(0, kDigits);
  etag += '"';
  return etag;
}

}  // namespace

PageFiles PageFiles::read(const fs::path& folder) {
  PageFiles files;
  if (!fs::is_directory(folder)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const auto type = kTypes.find(entry.path().extension().string());
    if (!entry.is_regular_file() || type == kTypes.end()) continue;
    std::string path = "/";
    path += fs::relative(entry.path(), folder).generic_string();
    PageFile file;
    file.type = type->second;
    file.body = content(entry.path());
    const fs::path packed = entry.path().string() + ".gz";
    if (fs::is_regular_file(packed)) file.packed = content(packed);
    file.etag = etag_of(file.body);
    file.immutable = path.starts_with(kImmutableFolder);
    files.add(path, std::move(file));
  }
  return files;
}

const PageFile* PageFiles::find(std::string_view target) const {
  const std::string_view path = target.substr(0, target.find('?'));
  const auto found = files_.find(path == "/" ? std::string_view("/index.html") : path);
  return found == files_.end() ? nullptr : &found->second;
}

fs::path page_folder() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  return (program.parent_path() / IRDM_PAGE_FROM_PROGRAMS).lexically_normal();
}

}  // namespace irdm::viewer
