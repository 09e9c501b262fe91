#pragma once

#include <string>
#include <utility>
#include <vector>

#include "replay/compare/run_reader.hpp"

namespace irdm::replay {

/// How far one quantity of two runs is apart, over the frames that they have in common.
struct DifferenceSeries {
  std::vector<double> rms;      ///< of each frame: over nodes, or the difference itself
  std::vector<double> largest;  ///< the same: of the worst node
  double reference = 0.0;       ///< largest size in A; 0: none is meant

  /// Of all frames.
  double rms_over_time() const;
  double maximum() const;
  double last() const { return rms.empty() ? 0.0 : rms.back(); }  ///< of the last frame: the drift
  std::size_t worst_frame() const;                                ///< where maximum() is
};

struct ObjectComparison {
  std::string name;
  bool same_nodes = false;          ///< otherwise the next two are empty: the meshes differ
  DifferenceSeries displacement;    ///< of the nodes [m], B
  DifferenceSeries place;           ///< of the nodes [m], W
  DifferenceSeries centre_of_mass;  ///< [m], W
  DifferenceSeries orientation;     ///< angle between [rad]
  Eigen::Index node = 0;            ///< surface node that is displaced most in A, at any time
};

/// Frames of A and B that belong together.
using FramePairs = std::vector<std::pair<std::size_t, std::size_t>>;

struct Comparison {
  std::string a, b;
  FramePairs frames;
  std::vector<double> times;  ///< of the common frames [s]
  std::size_t alone = 0;      ///< frames of A and B that the other has not
  std::vector<ObjectComparison> objects;
  std::vector<DifferenceSeries> forces;  ///< of each stylus [N], W
};

/// Compares two runs of the same scene. Frames belong together whose times are the same within a
/// nanosecond. Throws Error when the runs have nothing in common.
Comparison compare_runs(const RunReader& a, const RunReader& b);

}  // namespace irdm::replay
