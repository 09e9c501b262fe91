#include "precompute/columns/column_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "common/error.hpp"
#include "common/response/modal_response.hpp"
#include "common/wire/frame.hpp"

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
    // File systems without locks (NFS without lockd) say so by other causes; they are used
    // unlocked.
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
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

namespace {

bool read_number(const char*& at, const char* end, int& value) {
  const auto [next, error] = std::from_chars(at, end, value);
  at = next;
  return error == std::errc() && value >= 0;
}

}  // namespace

ColumnRange column_range_from_text(const std::string& text) {
  ColumnRange range;
  const char* at = text.data();
  const char* const end = at + text.size();
  const bool good = read_number(at, end, range.begin) && at != end && *at++ == ':' &&
                    read_number(at, end, range.end) && at == end && range.begin < range.end;
  if (!good) throw std::invalid_argument(in_quotes(text) + " is not A:B with 0 <= A < B");
  return range;
}

std::string to_text(const ColumnRange& range) {
  return std::to_string(range.begin) + ":" + std::to_string(range.end);
}

ColumnRange share_of(const ColumnRange& range, int rank, int size, int block) {
  const int first = range.begin / block;
  const int blocks = (range.end + block - 1) / block - first;
  const auto cut = [&](int k) {
    const auto whole = static_cast<long>(blocks) * k / size;
    return std::clamp(static_cast<int>(first + whole) * block, range.begin, range.end);
  };
  return {cut(rank), rank + 1 == size ? range.end : cut(rank + 1)};
}

namespace {

constexpr const char* kMagic = "irdm-columns 1";
// More than any header has before settings and description.
constexpr std::size_t kMostHeaderText = 1 << 12;

bool read_word(std::istream& text, const char* word) {
  std::string found;
  return text >> found && found == word;
}

// Reads "centrifugal 6" and "gravity 3", both of which may be missing, and "settings".
bool parse_options(std::istream& text, ColumnFileHeader& header) {
  for (std::string word; text >> word;) {
    int value = 0;
    if (word == "settings") return true;
    if (word == "centrifugal" && text >> value && value == kSpinProducts) {
      header.centrifugal = true;
    } else if (word == "gravity" && text >> value && value == kGravityColumns) {
      header.gravity = true;
    } else {
      return false;
    }
  }
  return false;
}

// Of what comes after the text.
struct Lengths {
  std::size_t settings = 0;
  std::size_t description = 0;
};

// False: not such a text.
bool parse_text(std::istream& text, ColumnFileHeader& header, Lengths& lengths) {
  constexpr std::size_t kMost = 1U << 30;
  std::string magic;
  int number_bytes = 0;
  std::getline(text, magic);
  const bool good =
      magic == kMagic && read_word(text, "columns") &&
      text >> header.range.begin >> header.range.end && read_word(text, "shape") &&
      text >> header.degrees_of_freedom >> header.steps >> number_bytes &&
      parse_options(text, header) && text >> lengths.settings && read_word(text, "description") &&
      text >> lengths.description && text.get() == '\n' &&
      (number_bytes == 4 || number_bytes == 8) && header.steps > 0 && header.range.begin >= 0 &&
      header.range.begin < header.range.end && header.range.end <= header.degrees_of_freedom;
  if (!good || lengths.settings > kMost || lengths.description > kMost) return false;
  header.precision = number_bytes == 4 ? Precision::kSingle : Precision::kDouble;
  return true;
}

// Of so many bytes, without making room for a column that cannot be there.
std::size_t whole_columns(const ColumnFileHeader& header, std::size_t bytes) {
  const auto numbers =
      static_cast<std::size_t>(header.degrees_of_freedom) * static_cast<std::size_t>(header.steps);
  return numbers > bytes ? 0 : bytes / (header.column_bytes() + kChecksumBytes);
}

}  // namespace

std::uint32_t column_checksum(const void* bytes, std::size_t count) {
  return wire::crc32c({static_cast<const std::uint8_t*>(bytes), count});
}

