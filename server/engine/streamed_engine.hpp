#pragma once

#include <cstdint>
#include <vector>

#include "server/engine/dense_spin.hpp"
#include "server/engine/force_history.hpp"
#include "server/engine/resident_columns.hpp"
#include "server/engine/response_engine.hpp"

namespace irdm {

/// The dense engine on a response whose columns come and go (StreamedResponse). A node's columns
/// are taken when a force acts on it, and kept until its last force is T steps old, so that what a
/// force began is never broken off. With all of them there it equals DenseEngine but for rounding.
///
/// Where they are not there in time, forces on the node are answered by the static answer
/// (common/response/settling.hpp) in place of R: R[0] in their own step, then a settling without
/// vibration to the same lasting displacement. When the columns come, the node's answer goes over
/// from the one to the other, both to all of its forces, evenly within kBlendTime.
template <typename Scalar>
class StreamedEngine final : public ResponseEngine {
 public:
  static constexpr double kBlendTime = 0.05;  ///< [s]

  /// @param model holds a StreamedResponse of type Scalar, with columns
  explicit StreamedEngine(std::shared_ptr<const Model> model);
  ~StreamedEngine() override;
  StreamedEngine(const StreamedEngine&) = delete;
  StreamedEngine& operator=(const StreamedEngine&) = delete;

  bool takes_spin() const noexcept override { return spin_.any(); }
  EngineKind kind() const noexcept override { return EngineKind::kDense; }
  void hold_spin(const Vector3& w) noexcept override { spin_.hold(w); }
  void expect(std::span<const Vector3> tips) noexcept override { supply_.expect(tips); }
  std::uint64_t missed_columns() const noexcept override { return missed_; }
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
  /// What there is of a node's columns.
  struct Columns {
    const Scalar* values = nullptr;  ///< null: not taken
    double share = 0.0;              ///< of R in its answer; the static answer has the rest
    bool followed = false;           ///< the history has forces on it
  };
  /// Part of what forces on degree of freedom b do by the static answer, for all nodes alike.
  struct Settled {
    std::size_t column = 0;
    double newest = 0.0;  ///< of R[0] [N]
    double past = 0.0;    ///< of what follows it [N]
  };

  bool take(Columns& columns, int node) noexcept;
  void give_back(int node) noexcept;
  void follow_history() noexcept;
  void settle() noexcept;
  void borrow(int node) noexcept;
  void return_borrowed() noexcept;
  Settled settled(int source, int axis, int shift) const noexcept;
  void convolve(int node, int shift, Vector3& u) const noexcept;
  void add_columns(Points& u) const;

  double first(int a, int b) const noexcept;
  double rest(int a, int b) const noexcept;
  double entry(std::size_t step, int a, int b) const noexcept;

  std::shared_ptr<const Model> model_;
  const StreamedResponse& response_;
  ColumnSupply& supply_;
  ResidentColumns<Scalar> frame_;  ///< sizes and scales of R, no values
  const Scalar* first_;            ///< R[0]
  ForceHistory history_;
  DenseSpin<SpinNumber<Scalar>> spin_;
  double blend_step_;
  std::vector<Columns> columns_;  ///< of each node
  std::vector<Settled> coming_;   ///< settled(node, axis, 1), of followed nodes that lack a share
  std::vector<int> followed_;     ///< nodes that are
  std::vector<int> borrowed_;     ///< taken during foresee() only
  int taken_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace irdm
