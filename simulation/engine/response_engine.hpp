#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "common/contact/contact_model.hpp"
#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "simulation/contact/contact_patch.hpp"

namespace irdm {

/// What a share s of a force adds to an energy: s along + s^2 own [J].
struct EnergyChange {
  double along = 0.0;
  double own = 0.0;
};

/// Force on one surface node during one step [N], B.
struct NodalForce {
  int node = 0;
  Vector3 force = Vector3::Zero();
};

class ResponseEngine;
class StateArchive;

/// The displacements of one engine's nodes are wanted.
struct SurfaceRequest {
  const ResponseEngine* engine = nullptr;
  double tolerance = 0.0;  ///< as that of ResponseEngine::displacement()
  Points* u = nullptr;     ///< (n, 3), written [m]
};

/// The body's own spin loads it.
class InertialLoading {
 public:
  virtual ~InertialLoading() = default;
  /// The body turns with w [rad/s], B, throughout the coming step: its centrifugal load acts
  /// besides the forces. Before all else that is asked about the step, at most once a step; without
  /// it there is no such load. Real-time safe.
  virtual void set_angular_velocity(const Vector3& w) noexcept = 0;
};

/// Gravity bends a fixed body, which it cannot move as a whole.
class GravityLoading {
 public:
  virtual ~GravityLoading() = default;
  /// From the coming step on gravity accelerates every part of the body, in magnitude and direction
  /// [m/s^2], B; before all else that is asked about the step. It swings to where it is at rest
  /// under that, or is there at once if there was no step since the start or the last reset(). At
  /// the start there is none. Real-time safe.
  virtual void set_gravity(const Vector3& gravity) noexcept = 0;
};

/// The damping of the material can be changed while it runs.
class MaterialDamping {
 public:
  virtual ~MaterialDamping() = default;
  /// From the coming step on the material's damping is `factor` > 0 times that of the model; before
  /// all else that is asked about the step. Real-time safe.
  virtual void scale_damping(double factor) noexcept = 0;
};

/// The columns of R come and go.
class ColumnStreaming {
 public:
  virtual ~ColumnStreaming() = default;
  /// Tips are here, and what they may touch soon is better fetched now; of one engine of a model
  /// only. Real-time safe. @param tips at most kMaxStyluses [m], B
  virtual void prefetch(std::span<const Vector3> tips) noexcept = 0;
  /// Nodes that forces began to act on while their columns of R were not there.
  virtual std::uint64_t cache_misses() const noexcept = 0;
};

/// What nodes will do can be kept ready from step to step.
class PredictionCaching {
 public:
  virtual ~PredictionCaching() = default;
  /// These nodes were asked for in the coming step, and may well be in the one after it. Before
  /// advance(); any number of times. Real-time safe.
  virtual void cache_nodes(std::span<const int> nodes) noexcept = 0;
};

/// The displacements of several engines are found together.
class SharedSurface {
 public:
  virtual ~SharedSurface() = default;
  /// What is read once for all engines that have the same.
  virtual const void* shared_surface() const noexcept = 0;
  /// ResponseEngine::displacement() of engines with one shared_surface(), to the bit. Uses OpenMP.
  virtual void displacements(std::span<const SurfaceRequest> requests) const = 0;
};

/// What only some engines can do; null: this one cannot.
struct EngineCapabilities {
  InertialLoading* inertial_loading = nullptr;
  GravityLoading* gravity = nullptr;
  MaterialDamping* damping = nullptr;
  ColumnStreaming* columns = nullptr;
  PredictionCaching* caching = nullptr;
};

/// The elastic answer of one object to the history of forces on its surface nodes, equation (10):
/// u[k] = sum_s R[s] f[k-s]. Everything is in B. An engine has one state and belongs to one thread;
/// several engines may share the same model. All members but the constructor and
/// displacement() are real-time safe, and what they cost does not depend on the number of nodes.
class ResponseEngine {
 public:
  virtual ~ResponseEngine() = default;

  /// As long as the engine lives.
  virtual EngineCapabilities capabilities() noexcept { return {}; }

  /// Displacement of a node at the end of the coming step if no force acts during it [m].
  virtual Vector3 free_displacement(int node) const noexcept = 0;
  /// What no component of any node's is larger than in magnitude [m], where that takes no longer
  /// than a node or two; otherwise infinite.
  virtual double free_displacement_bound() const noexcept = 0;

