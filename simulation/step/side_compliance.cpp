#include "simulation/step/side_compliance.hpp"

#include <algorithm>
#include <utility>

namespace irdm {
namespace {

bool same(const PatchCompliance::Place& a, const PatchCompliance::Place& b) noexcept {
  return a.count == b.count && a.rows == b.rows && a.weights == b.weights &&
         a.ball_sample == b.ball_sample;
}

}  // namespace

SideCompliance::SideCompliance(int capacity)
    : blocks_(Eigen::MatrixXd::Zero(3 * capacity, 3 * capacity)), other_(blocks_) {
  sides_.reserve(static_cast<std::size_t>(capacity));
  current_.reserve(sides_.capacity());
  before_.reserve(sides_.capacity());
}

// Takes over what stays; both lists are in the order of their keys.
void SideCompliance::keep(std::span<const Side> sides) noexcept {
  before_.assign(sides.size(), -1);
  current_.assign(sides.size(), false);
  bool moved = sides.size() != sides_.size();
  for (std::size_t i = 0, j = 0; i < sides.size(); ++i) {
    while (j < sides_.size() && sides_[j].key < sides[i].key) ++j;
    if (j == sides_.size() || sides_[j].key != sides[i].key) {
      moved = true;
      continue;
    }
    before_[i] = static_cast<int>(j);
    current_[i] = same(sides_[j].place, sides[i].place);
    moved = moved || i != j;
  }
  if (!moved) return;
  std::swap(blocks_, other_);
  for (std::size_t j = 0; j < sides.size(); ++j) {
    if (!current_[j]) continue;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (!current_[i]) continue;
      blocks_.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          other_.block<3, 3>(3 * before_[i], 3 * before_[j]);
    }
  }
}

void SideCompliance::update(std::span<const Side> sides,
                            const PatchCompliance& compliance) noexcept {
  keep(sides);
  sides_.assign(sides.begin(), sides.end());
  for (std::size_t j = 0; j < sides.size(); ++j) {
    for (std::size_t i = 0; i <= j; ++i) {
      if (current_[i] && current_[j]) continue;
      const Matrix3 shared = compliance.between(sides[i].place, sides[j].place);
      const auto row = static_cast<Eigen::Index>(3 * i);
      const auto column = static_cast<Eigen::Index>(3 * j);
      blocks_.block<3, 3>(row, column) = shared;
      blocks_.block<3, 3>(column, row) = shared.transpose();
    }
  }
}

}  // namespace irdm
