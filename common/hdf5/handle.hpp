#pragma once

#include <hdf5.h>
#include <mutex>
#include <utility>

namespace irdm::hdf5 {

/// Held by whoever uses the library while other threads may: it is not thread safe. Never by a
/// real-time thread.
inline std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Keeps HDF5 from printing errors of its own, in the calling thread only. File::create() and
/// File::open() do it for theirs; another thread that uses a file calls it first.
void prepare_library();

/// Keeps HDF5 from closing files at the end of the program: its own closing would crash on a file
/// whose closing failed because the disk is full. First call of a program's main, never of a
/// library: the files that a host program left open would be lost.
void leave_files_at_exit();

/// Owns one HDF5 identifier and closes it with the function that its kind asks for.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) closer_(id_);
  }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  Closer closer_ = nullptr;
};

}  // namespace irdm::hdf5
