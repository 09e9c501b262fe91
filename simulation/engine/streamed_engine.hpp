#pragma once

#include <cstdint>
#include <vector>

#include "simulation/engine/dense_load.hpp"
#include "simulation/engine/pinned_columns.hpp"
#include "simulation/engine/prediction_cache.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The dense engine on a response whose columns come and go (StreamedResponse, PinnedColumns). With
/// all of them there in time it equals DenseEngine to the bit.
///
/// Where they are not, forces on the node are answered by the static answer
/// (common/response/modal_response.hpp) in place of R: R[0] in their own step, then a settling
/// without vibration to the same lasting displacement. When the columns come, the node's answer
/// goes over from the one to the other, both to all of its forces.
template <typename Scalar>
class StreamedEngine final : public ResponseEngine,
                             public InertialLoading,
                             public GravityLoading,
                             public ColumnStreaming,
                             public PredictionCaching {
 public:
  /// @param model holds a StreamedResponse of type Scalar, with columns
  explicit StreamedEngine(std::shared_ptr<const Model> model);

  EngineCapabilities capabilities() noexcept override {
    return {.inertial_loading = spin_.any() ? this : nullptr,
            .gravity = gravity_.any() ? this : nullptr,
            .columns = this,
            .caching = this};
  }
  void set_angular_velocity(const Vector3& w) noexcept override { spin_.hold(spin_products(w)); }
  void set_gravity(const Vector3& gravity) noexcept override { gravity_.set(gravity); }
  void prefetch(std::span<const Vector3> tips) noexcept override {
    response_.columns->prefetch(tips);
  }
  std::uint64_t cache_misses() const noexcept override { return columns_.missed(); }
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
  /// Part of what forces on degree of freedom b do by the static answer, for all nodes alike.
  struct Settled {
    std::size_t column = 0;
    double newest = 0.0;  ///< of R[0] [N]
    double past = 0.0;    ///< of what follows it [N]
  };

  void settle() noexcept;
  Settled settled(int source, int axis, int shift) const noexcept;
  void add_lacking(int node, int shift, Vector3& u) const noexcept;
  void add_columns(Points& u) const;

  double first(int a, int b) const noexcept;
  double rest(int a, int b) const noexcept;
  double entry(std::size_t step, int a, int b) const noexcept;

  std::shared_ptr<const Model> model_;
  const StreamedResponse& response_;
  const Scalar* first_;  ///< R[0]
  PinnedColumns<Scalar> columns_;
  CachedConvolution<PinnedColumns<Scalar>> past_;
  DenseSpin<Scalar> spin_;
  DenseGravity<Scalar> gravity_;
  std::vector<Settled> coming_;  ///< settled(node, axis, 1), of nodes with a past that lack a share
};

}  // namespace irdm
