#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "common/model/model.hpp"
#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/active_modes.hpp"
#include "simulation/engine/kernels.hpp"

namespace irdm {

/// The mean shape of each mode under the contacts of a step, and the compliance between these
/// within it, R[0] = Phi diag(b1) Phi^T. Kept from step to step: of contacts whose patches stay
/// nothing is computed again, to the bit. Real-time safe after construction; one thread.
template <typename Scalar>
class ContactShapes {
 public:
  /// @param shapes Phi (3n, r); must outlive this object
  explicit ContactShapes(const RowMatrix<Scalar>& shapes);

  /// Rows sum_i w_i Phi_i of these modes along one axis.
  void mean_shape(const ContactPatch& patch, int axis, const ModeRange& modes,
                  double* shape) const noexcept;

  /// The modes of the step: all (r).
  struct Modes {
    const double* b1;  ///< displacement by a held force of 1; as long as nothing is forgotten
    const double* coordinate;  ///< at the end of the step without its forces
  };
  /// For contacts a = 0..m-1: their mean displacement h_a [m], and the compliance between them
  /// (3m, 3m) [m/N].
  void predict(std::span<const ContactPatch> patches, const Modes& modes, std::span<Vector3> h,
               ContactMatrix& compliance) noexcept;
  /// b1 has changed.
  void forget() noexcept { count_ = 0; }

 private:
  using Blocks = Eigen::Matrix<double, 3 * kMaxContacts, 3 * kMaxContacts>;
  void keep(std::span<const ContactPatch> patches) noexcept;
  void add_slice(const ModeRange& slice, const Modes& modes, std::span<Vector3> h) noexcept;
  void find_own(std::size_t a, const ModeRange& slice, const Modes& modes, Vector3& h) noexcept;
  double* rows(std::size_t a, const ModeRange& slice) noexcept {
    return &rows_[3 * (kMaxContacts * slice.first + a * slice.count)];
  }

  const RowMatrix<Scalar>& shapes_;
  std::size_t modes_;                  ///< r
  std::vector<ContactPatch> patches_;  ///< whose rows and blocks are there: the first `count_`
  std::size_t count_ = 0;
  std::array<bool, kMaxContacts> stays_;  ///< of those of the step: they are there already
  AlignedNumbers rows_;                   ///< slice after slice of the modes, (m, 3, slice)
  Blocks compliance_;                     ///< its lower triangle [m/N]
};

}  // namespace irdm
