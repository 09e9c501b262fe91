#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "common/hdf5/file.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// The blocks of a ResidualCompliance on and above the diagonal: as it is computed, and as a file
/// has it.
struct UpperBlocks {
  using Block = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

  std::vector<std::int32_t> row_start = {0};  ///< (n + 1)
  std::vector<std::int32_t> nodes;  ///< of each block, increasing within a row from its own
  std::vector<float> blocks;        ///< 9 a block, rows first [m/N]

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  /// visit(row, column, block), in order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (int i = 0; i < rows(); ++i) {
      for (int k = row_start[static_cast<std::size_t>(i)];
           k < row_start[static_cast<std::size_t>(i) + 1]; ++k) {
        const auto place = static_cast<std::size_t>(k);
        visit(i, nodes[place], Eigen::Map<const Block>(blocks.data() + 9 * place));
      }
    }
  }
};

UpperBlocks upper_half(const ResidualCompliance& all);

/// The whole of it; its `reduction` is not filled.
ResidualCompliance both_halves(const UpperBlocks& upper);

// Dense R in a model file (docs/files.md).

/// Reads all of it and checks shapes and numbers. Throws Error.
/// @param model its description
DenseResponse read_dense(const hdf5::File& file, const Model& model);

/// Reads all of it once, column by column, and keeps what is always needed; `columns` is left
/// empty. Throws Error.
StreamedResponse read_streamed(const hdf5::File& file, const Model& model);

/// Throws Error where the file has R in a form that is not read: half precision, or compressed by
/// zfp.
void check_dense_form(const hdf5::File& file);

/// Bytes of one number of R, and of what read_streamed() keeps.
std::size_t number_size(const StreamedResponse& response);
std::size_t resident_bytes(const StreamedResponse& response);

/// Reads columns of R one by one while a program runs. One thread; holds hdf5::library_mutex().
class DenseColumnFile {
 public:
  /// Of a file that read_streamed() has read. Throws Error.
  DenseColumnFile(const std::filesystem::path& path, const StreamedResponse& response);
  DenseColumnFile(const DenseColumnFile&) = delete;
  DenseColumnFile& operator=(const DenseColumnFile&) = delete;
  ~DenseColumnFile();

  /// The three columns of a surface node, as a ColumnSupply has them. Throws Error, also when they
  /// are not what they were: HDF5 reads zeros where a file has been cut off.
  /// @param to 3 * 3n * T numbers of number_size()
  void read(int node, void* to);

 private:
  template <typename Scalar>
  void read_as(int node, Scalar* to);

  hdf5::File file_;
  hsize_t dof_;
  hsize_t steps_;
  std::size_t number_size_;
  std::vector<std::uint64_t> fingerprints_;
  std::vector<std::byte> column_;  ///< one, as it stands in the file
};

}  // namespace irdm
