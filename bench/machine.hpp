#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/statistics.hpp"

namespace irdm::bench {

/// What the machine is: processor, cores, caches, memory and the instruction sets that matter here,
/// as a JSON object.
std::string machine_json();

/// How fast memory is read and written, with as many threads as OpenMP uses at the moment. The
/// arrays are far larger than any cache.
class Memory {
 public:
  /// @param bytes of each of the two arrays
  explicit Memory(std::size_t bytes);

  /// One pass that reads all of one array, and how many bytes that are.
  Elapsed read();
  double read_bytes() const { return static_cast<double>(a_.size() * sizeof(std::uint64_t)); }
  /// Bytes a second of the triad a[i] = b[i] + s c[i], counted as two reads and one write.
  double triad();

 private:
  std::vector<std::uint64_t> a_;
  std::vector<double> b_;
  std::uint64_t keep_ = 0;  ///< so that nothing is optimised away
};

}  // namespace irdm::bench
