#include "common/process/temporary_files.hpp"

#include <unistd.h>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "common/error.hpp"

namespace irdm {
namespace {

// Of the process that a part is named after.
std::optional<pid_t> writer_of(std::string_view part, std::string_view prefix) {
  if (!part.starts_with(prefix)) return std::nullopt;
  part.remove_prefix(prefix.size());
  pid_t writer = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), writer);
  if (error != std::errc() || end != part.data() + part.size() || writer <= 0) return std::nullopt;
  return writer;
}

// A process of another user is there as well: kill(2) may not reach it.
bool lives(pid_t process) {
  return ::kill(process, 0) == 0 || errno != ESRCH;
}

}  // namespace

std::filesystem::path fresh_part_name(const std::filesystem::path& path) {
  const std::string prefix = path.filename().string() + ".part-";
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const pid_t own = ::getpid();
  std::error_code ignored;  // whoever writes there says what is wrong with the folder
  for (std::filesystem::directory_iterator part(folder, ignored), end; part != end;
       part.increment(ignored)) {
    const std::optional<pid_t> writer = writer_of(part->path().filename().string(), prefix);
    if (!writer || (*writer != own && lives(*writer))) continue;
    if (part->is_regular_file(ignored)) std::filesystem::remove(part->path(), ignored);
  }
  return path.string() + ".part-" + std::to_string(own);
}

TemporaryFolder::TemporaryFolder(const std::string& prefix) {
  std::error_code error;
  // Absolute: the programs that work there have a folder of their own.
  std::string name = (std::filesystem::absolute(std::filesystem::temp_directory_path(error)) /
                      (prefix + "-XXXXXX"))
                         .string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw Error(name, "no temporary folder can be made", "check TMPDIR and the space left there");
  }
  path_ = name;
  cleanup_.emplace(CleanupAction{.remove = path_});
}

TemporaryFolder::~TemporaryFolder() {
  // The last processes of a program that was killed may still make files there.
  constexpr int kMostTries = 10;
  std::error_code failed;
  for (int i = 0; i < kMostTries; ++i) {
    std::filesystem::remove_all(path_, failed);
    if (!failed) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void TemporaryFolder::require_space() const {
  std::error_code unknown;
  const std::filesystem::space_info space = std::filesystem::space(path_, unknown);
  // Some file systems, as those in memory without a limit, have no size.
  if (unknown || space.capacity == 0 || space.available > 0) return;
  throw Error(path_.parent_path().string(), "no space is left for temporary files",
              "make room there, or set TMPDIR to another folder");
}

}  // namespace irdm
