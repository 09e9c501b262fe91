#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/model/model.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {

/// How long a fingertip takes to be pressed in, where the errors of force are found [s]: as fast as
/// a finger pokes, and no faster than ten steps resolve.
double press_time(double dt);

/// Steps of press_force(): twice the time of pressing in, the second half at rest.
int press_steps(double dt);

/// Force of a fingertip that is pressed in as (1 - cos(pi t / time)) / 2 and then stays, at each
/// step, per indentation [N/m].
/// @param response of the place to a force held during one step, press_steps(dt) of it [m/N]
Eigen::VectorXd press_force(const Eigen::VectorXd& response, double dt);

/// Largest difference of the two forces as a share of the largest force with `all`.
double press_error(const Eigen::VectorXd& all, const Eigen::VectorXd& found, double dt);

/// A round fingertip that presses straight down on the surface somewhere.
struct Fingertip {
  std::vector<int> nodes;       ///< surface nodes that it presses on
  std::vector<double> weights;  ///< shares of its force, sum 1
  Vector3 direction;            ///< into the body, unit length
};

/// Fingertips far from each other all over the surface, so that faces, edges and corners are among
/// them; none on clamped nodes as long as there are other places. The pressure falls as 1 - s^2
/// with the distance s from the middle, in units of the radius; where the mesh is too coarse for
/// that it is one node.
/// @param clamped into the mesh's nodes, increasing
std::vector<Fingertip> spread_fingertips(const ModelMesh& mesh, double radius, int count,
                                         const std::vector<int>& clamped);

/// Forces of 1 N under each fingertip on all nodes, (3N, k) [N].
Eigen::MatrixXd loads_of(const std::vector<Fingertip>& tips, const ModelMesh& mesh);

/// The fingertip's mean of a quantity of the surface's degrees of freedom, along its direction: of
/// each column of values (3n, k), (k).
Eigen::VectorXd mean_under(const Fingertip& tip, const Eigen::Ref<const Eigen::MatrixXd>& values);

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