bool is_intact(std::span<const std::uint8_t> record) {
  const std::size_t count = record.size() - kChecksumBytes;
  const std::uint32_t sum = column_checksum(record.data(), count);
  return std::memcmp(&sum, record.data() + count, kChecksumBytes) == 0;
}

std::string encode_header(const ColumnFileHeader& header) {
  std::ostringstream text;
  text << kMagic << "\ncolumns " << header.range.begin << ' ' << header.range.end << "\nshape "
       << header.degrees_of_freedom << ' ' << header.steps << ' '
       << (header.precision == Precision::kSingle ? 4 : 8);
  if (header.centrifugal) text << "\ncentrifugal " << kSpinProducts;
  if (header.gravity) text << "\ngravity " << kGravityColumns;
  text << "\nsettings " << header.settings.size() << "\ndescription " << header.description.size()
       << '\n'
       << header.settings << header.description;
  const std::string bytes = text.str();
  const std::uint32_t sum = column_checksum(bytes.data(), bytes.size());
  return bytes + std::string(reinterpret_cast<const char*>(&sum), kChecksumBytes);
}

std::size_t ColumnFileHeader::column_bytes() const {
  return static_cast<std::size_t>(degrees_of_freedom) * static_cast<std::size_t>(steps) *
         (precision == Precision::kSingle ? sizeof(float) : sizeof(double));
}

int ColumnFileHeader::stored_columns() const {
  return range.count() + (centrifugal ? kSpinProducts : 0) + (gravity ? kGravityColumns : 0);
}

std::string description_of(const Model& model) {
  hdf5::File file = hdf5::File::in_memory("description of the model");
  write_description(file, model);
  return file.image();
}

ColumnFileReader::ColumnFileReader(const std::filesystem::path& path)
    : name_(path.string()), stream_(path, std::ios::binary) {
  if (!stream_) throw Error(name_, "cannot be read", "check the path and its permissions");
  std::string text(kMostHeaderText, '\0');
  stream_.read(text.data(), static_cast<std::streamsize>(text.size()));
  std::istringstream parsed(text.substr(0, static_cast<std::size_t>(stream_.gcount())));
  stream_.clear();
  Lengths lengths;
  if (!parse_text(parsed, header_, lengths)) {
    throw Error(name_, "is not a part of R", "give files that irdm-precompute --columns wrote");
  }
  const auto after_text = static_cast<std::size_t>(parsed.tellg());
  const std::size_t length = after_text + lengths.settings + lengths.description + kChecksumBytes;
  const std::size_t size = std::filesystem::file_size(path);
  if (length > size) damaged("is cut off");
  std::string head(length, '\0');
  stream_.seekg(0);
  stream_.read(head.data(), static_cast<std::streamsize>(length));
  if (!is_intact({reinterpret_cast<const std::uint8_t*>(head.data()), length})) {
    damaged("has a damaged beginning");
  }
  header_.settings = head.substr(after_text, lengths.settings);
  header_.description = head.substr(after_text + lengths.settings, lengths.description);
  columns_at_ = static_cast<std::streamoff>(length);
  const std::size_t whole = whole_columns(header_, size - length);
  const auto expected = static_cast<std::size_t>(header_.stored_columns());
  if (whole < expected) {
    throw Error(
        name_,
        "has only " + std::to_string(whole) + " of its " + std::to_string(expected) + " columns",
        "give the command that makes it again, which goes on from there");
  }
  column_.resize(header_.column_bytes() + kChecksumBytes);
}

void ColumnFileReader::damaged(const std::string& what) const {
  throw Error(name_, what, "make it again with irdm-precompute --columns");
}

std::span<const std::uint8_t> ColumnFileReader::next() {
  stream_.read(reinterpret_cast<char*>(column_.data()),
               static_cast<std::streamsize>(column_.size()));
  if (!stream_ || !is_intact(column_)) damaged("has a damaged column");
  return std::span(column_).first(column_.size() - kChecksumBytes);
}

void ColumnFileReader::rewind() {
  stream_.clear();
  stream_.seekg(columns_at_);
}

}  // namespace irdm::precompute
