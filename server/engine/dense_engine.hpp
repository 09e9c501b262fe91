#pragma once

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

  Vector3 free_displacement(int node) const noexcept override;
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  void displacement(Points& u) const override;
  Eigen::MatrixXd instant_compliance() const override;
  void reset() noexcept override;

 private:
  Matrix3 within_step(const ContactPatch& a, const ContactPatch& b) const noexcept;
  /// R_ab[s] for s = 0..T-1: displacement of degree of freedom a by a force on b.
  const Scalar* response(int a, int b) const noexcept {
    return values_ + (static_cast<std::size_t>(b) * dof_ + static_cast<std::size_t>(a)) * steps_;
  }
  /// sum over the history of R_a.[age + shift] f[age]: shift 0 gives the end of the last step, 1
  /// that of the coming one.
  double convolve(int a, int shift) const noexcept;

  std::shared_ptr<const Model> model_;
  const Scalar* values_;
  std::size_t dof_;    ///< 3n
  std::size_t steps_;  ///< T
  ForceHistory history_;
};

}  // namespace irdm
