#pragma once

#include <hdf5.h>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/hdf5/free_space.hpp"
#include "common/hdf5/handle.hpp"

namespace irdm::hdf5 {

using Shape = std::vector<hsize_t>;

/// How a dataset of fixed shape lies in the file.
struct Layout {
  Shape chunk = {};         ///< of the dataset's rank; empty: contiguous, without filters
  bool fletcher32 = false;  ///< a checksum a chunk, compared on every read
};

/// Creation properties of a dataset of that layout. Nothing in a file tells when it was made: the
/// same content gives the same bytes.
Handle dataset_properties(const Layout& layout);

// Thin RAII over HDF5's C interface: what the model and the trace file need, nothing more. Every
// failure is an irdm::Error that names the file and the object. The library is not thread safe:
// each process calls it from one thread at a time (handle.hpp).

/// HDF5's name for a C++ number type: double, float, std::int16_t, std::int32_t, std::uint8_t
/// or std::uint64_t.
template <typename T>
hid_t native_type();

/// An open HDF5 file. Paths inside it are absolute ("/mesh/nodes"); missing groups are made on
/// write.
class File {
 public:
  /// Creates a file that must not exist yet. Throws Error, and leaves no file then.
  static File create(const std::filesystem::path& path);
  /// The same for a file that can be read while it is written, and after its writer was killed at
  /// any moment (HDF5's "single writer, multiple readers", of its format 1.10): once there are all
  /// datasets and attributes, and begin_swmr() was called.
  static File create_for_swmr(const std::filesystem::path& path);
  /// Opens a file for reading, also one whose writer is at work or was killed after begin_swmr().
  /// Throws Error when it is missing, no regular file, unreadable or not HDF5, and names the cause.
  static File open(const std::filesystem::path& path);
  /// A new file in memory, which image() turns into bytes; `name` is for messages.
  static File in_memory(const std::string& name);
  /// A file whose bytes are at hand, for reading. Throws Error when they are not HDF5.
  static File from_image(const std::string& image, const std::string& name);

  const std::string& name() const { return name_; }
  hid_t id() const { return file_.get(); }
  bool exists(const std::string& path) const;
  /// Whether an object that exists has such an attribute.
  bool has_attribute(const std::string& object, const std::string& name) const;

  void create_group(const std::string& path);
  /// From now on datasets only grow and are written, and HDF5 writes what points to something after
  /// that, so that the file on the disk is whole at any moment.
  void begin_swmr();
  void flush();
  /// Throws Error where a new file is no longer the one that its path names: it was removed,
  /// replaced or cut off since the last flush().
  void require_in_place() const;
  /// The bytes of the file as it would be on the disk.
  std::string image();
  /// Closes the file now and throws Error if what was buffered cannot be written.
  void close();

  void write_attribute(const std::string& object, const std::string& name,
                       const std::string& value);
  void write_attribute(const std::string& object, const std::string& name, double value);
  void write_attribute(const std::string& object, const std::string& name, std::int64_t value);
  void write_attribute(const std::string& object, const std::string& name, const Shape& shape,
                       const double* values);

  std::string read_string_attribute(const std::string& object, const std::string& name) const;
  /// Throws Error where an attribute that exists is not this text.
  void require_text(const std::string& object, const std::string& name,
                    const std::string& expected) const;
  double read_double_attribute(const std::string& object, const std::string& name) const;
  /// Throws Error, too, where the file has a number that is no integer.
  std::int64_t read_integer_attribute(const std::string& object, const std::string& name) const;
  /// Reads `count` doubles, whatever the attribute's shape.
  std::vector<double> read_doubles_attribute(const std::string& object, const std::string& name,
                                             std::size_t count) const;

  /// Shape of a dataset. Throws Error when there is none of that name.
  Shape shape(const std::string& dataset) const;
  /// The same for who makes room for all of it: throws Error, too, when the file holds so little
  /// of it that the shape cannot be meant. Looks at every chunk.
  Shape stored_shape(const std::string& dataset) const;
  /// Whether its numbers are integers in the file.
  bool stores_integers(const std::string& dataset) const;
  /// Bytes of one number of the dataset in the file.
  std::size_t element_size(const std::string& dataset) const;
  /// Whether its chunks go through a filter of HDF5.
  bool has_filter(const std::string& dataset, H5Z_filter_t filter) const;

  template <typename T>
  void write(const std::string& dataset, const Shape& shape, const T* values);
  /// Reads a whole dataset. Throws Error where its shape is not the expected one (0 stands for any
  /// extent), or where it holds integers and T is none, or the other way round.
  template <typename T>
  std::vector<T> read(const std::string& dataset, const Shape& expected) const;

  /// Makes a dataset of fixed shape without data, to be filled by write_slab.
  template <typename T>
  void create_dataset(const std::string& dataset, const Shape& shape, const Layout& layout = {});
  /// Writes or reads the box [start, start + count) of a dataset. Reading checks the kind of its
  /// numbers as read() does.
  template <typename T>
  void write_slab(const std::string& dataset, const Shape& start, const Shape& count,
                  const T* values);
  template <typename T>
  void read_slab(const std::string& dataset, const Shape& start, const Shape& count,
                 T* values) const;

  /// Makes a dataset that is empty along its first axis and grows by append; `row` is the rest of
  /// its shape (empty for a plain list).
  template <typename T>
  void create_growing(const std::string& dataset, const Shape& row, hsize_t chunk_rows);
  /// Throws Error when there is no room for the rows; then the file is as it was, can be flushed
  /// and closed, and needs no more room for that. Where the file system cannot keep room free this
  /// holds as far as HDF5 itself can do without.
  template <typename T>
  void append(const std::string& dataset, hsize_t rows, const T* values);

 private:
  File(Handle file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  static File create(const std::filesystem::path& path, const Handle& access);
  void reserve_for(const Handle& dataset, hsize_t rows, hsize_t more);
  [[noreturn]] void fail_read(const std::string& what) const;
  [[noreturn]] void fail_write(const std::string& what) const;
  /// Throws Error about data that lie outside the file.
  [[noreturn]] void fail_foreign(const std::string& what) const;
  /// Throws Error when a part of the path is a link to another file.
  void check_links(const std::string& path) const;
  Handle open_object(const std::string& path) const;
  Handle open_dataset(const std::string& path) const;
  void check_kind(const std::string& dataset, hid_t wanted) const;
  Handle make_dataset(const std::string& path, hid_t type, hid_t space, const Handle& creation);
  void read_numbers(const std::string& object, const std::string& name, hid_t type,
                    std::size_t count, void* values) const;
  void write_numbers(const std::string& object, const std::string& name, hid_t type,
                     const Shape& shape, const void* values);
  void transfer_slab(const std::string& dataset, const Shape& start, const Shape& count, hid_t type,
                     const void* source, void* target) const;

  Handle file_;
  std::string name_;
  std::optional<ReservedSpace> reserved_ = {};  ///< of a new file on the disk
  std::optional<WatchedPlace> place_ = {};      ///< of the same
};

}  // namespace irdm::hdf5
