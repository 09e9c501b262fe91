#include "replay/compare/run_reader.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "replay/output/run_output.hpp"
#include "simulation/step/settings.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::replay {

TimeInterval longest_interval(const std::vector<bool>& marked) {
  TimeInterval longest;
  TimeInterval now;
  for (std::size_t k = 0; k < marked.size(); ++k) {
    now = marked[k] ? TimeInterval{now.count > 0 ? now.first : k, now.count + 1} : TimeInterval{};
    if (now.count > longest.count) longest = now;
  }
  return longest;
}

bool evenly_spaced(const std::vector<double>& times) {
  constexpr double kWithin = 0.01;
  if (times.size() < 2) return false;
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (std::abs(times[k] - times[k - 1] - mean) > kWithin * mean) return false;
  }
  return true;
}

namespace {

hdf5::File open_run(const std::filesystem::path& path) {
  hdf5::File file = hdf5::File::open(path);
  if (file.read_string_attribute("/", "format") != run::kFormat) {
    throw Error(path.string(), "is not a run file",
                "make one with irdm-replay TRACE.h5 --output RUN.h5");
  }
  if (file.read_integer_attribute("/", "version") != run::kVersion) {
    throw Error(path.string(), "is a run file of another version", "make it again");
  }
  return file;
}

std::size_t count(const hdf5::File& file, const std::string& name, int most) {
  const std::int64_t value = file.read_integer_attribute("/", name);
  if (value >= 1 && value <= most) return static_cast<std::size_t>(value);
  throw Error(file.name(), "says that it has " + std::to_string(value) + " " + name,
              "make it again");
}

// At least one.
hsize_t rows(const hdf5::File& file, const std::string& set, std::size_t rank) {
  const hdf5::Shape shape = file.stored_shape(set);
  if (shape.size() == rank && shape[0] > 0) return shape[0];
  throw Error(file.name(), set + " is empty or has not the right shape", "make it again");
}

}  // namespace

RunReader::RunReader(const std::filesystem::path& path, double lag) : file_(open_run(path)) {
  times_ = file_.read<double>("/time", {rows(file_, "/time", 1)});
  for (double& time : times_) time -= lag;
  styluses_ = count(file_, "styluses", kMaxStyluses);
  for (std::size_t i = 0; i < count(file_, "objects", kMaxObjects); ++i) {
    const std::string group = run::object_path(i);
    objects_.push_back(file_.read_string_attribute(group, "name"));
    const hsize_t nodes = rows(file_, group + "/rest", 2);
    const auto values = file_.read<double>(group + "/rest", {nodes, 3});
    rest_.push_back(Eigen::Map<const Points>(values.data(), static_cast<Eigen::Index>(nodes), 3));
  }
}

void RunReader::row(const std::string& set, std::size_t frame, const hdf5::Shape& row,
                    double* values) const {
  hdf5::Shape start(row.size() + 1, 0);
  start[0] = frame;
  hdf5::Shape extent{1};
  extent.insert(extent.end(), row.begin(), row.end());
  const hdf5::Shape shape = file_.shape(set);
  if (shape.size() != extent.size() || !std::equal(row.begin(), row.end(), shape.begin() + 1) ||
      shape[0] <= frame) {
    throw Error(file_.name(), set + " has not the right shape", "make it again");
  }
  file_.read_slab<double>(set, start, extent, values);
}

RunPose RunReader::pose(std::size_t object, std::size_t frame) const {
  RunPose pose;
  std::array<double, 4> q{};
  row(run::object_path(object) + "/position", frame, {3}, pose.position.data());
  row(run::object_path(object) + "/orientation", frame, {4}, q.data());
  pose.orientation = Quaternion(q[0], q[1], q[2], q[3]);
  return pose;
}

void RunReader::displacement(std::size_t object, std::size_t frame, Points& u) const {
  u.resize(rest_[object].rows(), 3);
  row(run::object_path(object) + "/displacement", frame, {static_cast<hsize_t>(u.rows()), 3},
      u.data());
}

Points RunReader::node_displacement(std::size_t object, Eigen::Index node) const {
  const std::string set = run::object_path(object) + "/displacement";
  const hdf5::Shape shape{times_.size(), static_cast<hsize_t>(rest_[object].rows()), 3};
  if (file_.shape(set) != shape || node < 0 || node >= rest_[object].rows()) {
    throw Error(file_.name(), set + " has not the right shape", "make it again");
  }
  Points u(static_cast<Eigen::Index>(times_.size()), 3);
  file_.read_slab<double>(set, {0, static_cast<hsize_t>(node), 0}, {times_.size(), 1, 3}, u.data());
  return u;
}

Vector3 RunReader::force(std::size_t stylus, std::size_t frame) const {
  Vector3 force;
  row(run::stylus_path(stylus) + "/force", frame, {3}, force.data());
  return force;
}

}  // namespace irdm::replay
