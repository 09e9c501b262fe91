#include "precompute/mesh/format/vtu_data.hpp"

#include <zlib.h>

#include <stdexcept>
#include <string>

namespace irdm::precompute {
namespace {

constexpr std::size_t kMaxInflation = 1100;  // zlib's best is 1032 to 1

[[noreturn]] void truncated() {
  throw std::runtime_error("its data end too early");
}

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  if (c == '=') return 0;
  throw std::runtime_error("its data have a character that is not base64");
}

// Bytes taken one run after the other; each run of base64 is padded on its own.
class ByteRuns {
 public:
  ByteRuns(std::string_view text, bool base64) : text_(text), base64_(base64) {
    if (!base64) return;
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
  }

  std::string peek(std::size_t count) const {
    if (stored(count) > text_.size()) truncated();
    if (!base64_) return std::string(text_.substr(0, count));
    std::string bytes;
    for (std::size_t i = 0; bytes.size() < count; i += 4) {
      int bits = 0;
      for (std::size_t k = 0; k < 4; ++k) bits = bits << 6 | base64_value(text_[i + k]);
      for (const int shift : {16, 8, 0}) bytes += static_cast<char>(bits >> shift & 0xff);
    }
    bytes.resize(count);
    return bytes;
  }

  std::string take(std::size_t count) {
    std::string bytes = peek(count);
    text_.remove_prefix(stored(count));
    return bytes;
  }

  // Whether a run of base64 is padded after these bytes.
  bool ends_after(std::size_t count) const {
    return base64_ && count % 3 != 0 && text_[stored(count) - 1] == '=';
  }

  // No run can be longer than this.
  std::size_t left() const { return text_.size(); }

 private:
  std::size_t stored(std::size_t count) const { return base64_ ? (count + 2) / 3 * 4 : count; }

  std::string_view text_;
  bool base64_;
};

std::size_t decode_size(std::string_view bytes, const VtuCoding& coding, std::size_t limit) {
  const double value = decode_number(bytes, coding.header, coding.order);
  if (value > static_cast<double>(limit)) truncated();
  return static_cast<std::size_t>(value);
}

std::string inflate(std::string_view compressed, std::size_t size) {
  if (size > kMaxInflation * compressed.size()) {
    throw std::runtime_error("a compressed block says a size that is impossible");
  }
  std::string bytes(size, '\0');
  auto written = static_cast<uLongf>(size);
  const int status =
      ::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &written,
                   reinterpret_cast<const Bytef*>(compressed.data()), compressed.size());
  if (status != Z_OK || written != size) {
    throw std::runtime_error("a compressed block is damaged");
  }
  return bytes;
}

// Header: number of blocks, size of a block, size of the last one if it is another, and the
// compressed size of each.
std::string compressed_bytes(ByteRuns runs, const VtuCoding& coding) {
  const std::size_t word = size_of(coding.header);
  const std::size_t limit = runs.left();
  const std::size_t blocks = decode_size(runs.peek(word), coding, limit);
  const std::string header = runs.take((3 + blocks) * word);
  const auto entry = [&](std::size_t i, std::size_t highest) {
    return decode_size(std::string_view(header).substr(i * word), coding, highest);
  };
  std::size_t total = 0;
  for (std::size_t b = 0; b < blocks; ++b) total += entry(3 + b, limit);
  const std::string data = runs.take(total);
  const std::size_t full = entry(1, kMaxInflation * limit);
  const std::size_t last = entry(2, kMaxInflation * limit);
  std::string bytes;
  std::size_t begin = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t size = entry(3 + b, limit);
    bytes += inflate(std::string_view(data).substr(begin, size),
                     b + 1 == blocks && last > 0 ? last : full);
    begin += size;
  }
  return bytes;
}

// Header: the number of bytes; in one run with the data, or in a run of its own.
std::string plain_bytes(ByteRuns runs, const VtuCoding& coding) {
  const std::size_t word = size_of(coding.header);
  const std::size_t size = decode_size(runs.peek(word), coding, runs.left());
  if (!runs.ends_after(word)) return runs.take(word + size).substr(word);
  runs.take(word);
  return runs.take(size);
}

}  // namespace

std::vector<double> decode_vtu_array(std::string_view text, bool base64, NumberType type,
                                     const VtuCoding& coding) {
  const ByteRuns runs(text, base64);
  const std::string bytes =
      coding.compressed ? compressed_bytes(runs, coding) : plain_bytes(runs, coding);
  return decode_numbers(bytes, type, coding.order);
}

}  // namespace irdm::precompute
