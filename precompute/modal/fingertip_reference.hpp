#pragma once

#include <vector>

#include "common/model/model.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/fingertip.hpp"

namespace irdm::precompute {

/// Of force and of shape under a fingertip, see ModeReduction.
struct ReductionError {
  double force = 0.0;
  double shape = 0.0;
};

/// What all modes say under some fingertips, without the modes: static solves, and the response of
/// each fingertip's place from its driving spectrum. Parts of the modes are held against it.
class FingertipReference {
 public:
  static constexpr int kSamples = 8;

  /// @param clamped into the mesh's nodes, increasing
  FingertipReference(const ElasticStatics& statics, const Model& model, double contact_radius,
                     double residual_radius, const std::vector<int>& clamped);

  int samples() const { return static_cast<int>(tips_.size()); }

  /// Errors of the modes as they are, with the residual compliance that they have.
  ReductionError error(const ModalResponse& modes) const;

  /// For r = 1..count at place r - 1: errors with the lowest r modes and the residual compliance
  /// that goes with them. Shape is a bound: where a node is not near all nodes under the fingertip,
  /// nothing of its residual counts.
  /// @param modes with shapes in double precision, without residual
  std::vector<ReductionError> errors_by_count(const ModalResponse& modes) const;

 private:
  std::vector<bool> near_all(const Fingertip& tip) const;
  void add_errors(const ModalResponse& modes, Eigen::Index tip,
                  std::vector<ReductionError>& errors) const;

  const Model& model_;
  double residual_radius_;
  std::vector<Fingertip> tips_;
  Eigen::MatrixXd settled_;                ///< surface under a force that stays, (3n, k) [m/N]
  std::vector<Eigen::VectorXd> response_;  ///< of each fingertip's place [m/N]
};

}  // namespace irdm::precompute
