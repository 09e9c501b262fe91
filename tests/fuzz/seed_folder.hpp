#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "common/contact/contact_model.hpp"

/// Valid messages and files, where fuzzing begins. Text seeds are files.
namespace irdm::fuzz {

using SeedBytes = std::vector<std::uint8_t>;

/// A folder with a folder of seeds for each harness.
class Seeds {
 public:
  explicit Seeds(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Of a seed that is to be written; its folder is there.
  std::filesystem::path path(const std::string& harness, const std::string& name) const {
    std::filesystem::create_directories(folder_ / harness);
    return folder_ / harness / name;
  }
  template <typename Bytes>
  void write(const std::string& harness, const std::string& name, const Bytes& bytes) const {
    std::ofstream file(path(harness, name), std::ios::binary);
    for (const auto byte : bytes) file.put(static_cast<char>(byte));
  }

 private:
  std::filesystem::path folder_;
};

/// A fixed wall at y = 0 that gives way by 1 mm per newton within a step.
ContactModel wall();
/// Models that cannot be true, one for each reason.
std::vector<ContactModel> untrue_models();
/// A record of the harnesses with datagrams.
void add_record(SeedBytes& records, std::uint8_t kind, std::size_t number,
                std::span<const std::uint8_t> bytes = {});

void write_viewer_seeds(const Seeds& seeds);
void write_wire_seeds(const Seeds& seeds);
void write_session_seeds(const Seeds& seeds);
void write_session_datagram_seeds(const Seeds& seeds);
void write_file_seeds(const Seeds& seeds);

}  // namespace irdm::fuzz
