#include "replay/output/vtk_xml.hpp"

#include <openssl/evp.h>

#include <bit>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace irdm::replay {
namespace {

// The number of bytes and the bytes, in one piece.
std::string base64(std::span<const std::byte> bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  if (bytes.size() > kMost) throw std::length_error("too many numbers for one array of a VTK file");
  const std::uint64_t count = bytes.size();
  std::vector<unsigned char> all(sizeof count + bytes.size());
  std::memcpy(all.data(), &count, sizeof count);
  if (!bytes.empty()) std::memcpy(all.data() + sizeof count, bytes.data(), bytes.size());
  std::string text(4 * ((all.size() + 2) / 3) + 1, '\0');  // the last is for its final zero
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), all.data(),
                                     static_cast<int>(all.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string array(const std::string& type, const std::string& name,
                  std::span<const std::byte> bytes, int components, const std::string& more) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\"" + more + ">" + base64(bytes) +
         "</DataArray>\n";
}

}  // namespace

std::string vtk_file(const std::string& type, const std::string& content) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + "\" version=\"1.0\" byte_order=\"" +
         order + "\" header_type=\"UInt64\">\n" + content + "</VTKFile>\n";
}

std::string vtk_array(const std::string& name, std::span<const double> values, int components,
                      const std::string& more) {
  return array("Float64", name, std::as_bytes(values), components, more);
}

std::string vtk_array(const std::string& name, std::span<const std::int32_t> values, int components,
                      const std::string& more) {
  return array("Int32", name, std::as_bytes(values), components, more);
}

}  // namespace irdm::replay
