#pragma once

#include <Eigen/Dense>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "common/geometry.hpp"

namespace irdm {

/// Contacts of styluses that one object can have in one step.
inline constexpr int kMaxContacts = 16;
/// Of these, so many are tried to be solved directly when some may let go: each that does costs a
/// factorisation.
inline constexpr int kMaxDirectContacts = 8;

/// Square matrix over the stylus contacts of one step: 3 rows a contact, no memory taken.
using ContactMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMaxContacts, 3 * kMaxContacts>;

/// How a contact may push on the object.
enum class ContactLaw {
  kHeld,      ///< in any direction
  kReleased,  ///< not at all
  kGiven,     ///< with the force that is there
  kTouching,  ///< towards the inside, and sideways inside the Coulomb cone
  /// Friction of a whole group of touching contacts without friction of their own: a force in the
  /// plane across the sum of their forces, inside the Coulomb disk of that sum's length.
  kGroupFriction,
};

/// Coulomb friction: a contact sticks while the force along the surface is at most `static_`
/// times the one across it, and slips with `kinetic` times that; kinetic <= static_.
struct Friction {
  double static_ = std::numeric_limits<double>::infinity();
  double kinetic = std::numeric_limits<double>::infinity();

  bool operator==(const Friction&) const = default;
};

/// What a contact does in the solution.
enum class ContactMode {
  kOpen,      ///< no force
  kSticking,  ///< its point is where it is wanted
  kSlipping,  ///< on the cone; its point lags sideways behind where it is wanted
};

/// One contact of a problem: what is asked and what was found.
struct ContactConstraint {
  ContactLaw law = ContactLaw::kHeld;
  Vector3 normal = Vector3::Zero();  ///< outward unit normal of the object's surface; of touching
  Friction friction;
  Vector3 arm = Vector3::Zero();  ///< lever arm from the centre of mass [m]; used with `rigid`
  Vector3 gap =
      Vector3::Zero();  ///< p - r: from where the point would be to where it is wanted [m]
  /// In: what the iteration starts from. Out: the solution [N], on the object.
  Vector3 force = Vector3::Zero();
  ContactMode mode = ContactMode::kOpen;
  Vector3 slip = Vector3::Zero();  ///< sideways, from the point to where it was wanted [m]
  /// Elastic displacement of its point by forces outside the problem, which the gap allows for [m].
  Vector3 elsewhere = Vector3::Zero();
  // Of kGroupFriction: numbers of the contacts in its group.
  int group_first = 0;
  int group_count = 0;
  // Of a contact in a group, written by who spreads the friction.
  Vector3 shared = Vector3::Zero();  ///< its part of the friction, which `force` contains [N]
  /// What the solution leaves open at it sideways, less the mean of the group [m].
  Vector3 apart = Vector3::Zero();
};

/// The rigid body's own answer within the step: displacement at arm a per force at arm b,
/// translation Id - [a]x rotation [b]x.
struct RigidMobility {
  double translation = 0.0;            ///< dt^2 / 2M [m/N]
  Matrix3 rotation = Matrix3::Zero();  ///< dt^2/2 I^-1 [1/(N m)]
  Matrix3 between(const Vector3& a, const Vector3& b) const noexcept {
    return translation * Matrix3::Identity() - skew(a) * rotation * skew(b);
  }
};

/// The contact problem of one step: forces on the object f [N] with W f = gap for every contact
/// that sticks or is held, no force where a point is left, and friction where it slips. Every
/// component in one frame (B at the server). W = elastic + rigid between(a, b). Room for `capacity`
/// contacts is made once; the rest is real-time safe.
class ContactProblem {
 public:
  explicit ContactProblem(int capacity);

  int capacity() const noexcept { return static_cast<int>(contacts_.size()); }
  int count() const noexcept { return count_; }
  /// Starts a problem of `count` contacts, all of them blank; elastic blocks keep their values.
  void begin(int count) noexcept;

  ContactConstraint& contact(int a) noexcept { return contacts_[static_cast<std::size_t>(a)]; }
  const ContactConstraint& contact(int a) const noexcept {
    return contacts_[static_cast<std::size_t>(a)];
  }
  /// Elastic compliance within the step between contacts a and b (coupling springs included) [m/N].
  auto elastic(int a, int b) noexcept { return elastic_.block<3, 3>(3 * a, 3 * b); }
  auto elastic(int a, int b) const noexcept { return elastic_.block<3, 3>(3 * a, 3 * b); }
  /// All rows of the elastic compliance that a force at contact b moves: (3 count, 3).
  auto elastic_column(int b) const noexcept { return elastic_.block(0, 3 * b, 3 * count_, 3); }
  /// Sets all of it to zero.
  void clear_elastic() noexcept { elastic_.topLeftCorner(3 * count_, 3 * count_).setZero(); }
  RigidMobility rigid;

  /// W_ab.
  Matrix3 compliance(int a, int b) const noexcept {
    return elastic(a, b) + rigid.between(contact(a).arm, contact(b).arm);
  }

