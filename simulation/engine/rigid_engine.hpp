#pragma once

#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The answer of a rigid body to forces on its surface: none. R is zero, and so is every
/// displacement.
class RigidEngine final : public ResponseEngine {
 public:
  /// @param surface_nodes n of the model
  explicit RigidEngine(int surface_nodes) : surface_nodes_(surface_nodes) {}

  Vector3 free_displacement(int node) const noexcept override;
  double free_displacement_bound() const noexcept override { return 0.0; }
  double free_change_bound() const noexcept override { return 0.0; }
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                       std::span<Vector3> path, std::span<Matrix3> response) noexcept override;
  void cross_response(const ContactPatch& to, const ContactPatch& from,
                      std::span<Matrix3> response) noexcept override;
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override;
  void reset() noexcept override {}
  void archive(StateArchive& /*state*/) override {}
  double energy() const noexcept override { return 0.0; }

 private:
  int surface_nodes_;
};

}  // namespace irdm
