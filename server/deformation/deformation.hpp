#pragma once

#include <memory>

#include "server/engine/response_engine.hpp"
#include "server/step/step_record.hpp"

namespace irdm {

/// The deformed object at the end of a step.
struct SurfaceFrame {
  std::uint64_t force_step = 0;
  double time = 0.0;                                ///< [s]
  Vector3 position = Vector3::Zero();               ///< of the body [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
  Points displacement;                              ///< u (n, 3) [m], B

  /// x_i = c + Q (X_i + u_i) [m], W.
  Vector3 world(const ModelMesh& mesh, int node) const {
    return position +
           orientation * (mesh.rest_position(node) + Vector3(displacement.row(node).transpose()));
  }
};

/// Follows the force thread's steps with an engine of its own. Because an engine's state depends on
/// nothing but the forces, the two always agree, and nobody has to wait for a snapshot. Pure; one
/// thread.
class Deformation {
 public:
  explicit Deformation(std::shared_ptr<const Model> model);

  /// Takes in the next step. Steps that were lost on the way are taken to have had the forces of
  /// the one before them; how many, is counted.
  void follow(const StepRecord& record);

  /// Displacements of all nodes after the last step taken in (OpenMP).
  void compute(SurfaceFrame& frame) const;

  std::uint64_t lost_steps() const noexcept { return lost_steps_; }

 private:
  std::shared_ptr<const Model> model_;
  std::unique_ptr<ResponseEngine> engine_;
  StepRecord last_;
  bool started_ = false;
  std::uint64_t lost_steps_ = 0;
};

}  // namespace irdm
