#pragma once

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
  void displacement(Points& u) const override;
  Eigen::MatrixXd instant_compliance() const override;
  void reset() noexcept override;

 private:
  Matrix3 after(std::size_t step, const ContactPatch& a, const ContactPatch& b) const noexcept;
  Vector3 after(std::size_t step, const ContactPatch& a, const NodalForce& b) const noexcept;
  /// Of R, or of the centrifugal response: entry (a, b) for s = 0..T-1, displacement of degree of
  /// freedom a by force or product b.
  const Scalar* response(const Scalar* values, int a, int b) const noexcept {
    return values + (static_cast<std::size_t>(b) * dof_ + static_cast<std::size_t>(a)) * steps_;
  }
  /// sum over the history of R_a.[age + shift] f[age]: shift 0 gives the end of the last step, 1
  /// that of the coming one. The same for products and their response.
  double convolve(const Scalar* values, const ForceHistory& history, int a,
                  int shift) const noexcept;
  double free_spin_displacement(int a) const noexcept;

  std::shared_ptr<const Model> model_;
  const Scalar* values_;                 ///< R
  const Scalar* centrifugal_ = nullptr;  ///< null: the model has none
  std::size_t dof_;                      ///< 3n
  std::size_t steps_;                    ///< T
  ForceHistory history_;
  /// Products of the spin, as if they were forces on two nodes.
  ForceHistory spin_history_;
  SpinProducts coming_ = SpinProducts::Zero();  ///< held during the coming step
};

}  // namespace irdm
