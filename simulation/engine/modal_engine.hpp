#pragma once

#include "simulation/engine/active_modes.hpp"
#include "simulation/engine/contact_shapes.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/modal_gravity.hpp"
#include "simulation/engine/modal_horizon.hpp"
#include "simulation/engine/residual_part.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// R in modal form: every mode is a damped oscillator whose exact held-force transition is applied
/// once a step. No history is needed; contacts cost nothing after they end. Modes that the model
/// leaves out answer without delay, as far as it says how (ResidualPart).
/// Large: one array for each coefficient of a mode, so that loops over modes run along memory.
template <typename Scalar>
class ModalEngine final : public ResponseEngine,
                          public InertialLoading,
                          public GravityLoading,
                          public MaterialDamping,
                          public SharedSurface {
 public:
  /// @param model holds a ModalResponse with shapes of type Scalar
  explicit ModalEngine(std::shared_ptr<const Model> model);

  EngineCapabilities capabilities() noexcept override {
    return {.inertial_loading = centrifugal_ != nullptr ? this : nullptr,
            .gravity = gravity_.any() ? this : nullptr,
            .damping = this};
  }
  void set_gravity(const Vector3& gravity) noexcept override;
  void scale_damping(double factor) noexcept override;
  void set_angular_velocity(const Vector3& w) noexcept override;
  Vector3 free_displacement(int node) const noexcept override;
  double free_displacement_bound() const noexcept override;
  double free_change_bound() const noexcept override;
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                       std::span<Vector3> path, std::span<Matrix3> response) noexcept override;
  void cross_response(const ContactPatch& to, const ContactPatch& from,
                      std::span<Matrix3> response) noexcept override;
  bool keeps_response(const ContactPatch& patch, std::size_t steps) const noexcept override {
    return horizon_.keeps_response(patch, steps);
  }
  void prepare_response(const ContactPatch& patch, std::size_t steps) noexcept override {
    horizon_.find_response(horizon_contact(patch), steps);
  }
  bool keeps_cross_response(const ContactPatch& to, const ContactPatch& from,
                            std::size_t steps) const noexcept override {
    return horizon_.keeps_cross_response(to, from, steps);
  }
  bool keeps_horizon(const ContactPatch& patch, std::size_t steps) const noexcept override {
    return horizon_.keeps(patch, state_, steps);
  }
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept override;
  std::optional<EnergyChange> energy_change(std::span<const NodalForce> forces,
                                            int age) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override {
    const SurfaceRequest request{this, tolerance, &u};
    displacements({&request, 1});
  }
  void displacements(std::span<const SurfaceRequest> requests) const override;
  const void* shared_surface() const noexcept override { return shapes_; }
  void reset() noexcept override;
  void archive(StateArchive& state) override;
  double energy() const noexcept override;

 private:
  void set_transitions(double damping) noexcept;
  void tabulate_delayed() noexcept;
  void change_state() noexcept;
  void move_on() noexcept;
  void add_gravity() noexcept;
  void settle() noexcept;
  void go_on() noexcept;
  ModalHorizon::Contact& horizon_contact(const ContactPatch& patch) noexcept;
  void hold(std::span<const NodalForce> forces) noexcept;
  void collect_modal_forces(std::span<const NodalForce> forces, const ModeRange& modes,
                            double* modal) const noexcept;
  const Scalar* shape_row(int dof) const noexcept {
    return shapes_->data() + static_cast<std::size_t>(dof) * modes_;
  }

  std::shared_ptr<const Model> model_;
  const RowMatrix<Scalar>* shapes_;  ///< Phi (3n, r)
  ContactShapes<Scalar> contact_shapes_;
  const double* centrifugal_ = nullptr;  ///< g (r, 6); null: the model has none
  std::size_t modes_;                    ///< r
  AlignedNumbers largest_shape_;         ///< (r) max_a |Phi_ai|
  // Transition of each mode over one step, one array a coefficient.
  AlignedNumbers a11_, a12_, a21_, a22_, b1_, b2_;
  AlignedNumbers coordinate_, velocity_;  ///< at the end of the last step
  /// At the end of the coming step, no force but those of the held spin and of gravity.
  AlignedNumbers free_coordinate_, free_velocity_;
  AlignedNumbers modal_force_;
  /// (kMaxHorizon, r): coordinate and velocity of each mode at the end of the n-th step after the
  /// one in which a modal force of 1 acted.
  AlignedNumbers coordinate_after_, velocity_after_;
  AlignedNumbers held_force_;     ///< (r), of predict_horizon()
  std::vector<NodalForce> held_;  ///< that it is of; empty: not known
  AlignedNumbers inertial_load_;  ///< (r), of the coming step
  bool loaded_ = false;           ///< inertial_load_ means something
  bool was_loaded_ = false;       ///< in the last step
  bool forced_ = false;      ///< modal_force_ is all that acted in the last step; else nothing did
  std::uint64_t state_ = 2;  ///< ModalHorizon::State::number
  ModalHorizon horizon_;
  const ModalHorizon::Contact* only_ = nullptr;  ///< ModalHorizon::State::only
  Vector3 only_force_ = Vector3::Zero();
  ResidualPart residual_;
  ModalGravity gravity_;
  bool begun_ = false;  ///< there was a step, or a late force, since the reset
};

}  // namespace irdm
