#include "common/wire/crc32c.hpp"

#include <boost/crc.hpp>

namespace irdm::wire {

std::uint32_t crc32c(std::span<const std::uint8_t> first,
                     std::span<const std::uint8_t> second) noexcept {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(first.data(), first.size());
  crc.process_bytes(second.data(), second.size());
  return crc.checksum();
}

}  // namespace irdm::wire
