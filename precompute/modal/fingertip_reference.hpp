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

  /// @param model must outlive this object
  /// @param clamped into the mesh's nodes, increasing
  FingertipReference(const ElasticStatics& statics, const Model& model, double contact_radius,
                     const std::vector<int>& clamped);

  int samples() const { return static_cast<int>(tips_.size()); }

  /// Errors of the modes with the residual compliance that they have.
  /// @param modes with shapes in double precision
  ReductionError error(const ModalResponse& modes) const;

  /// Error of force with the whole of the residual compliance that goes with the modes, before it
  /// is known.
  /// @param modes with shapes in double precision
  double expected_force_error(const ModalResponse& modes) const;

 private:
  const Model& model_;
  std::vector<Fingertip> tips_;
  Eigen::MatrixXd settled_;                ///< surface under a force that stays, (3n, k) [m/N]
  std::vector<Eigen::VectorXd> response_;  ///< of each fingertip's place [m/N]
};

}  // namespace irdm::precompute
