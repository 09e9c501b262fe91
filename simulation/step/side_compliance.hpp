#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <span>
#include <vector>

#include "simulation/contact/patch_compliance.hpp"

namespace irdm {

/// R[0] between the places on one object at which other bodies touch it, kept from step to step: of
/// contacts that stay where they are nothing is computed again. Real-time safe after construction.
class SideCompliance {
 public:
  struct Side {
    std::uint64_t key = 0;  ///< of the contact, the same from step to step; increasing in a list
    PatchCompliance::Place place;
  };

  /// @param capacity sides at most
  explicit SideCompliance(int capacity);

  /// @param sides of this step  @param compliance always the same
  void update(std::span<const Side> sides, const PatchCompliance& compliance) noexcept;
  /// Displacement at side i per force at side j of the last update() [m/N], B.
  auto between(std::size_t i, std::size_t j) const noexcept {
    return blocks_.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j));
  }

 private:
  void keep(std::span<const Side> sides) noexcept;

  std::vector<Side> sides_;    ///< whose blocks are there
  std::vector<bool> current_;  ///< of each, whether they are those of its place
  std::vector<int> before_;    ///< of each new side: where it was, -1: it is new
  Eigen::MatrixXd blocks_;
  Eigen::MatrixXd other_;  ///< of the step before, while the list changes
};

}  // namespace irdm
