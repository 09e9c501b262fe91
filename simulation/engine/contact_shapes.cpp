#include "simulation/engine/contact_shapes.hpp"

#include <algorithm>

namespace irdm {
namespace {

constexpr std::size_t kShapeSlice =
    512;  // modes whose shapes under a contact fill a part of the cache

Eigen::Index at(std::size_t a) noexcept {
  return static_cast<Eigen::Index>(3 * a);
}

}  // namespace

template <typename Scalar>
ContactShapes<Scalar>::ContactShapes(const RowMatrix<Scalar>& shapes)
    : shapes_(shapes),
      modes_(static_cast<std::size_t>(shapes.cols())),
      patches_(kMaxContacts),
      rows_(3 * kMaxContacts * modes_, 0.0),
      compliance_(Blocks::Zero()) {}

// Three nodes at a time; where fewer are left, the last ones count with weight 0.
template <typename Scalar>
void ContactShapes<Scalar>::mean_shape(const ContactPatch& patch, int axis, const ModeRange& modes,
                                       double* shape) const noexcept {
  for (int first = 0; first < patch.count; first += 3) {
    std::array<double, 3> weights{};
    std::array<const Scalar*, 3> rows{};
    for (int i = 0; i < 3; ++i) {
      const auto from = static_cast<std::size_t>(std::min(first + i, patch.count - 1));
      weights[static_cast<std::size_t>(i)] = first + i < patch.count ? patch.weights[from] : 0.0;
      rows[static_cast<std::size_t>(i)] =
          shapes_.row(3 * patch.nodes[from] + axis).data() + modes.first;
    }
    if (first == 0) {
      combine(weights, rows[0], rows[1], rows[2], shape, modes.count);
    } else {
      accumulate(weights, rows[0], rows[1], rows[2], shape, modes.count);
    }
  }
}

// Finds out which stay.
template <typename Scalar>
void ContactShapes<Scalar>::keep(std::span<const ContactPatch> patches) noexcept {
  for (std::size_t a = 0; a < patches.size(); ++a) {
    stays_[a] = a < count_ && patches_[a] == patches[a];
    if (stays_[a]) continue;
    patches_[a] = patches[a];
    compliance_.template middleRows<3>(at(a)).setZero();
    compliance_.template middleCols<3>(at(a)).setZero();
  }
  count_ = patches.size();
}

// Slice after slice of the modes, so that mean shapes that are made stay in the first level of the
// cache.
template <typename Scalar>
void ContactShapes<Scalar>::predict(std::span<const ContactPatch> patches, const Modes& modes,
                                    std::span<Vector3> h, ContactMatrix& compliance) noexcept {
  keep(patches);
  std::fill_n(h.begin(), count_, Vector3::Zero());
  for (std::size_t first = 0; first < modes_; first += kShapeSlice) {
    add_slice({first, std::min(kShapeSlice, modes_ - first)}, modes, h);
  }
  compliance = compliance_.topLeftCorner(at(count_), at(count_));
}

template <typename Scalar>
void ContactShapes<Scalar>::add_slice(const ModeRange& slice, const Modes& modes,
                                      std::span<Vector3> h) noexcept {
  for (std::size_t a = 0; a < count_; ++a) {
    if (stays_[a]) {
      const Sums<3> moved = dot_three(modes.coordinate + slice.first, rows(a, slice), slice.count);
      h[a] += Vector3(moved[0], moved[1], moved[2]);
    } else {
      find_own(a, slice, modes, h[a]);
    }
    for (std::size_t b = 0; b < a; ++b) {
      if (stays_[a] && stays_[b]) continue;
      const Sums<9> shared =
          cross_moments(rows(a, slice), rows(b, slice), modes.b1 + slice.first, slice.count);
      compliance_.template block<3, 3>(at(a), at(b)) +=
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shared.data());
    }
  }
}

// Of one that is new here.
template <typename Scalar>
void ContactShapes<Scalar>::find_own(std::size_t a, const ModeRange& slice, const Modes& modes,
                                     Vector3& h) noexcept {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mean_shape(patches_[a], static_cast<int>(axis), slice, rows(a, slice) + axis * slice.count);
  }
  const Sums<9> own =
      moments(rows(a, slice), modes.b1 + slice.first, modes.coordinate + slice.first, slice.count);
  h += Vector3(own[0], own[1], own[2]);
  std::size_t entry = 3;
  for (Eigen::Index j = 0; j < 3; ++j) {
    for (Eigen::Index k = 0; k <= j; ++k) compliance_(at(a) + j, at(a) + k) += own[entry++];
  }
}

template class ContactShapes<float>;
template class ContactShapes<double>;

}  // namespace irdm
