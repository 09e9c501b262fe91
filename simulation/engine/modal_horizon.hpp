#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/course_kernels.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// What contacts on modal responses will do in the coming steps. Per contact it keeps the mean
/// shape of its patch, the response and the free path: while the patch stays, the response stays,
/// and the path shifts by a step, with what the last step's force adds and one new end. What is
/// computed anew follows from the course of each mode (course_kernels.hpp), for which nothing is
/// read that a step does not read as well; the new end from c_n and s_n, the coordinate of a mode n
/// steps after a coordinate of 1, or a velocity of 1, without a force. Real-time safe after
/// construction; one thread.
class ModalHorizon {
 public:
  static constexpr std::uint64_t kNoPath = ~std::uint64_t{0};
  /// One contact.
  struct Contact {
    ContactPatch patch;
    AlignedNumbers shapes;                  ///< (3, stride()): rows sum_i w_i Phi_i
    std::uint64_t made = 0;                 ///< number of its begin()
    std::uint64_t used = 0;                 ///< number of the state that it was last asked about
    std::uint64_t state = kNoPath;          ///< that the path goes on from
    std::size_t steps = 0;                  ///< of path and response
    std::array<Vector3, kMaxHorizon> path;  ///< path[n]: displacement n + 1 steps on [m]
    std::array<Matrix3, kMaxHorizon> response;
  };
  /// All modes at the end of the coming step under no force but what acts by itself, (r) each.
  struct State {
    /// Even, and two more after each step; odd once the body's own motion loads it in the coming
    /// step; four more when the state was changed otherwise.
    std::uint64_t number = 0;
    const double* coordinate = nullptr;
    const double* velocity = nullptr;
    const double* force = nullptr;         ///< that acts by itself and goes on; null: none
    const double* last = nullptr;          ///< modal force during the last step; null: none
    const Contact* only = nullptr;         ///< on which alone a force acted in it; null: not so
    Vector3 only_force = Vector3::Zero();  ///< that one [N]
  };

  /// @param modes r, > 0
  explicit ModalHorizon(std::size_t modes);

  /// Of a row of shapes: r, and zeros.
  std::size_t stride() const noexcept { return stride_; }

  /// How modes go on, and what a unit force does in a step: (r), which stay there. Forgets all
  /// contacts.
  /// @param omega angular frequency (r) [rad/s]
  void set_transitions(const Transitions& A, const double* b1, const double* b2,
                       const double* omega) noexcept;

  /// The contact on this patch, with its shapes; null: it is not known.
  const Contact* find(const ContactPatch& patch) const noexcept;
  Contact* find(const ContactPatch& patch) noexcept;
  /// Whether update() of it would go on from what is known.
  /// @param number of the state  @param steps as for update()
  bool keeps(const ContactPatch& patch, std::uint64_t number, std::size_t steps) const noexcept;
  /// The contact on whose patch these forces are the share of one force each; null: none.
  const Contact* find_only(std::span<const NodalForce> forces, Vector3& force) const noexcept;
  /// In place of the contact that was not asked about for longest; its shapes are to be written.
  Contact& begin(const ContactPatch& patch) noexcept;
  /// Whether the response to a force on this patch is known for so many steps.
  bool keeps_response(const ContactPatch& patch, std::size_t steps) const noexcept;
  /// Makes the response that of the first `steps` coming steps.
  void find_response(Contact& contact, std::size_t steps) noexcept;
  /// Makes path and response those of the first `steps` coming steps.
  void update(Contact& contact, const State& state, std::size_t steps) noexcept;
  /// How one answers a force on the other, as ResponseEngine::cross_response(). Kept while both
  /// stay.
  void cross_response(const Contact& to, const Contact& from, std::span<Matrix3> response) noexcept;
  /// Whether that is known.
  bool keeps_cross_response(const ContactPatch& to, const ContactPatch& from,
                            std::size_t steps) const noexcept;
  /// The path anew, with this modal force (r), too, that is held in all coming steps; null: none.
  void find_path(const Contact& contact, const State& state, const double* held,
                 std::span<Vector3> path) noexcept;

 private:
  using Path = std::array<Vector3, kMaxHorizon>;
  static constexpr std::size_t kMostSteps = (kMaxHorizon + kCourse - 1) / kCourse * kCourse;
  using Sums = std::array<std::array<double, 3>, kMostSteps>;
  /// Modes at a time: what is read of them several times stays in the first level of the cache.
  static constexpr std::size_t kPart = 256;
  struct Part {
    std::size_t first;
    std::size_t count;
  };
  static constexpr std::size_t kMostCrosses = kMaxContacts * (kMaxContacts - 1) / 2;
  /// How a contact answers a force on another one.
  struct Cross {
    std::uint64_t to = 0;    ///< Contact::made; 0: nothing
    std::uint64_t from = 0;  ///< the same
    std::uint64_t used = 0;  ///< number of the call that it was last asked for in
    std::size_t steps = 0;
    std::array<Matrix3, kMaxHorizon> response;

    /// Of these two, one way or the other, for so many steps.
    bool is_of(const Contact& a, const Contact& b, std::size_t count) const noexcept;
  };

  void find_cross_response(const Contact& to, const Contact& from,
                           std::span<Matrix3> response) noexcept;
  void forget() noexcept;
  static bool goes_on(const Contact& contact, std::uint64_t number) noexcept {
    return contact.state % 2 == 0 && contact.state + 2 == number;
  }
  Vector3 end_of_path(const Contact& contact, const State& state) noexcept;
  void shift_path(Contact& contact, const State& state) noexcept;
  void respond_to(const Contact& contact, const double* force, std::size_t steps,
                  Path& moves) noexcept;
  template <typename Function>
  void for_parts(Function&& function) noexcept;
  void begin_free(const Part& part, const double* coordinate, const double* velocity) noexcept;
  void begin_impulse(const Part& part, const double* force) noexcept;
  void add_held(const Part& part, const double* force) noexcept;
  void add_courses(const Part& part, const double* weights, std::size_t stride, std::size_t steps,
                   Sums& sums) noexcept;
  const double* shape(const Contact& contact, std::size_t axis, const Part& part) const noexcept {
    return &contact.shapes[axis * stride_ + part.first];
  }
  const double* relative_coordinate(const State& state, const Part& part) noexcept;

  AddCourses add_three_;
  std::size_t modes_;
  std::size_t stride_;
  Transitions A_{};
  const double* b1_ = nullptr;
  const double* b2_ = nullptr;
  AlignedNumbers ends_;        ///< (kMaxHorizon, 2, r): c_n and s_n
  AlignedNumbers compliance_;  ///< (r) 1 / omega^2
  // Of a part of the modes; what is beyond the last one is zero.
  AlignedNumbers trace_;
  AlignedNumbers determinant_;
  AlignedNumbers now_;
  AlignedNumbers next_;
  AlignedNumbers factors_;
  AlignedNumbers products_;  ///< (3, kPart)
  std::array<Contact, kMaxContacts> contacts_;
  std::array<Cross, kMostCrosses> crosses_;
  std::uint64_t made_ = 0;   ///< contacts so far
  std::uint64_t asked_ = 0;  ///< calls of cross_response() so far
};

}  // namespace irdm
