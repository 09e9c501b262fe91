#include "replay/reference/step_journal.hpp"

#include <cstring>
#include <span>

#include "common/error.hpp"
#include "common/wire/frame.hpp"

namespace irdm::replay {
namespace {

std::span<const std::uint8_t> as_octets(const void* data, std::size_t count) {
  return {static_cast<const std::uint8_t*>(data), count};
}

std::string with_checksum(std::string bytes) {
  const std::uint32_t sum = wire::crc32c(as_octets(bytes.data(), bytes.size()));
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

}  // namespace

StepJournal::StepJournal(std::filesystem::path path, const std::string& key)
    : path_(std::move(path)) {
  const std::string head =
      with_checksum("irdm-steps 1\n" + std::to_string(key.size()) + "\n" + key);
  if (has_key(head)) return;
  file_.close();
  file_.clear();
  file_.open(path_, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc);
  if (!file_.write(head.data(), static_cast<std::streamsize>(head.size())) || !file_.flush()) {
    fail();
  }
  size_ = end_ = static_cast<std::streamoff>(head.size());
}

bool StepJournal::has_key(const std::string& head) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path_, error);
  if (error || size < head.size()) return false;
  file_.open(path_, std::ios::binary | std::ios::in | std::ios::out);
  std::string found(head.size(), '\0');
  if (!file_.read(found.data(), static_cast<std::streamsize>(found.size()))) return false;
  size_ = static_cast<std::streamoff>(size);
  end_ = static_cast<std::streamoff>(head.size());
  return found == head;
}

bool StepJournal::take(std::vector<double>& numbers) {
  if (keeps_) return false;
  std::uint64_t count = 0;
  std::uint32_t sum = 0;
  const auto fits = [&] {
    const auto left = static_cast<std::uint64_t>(size_ - end_);
    return left >= sizeof count + sizeof sum && count <= (left - sizeof count - sizeof sum) / 8;
  };
  file_.seekg(end_);
  file_.read(reinterpret_cast<char*>(&count), sizeof count);
  if (!file_ || !fits()) return false;
  numbers.resize(count);
  const std::size_t bytes = count * sizeof(double);
  file_.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(bytes));
  file_.read(reinterpret_cast<char*>(&sum), sizeof sum);
  if (!file_ ||
      sum != wire::crc32c(as_octets(&count, sizeof count), as_octets(numbers.data(), bytes))) {
    return false;
  }
  end_ += static_cast<std::streamoff>(sizeof count + bytes + sizeof sum);
  ++taken_;
  return true;
}

void StepJournal::begin_to_keep() {
  keeps_ = true;
  file_.close();
  file_.clear();
  std::error_code error;
  std::filesystem::resize_file(path_, static_cast<std::uintmax_t>(end_), error);
  file_.open(path_, std::ios::binary | std::ios::out | std::ios::app);
  if (error || !file_) fail();
}

void StepJournal::keep(const std::vector<double>& numbers) {
  if (!keeps_) begin_to_keep();
  const std::uint64_t count = numbers.size();
  std::string record(reinterpret_cast<const char*>(&count), sizeof count);
  record.append(reinterpret_cast<const char*>(numbers.data()), count * sizeof(double));
  record = with_checksum(std::move(record));
  if (!file_.write(record.data(), static_cast<std::streamsize>(record.size())) || !file_.flush()) {
    fail();
  }
}

void StepJournal::remove() noexcept {
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void StepJournal::fail() const {
  throw Error(path_.string(), "cannot be written",
              "give an output on a disk that has room, some 50 bytes for each node and step");
}

}  // namespace irdm::replay
