#pragma once

#include <type_traits>
#include <variant>
#include <vector>

#include "common/response/spin_products.hpp"
#include "server/engine/running_convolution.hpp"

namespace irdm {

/// What the body's own spin adds to a dense response: the products of its components act as if they
/// were forces on two nodes, each with a column of its own. Real-time safe but for displacement();
/// one thread.
template <typename Number>
class DenseSpin {
 public:
  using Values = std::variant<std::vector<float>, std::vector<double>>;

  /// @param values of DenseResponse, numbers of this type; empty: the model has none, and nothing
  /// is ever added
  DenseSpin(const Values& values, int dof, int steps);

  bool any() const noexcept { return columns_.values != nullptr; }
  /// Nothing is added: no spin is held, and none was within the last T steps.
  bool at_rest() const noexcept { return past_.history().active().empty() && coming_.isZero(0.0); }
  /// Held throughout the coming step.
  void hold(const Vector3& w) noexcept;
  /// Adds what a node does at the end of the coming step, with the spin that is held.
  void add_coming(int node, Vector3& u) const noexcept;
  /// The same at the end of the n-th coming step, of the steps until now alone.
  void add_foreseen(int node, int n, Vector3& u) const noexcept;
  /// As RunningConvolution's.
  void follow(int node) noexcept;
  void foresee(int node, int n) noexcept;
  /// Adds the displacement of all nodes at the end of the last step.
  void add_all(Points& u) const {
    if (any()) columns_.add_all(past_.history(), u);
  }
  void advance() noexcept;
  void reset() noexcept;

 private:
  ResidentColumns<Number> columns_;
  RunningConvolution<ResidentColumns<Number>> past_;
  SpinProducts coming_ = SpinProducts::Zero();
};

/// The numbers of the centrifugal response beside R of these: never of half precision.
template <typename Scalar>
using SpinNumber = std::conditional_t<std::is_same_v<Scalar, Half>, float, Scalar>;

}  // namespace irdm
