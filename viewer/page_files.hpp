#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace irdm::viewer {

/// One file of the page, in memory.
struct PageFile {
  std::string type;        ///< Content-Type
  std::string body;        ///< as it is
  std::string packed;      ///< by gzip; empty: not made
  std::string etag;        ///< with its quotes
  bool immutable = false;  ///< its name tells its content: it may be kept for good
};

/// The built page. Only what was there at start-up is ever served: a request's path is looked up,
/// never opened.
class PageFiles {
 public:
  /// None.
  PageFiles() = default;
  /// Reads all files of a folder that have a known extension; NAME.gz beside NAME is its packed
  /// form. A folder that is not there: none. Throws Error when a file cannot be read.
  static PageFiles read(const std::filesystem::path& folder);

  void add(const std::string& path, PageFile file) { files_[path] = std::move(file); }
  /// @param target of a request, such as "/" or "/assets/app.js?x"; null: there is no such file
  const PageFile* find(std::string_view target) const;
  bool empty() const noexcept { return files_.empty(); }

 private:
  std::map<std::string, PageFile, std::less<>> files_;
};

/// Where the page of this program is: beside the folder of its programs, built or installed.
std::filesystem::path page_folder();

}  // namespace irdm::viewer
