#pragma once

#include <array>
#include <memory>

#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// Two forms of one response side by side: both take in every force, one answers. So it can be
/// changed from one step to the next without anything to hand over. Costs the advance of both.
class BothEngines final : public ResponseEngine {
 public:
  /// Of different kinds, and of one model; the first one answers until use() says otherwise.
  BothEngines(std::unique_ptr<ResponseEngine> first, std::unique_ptr<ResponseEngine> second);

  bool supports_inertial_loading() const noexcept override;
  void set_angular_velocity(const Vector3& w) noexcept override;
  bool takes_gravity() const noexcept override;
  void set_gravity(const Vector3& gravity) noexcept override;
  EngineKind kind() const noexcept override { return engines_[answering_]->kind(); }
  const ResponseEngine& answering() const noexcept override { return *engines_[answering_]; }
  bool has_both_kinds() const noexcept override { return true; }
  void use(EngineKind kind) noexcept override;
  void prefetch(std::span<const Vector3> tips) noexcept override;
  std::uint64_t missed_columns() const noexcept override;
  Vector3 free_displacement(int node) const noexcept override {
    return engines_[answering_]->free_displacement(node);
  }
  double free_displacement_bound() const noexcept override {
    return engines_[answering_]->free_displacement_bound();
  }
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override {
    engines_[answering_]->predict(patches, h, compliance);
  }
  void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                       std::span<Vector3> path, std::span<Matrix3> response) noexcept override {
    engines_[answering_]->predict_horizon(patch, held, path, response);
  }
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept override;
  void cache_nodes(std::span<const int> nodes) noexcept override {
    engines_[answering_]->cache_nodes(nodes);
  }
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override {
    engines_[answering_]->displacement(u, tolerance);
  }
  Eigen::MatrixXd zero_lag_compliance() const override {
    return engines_[answering_]->zero_lag_compliance();
  }
  void reset() noexcept override;

 private:
  std::array<std::unique_ptr<ResponseEngine>, 2> engines_;
  std::size_t answering_ = 0;
};

}  // namespace irdm
