#include "server/viewer_session/recordings.hpp"

#include <ctime>

#include "common/error.hpp"
#include "viewer/message.hpp"

namespace irdm {
namespace {

constexpr std::size_t kSteps = 1024;  // that may wait to be written

// run-20260131-235959.h5, or ...-2.h5 when that is there.
std::filesystem::path new_path(const std::filesystem::path& folder) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  ::localtime_r(&now, &local);
  char name[32];
  std::strftime(name, sizeof name, "run-%Y%m%d-%H%M%S", &local);
  std::filesystem::path path = folder / (std::string(name) + ".h5");
  for (int i = 2; std::filesystem::exists(path); ++i) {
    path = folder / (std::string(name) + "-" + std::to_string(i) + ".h5");
  }
  return path;
}

}  // namespace

Recordings::Recordings(std::optional<std::filesystem::path> folder, TraceHeader header,
                       const StepShape& shape)
    : folder_(std::move(folder)), header_(std::move(header)), sink_(folder_ ? kSteps : 1, shape) {
  sink_.set_open(false);
}

void Recordings::begin() {
  if (!folder_) {
    throw Error("recording", "has no folder", "set viewer.recordings or start with --recordings");
  }
  if (recorder_) throw Error("recording", "is being made already", "end it first");
  if (complete_.size() >= viewer::kMaxRecordings) {
    throw Error("recording", "is one too many for this run", "start the server again");
  }
  std::error_code failure;
  std::filesystem::create_directories(*folder_, failure);
  path_ = new_path(*folder_);
  recorder_ = std::make_unique<RecorderThread>(path_, header_, sink_, RecorderThread::From::kReset);
  recorder_->start();
  sink_.set_open(true);
}

void Recordings::end() {
  if (!recorder_) return;
  sink_.set_open(false);
  recorder_->finish();
  const std::string error = recorder_->error();
  const std::uint64_t lost = recorder_->lost();
  const std::uint64_t rows = recorder_->rows();
  recorder_.reset();
  if (!error.empty()) throw Error(path_.string(), "ended early: " + error, "record again");
  if (rows == 0) {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    throw Error(path_.string(), "had no step", "let the run go on while it is recorded");
  }
  complete_.push_back(path_);
  if (lost > 0) {
    throw Error(path_.string(), "misses " + std::to_string(lost) + " steps: the disk is too slow",
                "record to a faster one");
  }
}

}  // namespace irdm
