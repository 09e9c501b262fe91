#pragma once

#include <span>
#include <vector>

#include "common/model/model.hpp"
#include "simulation/contact/ball_samples.hpp"

namespace irdm {

/// The low-pass filtered Green's function of the elastic half space. Under a normal point force of
/// 1 N the surface moves by 1 / (pi E* r) (Boussinesq); a low pass of length sigma turns this into
/// g(r / sigma) / (pi E* sigma), where
/// g(x) = integral over k from 0 to infinity of exp(-k^p) J0(k x).
/// This class tabulates g. Real-time safe, from any thread.
class LowPass {
 public:
  /// Returns the function for finite elements of an order: p = 2 for linear, p = 3 for quadratic
  /// elements, about the rate at which their energy converges.
  /// @param order 1 or 2
  static const LowPass& of_order(int order);

  double operator()(double x) const noexcept {
    const double place = x * kStepsPerUnit;
    const auto i = static_cast<std::size_t>(place);
    if (i + 1 >= values_.size()) return far(x);
    const double part = place - static_cast<double>(i);
    return (1.0 - part) * values_[i] + part * values_[i + 1];
  }
  double at_zero() const noexcept { return values_.front(); }

 private:
  static constexpr double kStepsPerUnit = 50.0;

  explicit LowPass(int power);
  double far(double x) const noexcept;

  int power_;
  std::vector<double> values_;  ///< at 0, 1 / kStepsPerUnit, 2 / kStepsPerUnit, ...
};

/// The part of the surface compliance that a finite element mesh is too coarse to represent near a
/// small contact: the half space as the samples resolve it less the half space as the mesh resolves
/// it (docs/theory.md, "Balls against soft bodies"). It is a massless compliance between samples,
/// along their outward normals at rest. It is positive semidefinite on a plane, vanishes where the
/// mesh is as fine as the samples, and reaches about two element edges. Immutable.
class NearField {
 public:
  /// @param static_limit static compliance of the surface nodes, (3n, 3n) [m/N], B
  /// @param samples the samples for balls of one radius
  NearField(const Model& model, const Eigen::MatrixXd& static_limit,
            std::span<const BallSample> samples);

  /// Returns the displacement of sample i along its normal per force on sample j along the normal
  /// of
  /// j [m/N]. Real-time safe, from any thread.
  double between(int i, int j) const noexcept;
  /// Returns the length of the low pass that describes the mesh at a sample [m].
  double mesh_length(int i) const noexcept {
    return 1.0 / places_[static_cast<std::size_t>(i)].per_mesh_length;
  }

 private:
  struct Place {
    Vector3 position;          ///< [m], B
    double per_sample_length;  ///< 1 over the length of the sample's low pass [1/m]
    double per_mesh_length;    ///< 1 over the length of the mesh's, which is not shorter [1/m]
    double scale;              ///< 1 / sqrt(pi E*) of the material there [1/sqrt(Pa)]
  };

  const LowPass* low_pass_;
  std::vector<Place> places_;
};

}  // namespace irdm
