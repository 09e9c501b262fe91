#pragma once

#include "simulation/engine/dense_load.hpp"
#include "simulation/engine/prediction_cache.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The paper's engine: R itself and the convolution with the last T steps of forces, equation (10).
/// Works for any linear response, wherever it came from. What happened more than T steps ago is
/// forgotten.
template <typename Scalar>
class DenseEngine final : public ResponseEngine,
                          public InertialLoading,
                          public GravityLoading,
                          public PredictionCaching {
 public:
  /// @param model holds a DenseResponse of type Scalar
  explicit DenseEngine(std::shared_ptr<const Model> model);

  EngineCapabilities capabilities() noexcept override {
    return {.inertial_loading = spin_.any() ? this : nullptr,
            .gravity = gravity_.any() ? this : nullptr,
            .caching = this};
  }
  void set_angular_velocity(const Vector3& w) noexcept override { spin_.hold(spin_products(w)); }
  void set_gravity(const Vector3& gravity) noexcept override { gravity_.set(gravity); }
  Vector3 free_displacement(int node) const noexcept override;
  double free_displacement_bound() const noexcept override;
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void cross_response(const ContactPatch& to, const ContactPatch& from,
                      std::span<Matrix3> response) noexcept override;
  void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                       std::span<Vector3> path, std::span<Matrix3> response) noexcept override;
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept override;
  void cache_nodes(std::span<const int> nodes) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override;
  void reset() noexcept override;
  void archive(StateArchive& state) override;

 private:
  /// The answer of a to b `step` steps after the one in which b acted.
  template <typename From>
  auto after(std::size_t step, const ContactPatch& a, const From& b) const noexcept;
  /// R[step](a, b).
  double entry(std::size_t step, int a, int b) const noexcept;

  std::shared_ptr<const Model> model_;
  ResidentColumns<Scalar> R_;
  CachedConvolution<ResidentColumns<Scalar>> past_;
  DenseSpin<Scalar> spin_;
  DenseGravity<Scalar> gravity_;
};

}  // namespace irdm
