#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "server/engine/force_history.hpp"
#include "server/engine/kernels.hpp"
#include "server/engine/resident_columns.hpp"
#include "server/engine/response_engine.hpp"

namespace irdm {

/// The convolution of a response with the forces until now, equation (10), for nodes that are asked
/// for step after step: what is to come at such a node is kept for some steps ahead. A new force is
/// added to it, a late one too, with the few steps of R that this takes. Only what lies further
/// ahead is summed over the whole history, kStepsAhead steps in one go, for which R is read once
/// and not in each of them; nodes take their turns. A node that is asked for once is summed then
/// and there. Equal to ResidentColumns::convolve() but for rounding. Real-time safe after
/// construction; one thread.
template <typename Number>
class RunningConvolution {
 public:
  /// @param columns without values: nothing is ever added  @param sources nodes that forces act on
  RunningConvolution(const ResidentColumns<Number>& columns, int sources);

  /// Adds what forces until now do to a node by the end of the n-th coming step [m], n from 1 on.
  void add_coming(int node, int n, Vector3& u) noexcept;
  /// Adds the displacement of all nodes at the end of the last step (OpenMP).
  void add_all(Points& u) const { columns_.add_all(history_, u); }

  /// As ForceHistory's.
  void push(std::span<const NodalForce> forces) noexcept;
  void add_past(std::span<const NodalForce> forces, int age) noexcept;
  void clear() noexcept;

 private:
  static constexpr int kMostFollowed = 256;
  /// Steps without being asked for after which a node is no longer followed.
  static constexpr std::int64_t kPatience = 8;
  static constexpr int kRoom = 2 * (kMaxHorizon + 2 * static_cast<int>(kStepsAhead));

  /// A node's coming displacements: of the n-th step at begin + n - 1.
  struct Followed {
    int node = 0;
    int begin = 0;
    int length = 0;
    bool begun = false;
    std::int64_t asked = 0;  ///< the last step in which it was asked for
    std::array<std::array<double, kRoom>, 3> coming;
  };

  Followed* follow(int node) noexcept;
  void extend(Followed& followed) noexcept;
  void add_to_followed(std::span<const NodalForce> forces, int age) noexcept;
  void forget_idle() noexcept;

  ResidentColumns<Number> columns_;
  ForceHistory history_;
  std::vector<Followed> followed_;  ///< the first `count_` are in use
  std::vector<int> place_;          ///< of a node among them; -1: not there
  int count_ = 0;
  int turn_ = 0;
  std::int64_t step_ = 0;
};

}  // namespace irdm
