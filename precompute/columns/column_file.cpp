#include "precompute/columns/column_file.hpp"

#include <cstring>
#include <sstream>

#include "common/error.hpp"
#include "common/response/spin_products.hpp"
#include "common/wire/crc32c.hpp"

namespace irdm::precompute {
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
