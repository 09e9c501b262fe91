#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// A record that is long enough to stand for one without end.
struct RecordLength {
  int steps;
  /// Of the circle that counts as the unit circle: what lies beyond the record weighs less than
  /// 1e-9 on it. 1 unless the modes hardly decay.
  double radius;
};
RecordLength record_length(const ModalResponse& response, double dt);
RecordLength record_length(const CompressedResponse& response);

}  // namespace irdm::precompute
