#include "precompute/columns/column_file_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

void sync_folder(const std::filesystem::path& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

ColumnFileWriter::ColumnFileWriter(std::filesystem::path path, const ColumnFileHeader& header)
    : path_(std::move(path)) {
  const std::string head = encode_header(header);
  open_locked();
  if (starts_with(head)) {
    resumed_ = count_whole_columns(head.size(), header);
  } else {
    replaced_ = ::lseek(file_, 0, SEEK_END) > 0;
    if (::ftruncate(file_, 0) != 0) throw Error(path_.string(), "cannot be emptied", "remove it");
    ::lseek(file_, 0, SEEK_SET);
    write(head.data(), head.size());
    sync();
    sync_folder(path_);
    return;
  }
  const auto end = static_cast<off_t>(head.size() + static_cast<std::size_t>(resumed_) *
                                                        (header.column_bytes() + kChecksumBytes));
  if (::ftruncate(file_, end) != 0) throw Error(path_.string(), "cannot be shortened", "remove it");
  ::lseek(file_, end, SEEK_SET);
}

ColumnFileWriter::~ColumnFileWriter() {
  if (file_ >= 0) ::close(file_);
}

void ColumnFileWriter::open_locked() {
  // Anew where another process gave the file another name between the opening and the lock.
  for (;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) {
      throw Error(path_.string(), std::string("cannot be opened: ") + std::strerror(errno),
                  "check that the folder exists and is writable");
    }
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      throw Error(path_.string(), "is being written by another run",
                  "wait for its end or choose another output");
    }
    struct stat mine {};
    struct stat named {};
    if (::fstat(file_, &mine) == 0 && ::stat(path_.c_str(), &named) == 0 &&
        mine.st_ino == named.st_ino) {
      return;
    }
    ::close(file_);
  }
}

bool ColumnFileWriter::starts_with(const std::string& head) const {
  std::string found(head.size(), '\0');
  return ::pread(file_, found.data(), found.size(), 0) == static_cast<ssize_t>(found.size()) &&
         found == head;
}

int ColumnFileWriter::count_whole_columns(std::size_t head, const ColumnFileHeader& header) const {
  std::vector<std::uint8_t> record(header.column_bytes() + kChecksumBytes);
  int count = 0;
  for (auto at = static_cast<off_t>(head); count < header.range.count();
       ++count, at += static_cast<off_t>(record.size())) {
    std::size_t have = 0;
    while (have < record.size()) {
      const ssize_t got =
          ::pread(file_, record.data() + have, record.size() - have, at + static_cast<off_t>(have));
      if (got <= 0) return count;
      have += static_cast<std::size_t>(got);
    }
    if (!is_intact(record)) return count;
  }
  return count;
}

void ColumnFileWriter::write(const void* bytes, std::size_t count) {
  const auto* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file_, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw Error(path_.string(), std::string("cannot be written: ") + std::strerror(errno),
                  "make room; the same command goes on from here");
    }
    at += written;
    count -= static_cast<std::size_t>(written);
  }
}

void ColumnFileWriter::append(std::span<const std::uint8_t> column) {
  write(column.data(), column.size());
  const std::uint32_t sum = column_checksum(column.data(), column.size());
  write(&sum, kChecksumBytes);
}

void ColumnFileWriter::sync() {
  if (::fdatasync(file_) != 0) {
    throw Error(path_.string(),
                std::string("cannot be written to the disk: ") + std::strerror(errno),
                "make room; the same command goes on from here");
  }
}

void ColumnFileWriter::commit(const std::filesystem::path& name) {
  sync();
  std::error_code error;
  std::filesystem::rename(path_, name, error);
  if (error) {
    throw Error(name.string(), "cannot be given its name: " + error.message(),
                "check permissions of the folder");
  }
  sync_folder(name);
}

}  // namespace irdm::precompute
