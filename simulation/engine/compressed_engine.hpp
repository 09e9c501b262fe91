#pragma once

#include <limits>

#include "simulation/engine/force_history.hpp"
#include "simulation/engine/recursive_tail.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// The answer from a compressed response, used as it is stored: a convolution with R itself over
/// the last m steps, and the shapes' poles for all that is older. What is within a step, R[0], is
/// that of the input. Nothing is cut off at T.
class CompressedEngine final : public ResponseEngine {
 public:
  /// @param model holds a CompressedResponse
  explicit CompressedEngine(std::shared_ptr<const Model> model);

  Vector3 free_displacement(int node) const noexcept override;
  double free_displacement_bound() const noexcept override {
    return std::numeric_limits<double>::infinity();
  }
  void predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept override;
  void predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                       std::span<Vector3> path, std::span<Matrix3> response) noexcept override;
  void cross_response(const ContactPatch& to, const ContactPatch& from,
                      std::span<Matrix3> response) noexcept override;
  void add_delayed_force(std::span<const NodalForce> forces, int age) noexcept override;
  void advance(std::span<const NodalForce> forces) noexcept override;
  using ResponseEngine::displacement;
  void displacement(Points& u, double tolerance) const override;
  void reset() noexcept override;
  void archive(StateArchive& state) override;

 private:
  /// What the last m steps of forces do to a node: shift 0 at the end of the last step, n at that
  /// of the n-th coming one.
  Vector3 fir(int node, int shift) const noexcept;
  Vector3 tail(int node, const double* coordinate) const noexcept;
  /// Rows sum_i w_i B_i of the patch's three axes. @param shapes (3, r)
  void mean_shapes(const ContactPatch& patch, double* shapes) const noexcept;

  std::shared_ptr<const Model> model_;
  const CompressedResponse* response_;
  ForceHistory history_;  ///< of m steps
  RecursiveTail tail_;
  std::vector<double> contact_shapes_;  ///< (6, r), of two contacts
  std::vector<double> products_;        ///< (9, r)
  std::vector<double> held_force_;      ///< (r)
};

}  // namespace irdm
