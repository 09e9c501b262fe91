#pragma once

#include <variant>
#include <vector>

#include "common/response/modal_response.hpp"
#include "simulation/engine/prediction_cache.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {

/// What a load on the whole body adds to a dense response: its kCount numbers, of every step, act
/// as if they were forces on nodes, three on each, with a column of its own for each. Real-time
/// safe but for displacement(); one thread.
template <typename Number, int kCount>
class DenseLoad {
 public:
  using Values = std::variant<std::vector<float>, std::vector<double>>;
  using Numbers = Eigen::Matrix<double, kCount, 1>;

  /// @param values in the order of DenseResponse, numbers of this type; empty: the model has none,
  /// and nothing is ever added
  DenseLoad(const Values& values, int dof, int steps);

  bool any() const noexcept { return columns_.values != nullptr; }
  /// Nothing is added: nothing is held, and nothing was within the last T steps.
  bool at_rest() const noexcept { return past_.history().active().empty() && coming_.isZero(0.0); }
  /// Held throughout the coming step.
  void hold(const Numbers& numbers) noexcept {
    if (any()) coming_ = numbers;
  }
  /// Adds what a node does at the end of the coming step, with what is held.
  void add_coming(int node, Vector3& u) const noexcept;
  /// The same at the end of the n-th coming step, of the steps until now alone.
  void add_ahead(int node, int n, Vector3& u) const noexcept;
  /// Adds what is held alone does to a node at the end of the n-th coming step.
  void add_held(int node, int n, Vector3& u) const noexcept;
  /// As CachedConvolution's.
  void cache_node(int node) noexcept;
  void predict_horizon(int node, int n) noexcept;
  /// Adds the displacement of all nodes at the end of the last step.
  void add_all(Points& u) const {
    if (any()) columns_.add_all(past_.history(), u);
  }
  void advance() noexcept;
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state) {
    past_.archive(state);
    state.value(coming_);
  }

 private:
  static_assert(kCount % 3 == 0);

  ResidentColumns<Number> columns_;
  CachedConvolution<ResidentColumns<Number>> past_;
  Numbers coming_ = Numbers::Zero();
};

/// The products of the components of the body's own spin.
template <typename Number>
using DenseSpin = DenseLoad<Number, kSpinProducts>;

/// What gravity adds to a dense response: the sag that it leads to, and the way there from each
/// change of it. As long as it stays what it is nothing is summed up. Real-time safe but for
/// add_all(); one thread.
template <typename Number>
class DenseGravity final {
 public:
  /// @param response must outlive this object; with numbers of this type, or empty: nothing is ever
  /// added
  DenseGravity(const GravityResponse& response, int dof, int steps);

  bool any() const noexcept { return !response_.empty(); }
  /// Only the sag is added: it did not change within the last T steps.
  bool steady() const noexcept { return changes_.at_rest(); }
  /// What no component of any node's sag is larger than in magnitude [m].
  double sag_bound() const noexcept { return largest_sag_.dot(coming_.cwiseAbs()); }
  /// From the coming step on [m/s^2], B. Before the first step after a reset() the body is at rest
  /// under it.
  void set(const Vector3& gravity) noexcept;
  /// Adds what a node does at the end of the coming step.
  void add_coming(int node, Vector3& u) const noexcept;
  /// The same at the end of the n-th coming step.
  void add_ahead(int node, int n, Vector3& u) const noexcept;
  /// As CachedConvolution's.
  void cache_node(int node) noexcept { changes_.cache_node(node); }
  void predict_horizon(int node, int n) noexcept { changes_.predict_horizon(node, n); }
  /// Adds the displacement of all nodes at the end of the last step.
  void add_all(Points& u) const;
  void advance() noexcept;
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

 private:
  void add_sag(int node, Vector3& u) const noexcept;

  const GravityResponse& response_;
  DenseLoad<Number, 3> changes_;
  Vector3 largest_sag_ = Vector3::Zero();  ///< of any component, for each axis [s^2]
  Vector3 last_ = Vector3::Zero();         ///< in the last step [m/s^2]
  Vector3 coming_ = Vector3::Zero();       ///< from the coming step on
  bool begun_ = false;                     ///< there was a step since the reset
};

}  // namespace irdm
