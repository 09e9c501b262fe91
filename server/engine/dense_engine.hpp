#pragma once

#include <type_traits>

#include "common/response/spin_products.hpp"
#include "server/engine/force_history.hpp"
#include "server/engine/response_engine.hpp"

namespace irdm {

/// The paper's engine: R itself and the convolution with the last T steps of forces, equation (10).
/// Works for any linear response, wherever it came from. What happened more than T steps ago is
/// forgotten.
template <typename Scalar>
class DenseEngine final : public ResponseEngine {
 public:
  /// @param model holds a DenseResponse of type Scalar
  explicit DenseEngine(std::shared_ptr<const Model> model);

  bool takes_spin() const noexcept override { return centrifugal_ != nullptr; }
  EngineKind kind() const noexcept override { return EngineKind::kDense; }
  void hold_spin(const Vector3& w) noexcept override;
  Vector3 free_displacement(int node) const noexcept override;
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void foresee(const ContactPatch& patch, std::span<const NodalForce> held, std::span<Vector3> path,
               std::span<Matrix3> response) noexcept override;
  void add_past(std::span<const NodalForce> forces, int age) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override;
  Eigen::MatrixXd instant_compliance() const override;
  void reset() noexcept override;

 private:
  /// Of the centrifugal response, which is never of half precision.
  using SpinScalar = std::conditional_t<std::is_same_v<Scalar, Half>, float, Scalar>;

  Matrix3 after(std::size_t step, const ContactPatch& a, const ContactPatch& b) const noexcept;
  Vector3 after(std::size_t step, const ContactPatch& a, const NodalForce& b) const noexcept;
  /// Of R, or of the centrifugal response: entry (a, b) for s = 0..T-1, displacement of degree of
  /// freedom a by force or product b.
  template <typename Number>
  const Number* response(const Number* values, int a, int b) const noexcept {
    return values + (static_cast<std::size_t>(b) * dof_ + static_cast<std::size_t>(a)) * steps_;
  }
  /// R[step](a, b).
  double entry(std::size_t step, int a, int b) const noexcept;
  /// Adds sum over the history of R_i.[age + shift] f[age], i the three degrees of freedom of a
  /// node: shift 0 gives the end of the last step, 1 that of the coming one. The same for products
  /// and their response.
  template <typename Number>
  void convolve(const Number* values, const double* scales, const ForceHistory& history, int node,
                int shift, Vector3& u) const noexcept;
  /// That sum with shift 0 for all degrees of freedom, added to u.
  template <typename Number>
  void add_columns(const Number* values, const double* scales, const ForceHistory& history,
                   Points& u) const;

  std::shared_ptr<const Model> model_;
  const Scalar* values_;                     ///< R, or what its columns are scaled from
  const double* scales_ = nullptr;           ///< of the columns; null: all 1
  const SpinScalar* centrifugal_ = nullptr;  ///< null: the model has none
  std::size_t dof_;                          ///< 3n
  std::size_t steps_;                        ///< T
  ForceHistory history_;
  /// Products of the spin, as if they were forces on two nodes.
  ForceHistory spin_history_;
  SpinProducts coming_ = SpinProducts::Zero();  ///< held during the coming step
};

}  // namespace irdm