  /// By what no component of any node's free displacement was changed by the last advance() [m],
  /// where that takes no longer than a node or two; otherwise infinite. Nothing else has changed it
  /// since.
  virtual double free_change_bound() const noexcept {
    return std::numeric_limits<double>::infinity();
  }

  /// For contacts a = 0..m-1 (m <= kMaxContacts): their mean free displacement h_a at the end of
  /// the coming step [m], and the compliance between them within it, the blocks sum_ij w_i w_j
  /// R_ij[0] of the (3m, 3m) matrix [m/N].
  virtual void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                       ContactMatrix& compliance) noexcept = 0;

  /// For one contact, the next path.size() = response.size() steps (kMaxHorizon at most): where the
  /// mean displacement goes, path[n-1] at the end of the n-th coming step [m], if these forces are
  /// held all the time and no others act; and how it answers, response[n] the blocks sum_ij w_i w_j
  /// R_ij[n] [m/N]. Spin that is held acts in the coming step only.
  virtual void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                               std::span<Vector3> path, std::span<Matrix3> response) noexcept = 0;
  /// How one contact answers a force on another in the next response.size() steps (kMaxHorizon at
  /// most): response[n] the blocks sum_ij w_i w_j R_ij[n] of nodes i of `to` per force on nodes j
  /// of `from` [m/N].
  virtual void cross_response(const ContactPatch& to, const ContactPatch& from,
                              std::span<Matrix3> response) noexcept = 0;

  // What of that is kept from before takes little work.
  /// Whether predict_horizon() would find path and response.
  virtual bool keeps_horizon(const ContactPatch&, std::size_t /*steps*/) const noexcept {
    return true;
  }
  /// Whether it would find the response. If not, prepare_response() finds that alone.
  virtual bool keeps_response(const ContactPatch&, std::size_t /*steps*/) const noexcept {
    return true;
  }
  virtual void prepare_response(const ContactPatch&, std::size_t /*steps*/) noexcept {}
  /// Whether cross_response() would find all.
  virtual bool keeps_cross_response(const ContactPatch&, const ContactPatch&,
                                    std::size_t /*steps*/) const noexcept {
    return true;
  }

  /// These forces were held, besides the others, during the step `age` steps before the last one
  /// (0: the last one itself). @param age below kMaxHorizon; what is older is left out
  virtual void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept = 0;

  /// By what a share of forces that are held in one step would change energy(), where the response
  /// says so; otherwise nothing.
  /// @param age of the step, as for add_delayed_force(); -1: the coming one, at its end
  virtual std::optional<EnergyChange> energy_change(std::span<const NodalForce> /*forces*/,
                                                    int /*age*/) noexcept {
    return std::nullopt;
  }
  /// Ends the coming step with these forces held during it.
  virtual void advance(std::span<const NodalForce> forces) noexcept = 0;

  /// Displacement of all nodes at the end of the last step, shape (n, 3) [m]. Uses OpenMP; the
  /// result does not depend on the number of threads. Not for the force thread.
  /// @param tolerance by how much each component may be off, so that less has to be read [m], >= 0
  virtual void displacement(Points& u, double tolerance) const = 0;
  void displacement(Points& u) const { displacement(u, 0.0); }

  /// Forgets all forces: at rest under gravity as it is.
  virtual void reset() noexcept = 0;

  /// State, in or out, but for settings. Throws Error where it depends on what is in memory
  /// (ColumnStreaming). Not real-time safe.
  virtual void archive(StateArchive& state) = 0;
  /// Elastic and kinetic energy of the deformation at the end of the last step, with the potential
  /// of gravity on a fixed body [J], where the response says so; otherwise NaN. Real-time safe.
  virtual double energy() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }
};

/// Makes an engine on a model that holds the response it needs. Throws Error when it does not.
std::unique_ptr<ResponseEngine> make_engine(std::shared_ptr<const Model> model);

/// ResponseEngine::displacement() of each, to the bit: where engines share their model's shapes as
/// one matrix product. The requests come back in another order.
void displacements(std::span<SurfaceRequest> requests);

/// The point's value of a quantity that is known at nodes: sum_i w_i value(node_i); nodes of no
/// weight are not asked for.
template <typename NodeValue>
Vector3 interpolate(const SurfacePoint& point, const NodeValue& value) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    if (point.weights[i] != 0.0) sum += point.weights[i] * value(point.nodes[i]);
  }
  return sum;
}

}  // namespace irdm