 private:
  int count_ = 0;
  Eigen::MatrixXd elastic_;
  std::vector<ContactConstraint> contacts_;
};

/// How a problem was solved.
struct ContactSolution {
  int sweeps = 0;         ///< of the iteration; 0: solved directly
  double residual = 0.0;  ///< largest violation of a contact's law [m]
  bool solved = true;     ///< false: no solution was found; all forces are zero, all contacts open
};

struct SolverLimits {
  int max_sweeps = 200;
  double tolerance = 1e-12;  ///< the iteration ends below this residual [m] ...
  int usual_sweeps = 200;    ///< ... or after so many sweeps ...
  double usual = 1e-12;      ///< ... below this one [m]
  double worst = 1e-3;       ///< a residual above this one after all sweeps is no solution [m]
  /// How often conjugate directions may begin anew; from then on there are sweeps alone. Where many
  /// contacts are on the friction cone they can go round in a circle otherwise.
  int restarts = std::numeric_limits<int>::max();
};

/// Solves all contacts of a problem together. When sticking and being held suffices for all of at
/// most kMaxDirectContacts contacts (the strongest pull lets go first), or all of at most
/// kMaxContacts are held, that is the solution, found directly. Otherwise the laws are met by
/// nonlinear block Gauss-Seidel from the forces given in: one touching contact after the other is
/// solved exactly with the others' forces as they stand, but for those of held contacts, which are
/// eliminated (Schur complement): they answer at once. Between sweeps the forces go on along
/// conjugate directions (nonsmooth nonlinear conjugate gradients, Silcowitz-Hansen et al. 2010),
/// without which many contacts of a stiff body converge slowly. Bounded, real-time safe, no
/// exceptions. Large: the private methods are the pieces of one sweep, and all of them work on the
/// same iterate.
class ContactSolver {
 public:
  explicit ContactSolver(int capacity);
  ContactSolution solve(ContactProblem& problem, const SolverLimits& limits = {}) noexcept;

 private:
  bool stick(ContactProblem& problem) noexcept;
  ContactSolution iterate(ContactProblem& problem, const SolverLimits& limits) noexcept;
  void start(const ContactProblem& problem) noexcept;
  void keep(const ContactProblem& problem) noexcept;
  void extrapolate(ContactProblem& problem) noexcept;
  void find_own_compliances(const ContactProblem& problem) noexcept;
  void factor_held(ContactProblem& problem) noexcept;
  double sweep(ContactProblem& problem) noexcept;
  double solve_held(ContactProblem& problem) noexcept;
  double solve_touching(ContactProblem& problem, int a) noexcept;
  double solve_smooth(ContactProblem& problem, int a) noexcept;
  void find_slips(ContactProblem& problem) noexcept;
  double solve_group_friction(ContactProblem& problem, int a) noexcept;
  Vector3 displacement(const ContactProblem& problem, int a) const noexcept;
  void change(ContactProblem& problem, int a, const Vector3& force) noexcept;
  void add(ContactProblem& problem, int a, const Vector3& more) noexcept;

  // Of the iteration under way. What all forces do: their sum [N], their torque [N m], their
  // elastic displacements (3 count) [m]; and, where it is linear algebra, the forces themselves (3
  // count).
  auto push() noexcept { return now_.segment<3>(0); }
  auto push() const noexcept { return now_.segment<3>(0); }
  auto turn() noexcept { return now_.segment<3>(3); }
  auto turn() const noexcept { return now_.segment<3>(3); }
  Eigen::VectorXd now_;         ///< (6 + 6 capacity)
  Eigen::VectorXd before_;      ///< the same before the last sweep
  Eigen::VectorXd direction_;   ///< of the conjugate gradients
  std::vector<Matrix3> own_;    ///< compliance of each contact, with the answer of held ones [m/N]
  std::vector<double> across_;  ///< the same along its normal [m/N]
  double last_change_ = 0.0;    ///< squared norm of the last sweep's change of forces [N^2]
  int restarts_ = 0;            ///< of the conjugate directions
  int sweeps_ = 0;              ///< done
  std::array<int, kMaxContacts> held_{};   ///< contacts that are held ...
  int held_count_ = 0;                     ///< ... so many of them; more are solved one by one
  Eigen::LDLT<ContactMatrix> held_block_;  ///< compliance between them
  /// Held forces per force elsewhere, and less: (3 kMaxContacts, 3 capacity).
  Eigen::MatrixXd held_answer_;
};

/// The answer of one contact to a gap, all other forces being known.
struct SingleContact {
  Vector3 force = Vector3::Zero();  ///< on the object [N]
  ContactMode mode = ContactMode::kOpen;
  Vector3 slip = Vector3::Zero();  ///< sideways, what of the gap stays open [m]
};

/// Solves one contact exactly: with W its own compliance (3, 3) [m/N], symmetric positive definite,
/// and `gap` [m] what its own force has to close. Held: W f = gap. Touching: open when the gap
/// points outward; else sticking, if that force is inside the static cone; else slipping: the
/// normal part of the gap is closed, the force lies on the kinetic cone, and along the surface it
/// has the direction in which the point lags behind. Pure, real-time safe.
SingleContact solve_single_contact(const Matrix3& W, const Vector3& gap, ContactLaw law,
                                   const Vector3& normal, const Friction& friction) noexcept;

/// Solves the friction of a group (ContactLaw::kGroupFriction) exactly, with W and `gap` as above:
/// a force f across `pressed` closes the gap across it, if |f| <= static |pressed|. Otherwise the
/// group slips: |f| = kinetic |pressed|, and what stays open is parallel to f. Without a pressing
/// force it is open. Pure, real-time safe.
/// @param pressed sum of the forces of the group's contacts [N]
SingleContact solve_group_friction(const Matrix3& W, const Vector3& gap, const Vector3& pressed,
                                   const Friction& friction) noexcept;

}  // namespace irdm
