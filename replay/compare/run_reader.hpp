#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "common/hdf5/file.hpp"

namespace irdm::replay {

/// Frames that follow each other.
struct TimeInterval {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// The longest one in which all frames are marked; the first of equal ones.
TimeInterval longest_interval(const std::vector<bool>& marked);

/// Whether times are as far from each other everywhere, within a hundredth.
bool evenly_spaced(const std::vector<double>& times);

/// One object of a run at one frame.
struct RunPose {
  Vector3 position = Vector3::Zero();               ///< [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
};

/// A run file, read frame by frame: displacements may be many.
class RunReader {
 public:
  /// Throws Error when it is none.
  /// @param lag taken off the times of its frames [s]
  explicit RunReader(const std::filesystem::path& path, double lag = 0.0);

  const std::string& name() const { return file_.name(); }
  const std::vector<double>& times() const { return times_; }  ///< of the frames [s]
  const std::vector<std::string>& objects() const { return objects_; }
  std::size_t styluses() const { return styluses_; }
  const Points& rest(std::size_t object) const { return rest_[object]; }  ///< (n, 3) [m], B

  RunPose pose(std::size_t object, std::size_t frame) const;
  void displacement(std::size_t object, std::size_t frame, Points& u) const;  ///< (n, 3) [m], B
  Points node_displacement(std::size_t object, Eigen::Index node) const;  ///< (frames, 3) [m], B
  Vector3 force(std::size_t stylus, std::size_t frame) const;             ///< on the stylus [N], W

 private:
  void row(const std::string& set, std::size_t frame, const hdf5::Shape& row, double* values) const;

  hdf5::File file_;
  std::vector<double> times_;
  std::vector<std::string> objects_;
  std::vector<Points> rest_;
  std::size_t styluses_ = 0;
};

}  // namespace irdm::replay
