#include "common/blackbox/black_box_file.hpp"

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <mutex>

#include "common/error.hpp"
#include "common/hdf5/handle.hpp"
#include "common/realtime/clock.hpp"

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

namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".h5";

/// UTC, to the millisecond: 20260131T120000.000Z.
std::string utc(std::int64_t monotonic) {
  using std::chrono::system_clock;
  const auto ago = std::chrono::nanoseconds(monotonic_ns() - monotonic);
  const auto then = system_clock::now() - std::chrono::duration_cast<system_clock::duration>(ago);
  const std::time_t seconds = system_clock::to_time_t(then);
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(then.time_since_epoch()).count() % 1000;
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y%m%dT%H%M%S.", &parts);
  const std::string fraction = std::to_string(1000 + milliseconds).substr(1);
  return std::string(text, length) + fraction + "Z";
}

/// Of this program, the oldest first.
std::vector<fs::path> black_boxes(const fs::path& folder, const std::string& program) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(program + "-") && name.ends_with(kEnding)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void make_room(const fs::path& folder, const std::string& program, std::size_t room) {
  std::vector<fs::path> old = black_boxes(folder, program);
  const std::size_t too_many = old.size() > room ? old.size() - room : 0;
  for (std::size_t i = 0; i < too_many; ++i) {
    std::error_code gone;  // by another process of the same program, perhaps
    fs::remove(old[i], gone);
  }
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
}

void fill(const fs::path& path, const std::string& program, const Fault& fault,
          const std::vector<BlackBoxPart*>& parts) {
  hdf5::File file = hdf5::File::create(path);
  file.write_attribute("/", "format", std::string("irdm-blackbox"));
  file.write_attribute("/", "version", std::int64_t{1});
  file.write_attribute("/", "created_by", program + " " + IRDM_VERSION);
  file.write_attribute("/", "fault", fault.kind);
  file.write_attribute("/", "detail", fault.detail);
  file.write_attribute("/", "fault_utc", utc(fault.time_ns));
  file.write_attribute("/", "fault_monotonic_ns", fault.time_ns);
  for (const BlackBoxPart* part : parts) part->write(file, fault.time_ns);
  file.close();
}

}  // namespace

fs::path write_black_box(const fs::path& folder, int files, const std::string& program,
                         const Fault& fault, const std::vector<BlackBoxPart*>& parts) {
  const std::string name = program + "-" + utc(fault.time_ns) + "-" + std::to_string(::getpid());
  const fs::path unfinished = folder / (name + ".part");
  try {
    fs::create_directories(folder);
    make_room(folder, program, static_cast<std::size_t>(files) - 1);
    const std::lock_guard lock(hdf5::library_mutex());
    fill(unfinished, program, fault, parts);
    fs::rename(unfinished, folder / (name + kEnding));
  } catch (const fs::filesystem_error& error) {
    remove_quietly(unfinished);
    throw Error(folder.string(), error.code().message(),
                "check permissions and free space, or set black_box to another folder");
  } catch (...) {
    remove_quietly(unfinished);
    throw;
  }
  return folder / (name + kEnding);
}

}  // namespace irdm
