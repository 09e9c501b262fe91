#pragma once

#include "common/contact/persistent_contact.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// The god-object of one stylus on one object: where on the surface it is, from step to step. It
/// comes into being where the tip's way crosses the deformed surface from outside, stays at its
/// material point while it sticks or is held, and moves along the surface by its slip. Geometry
/// alone; the forces are found elsewhere. Real-time safe.
class GodObject {
 public:
  /// What the stylus does in this step.
  struct Input {
    Vector3 tip = Vector3::Zero();  ///< in the frame that free motion leads to [m], B
    bool grab = false;
    double reach = 0.0;  ///< a tip that grabs within it holds the nearest node [m]
  };

  /// Decides whether there is a contact in this step.
  void find(const Input& input, DeformedSurface& surface) noexcept;
  /// The stylus is gone; when it comes back, it has to come from outside, and to press its button
  /// anew to reach.
  void forget() noexcept {
    *this = GodObject{};
    grabbed_before_ = true;
  }
  /// A contact that was decided elsewhere.
  void impose(ContactState state, const SurfacePoint& point) noexcept;
  /// The same, where its triangle is known.
  void impose(ContactState state, int triangle, const SurfacePoint& point) noexcept {
    impose(state, point);
    triangle_ = triangle;
  }

  /// After the step: still in contact, having to slip by `slip` [m, B] along the surface. As far as
  /// the tip itself has moved it does so at once; of what is more (an edge let go, say) it goes a
  /// `share`, so that the force does not jump. `point_free` is where the point was without force
  /// [m, B].
  void stay(const Vector3& slip, double share, const Vector3& point_free,
            const RestSurface& rest) noexcept;
  /// After the step, where friction is finite: when the tip has come nearer to another side of the
  /// object, the contact goes over there like a slip, the more decidedly the more the side is
  /// another one and the nearer it is. Without this a tip could hook a soft edge and pull it along
  /// from beyond.
  void follow(const Vector3& tip, double share, const RestSurface& rest) noexcept;
  /// Goes a way along the surface.
  void slide(const Vector3& towards, double length, const RestSurface& rest) noexcept;
  /// After the step: a point that is given up is pushed on, so that it can be touched on.
  void turn_to_touching() noexcept { contact_.turn_to_touching(); }
  /// After the step: the contact let go, and the tip [m, B] is outside.
  void release(const Vector3& tip) noexcept;

  /// In place of a contact that began: none, and the tip has to come out before it can touch.
  void reject_contact() noexcept;
  /// How far the tip has moved since the step before [m].
  double tip_moved() const noexcept { return tip_moved_; }
  /// A touching contact's offset: from its point to where the tip feels the surface [m, B].
  void set_inset(const Vector3& inset) noexcept { offset_ = inset; }

  /// The tip is where a touch may begin.
  bool outside() const noexcept { return outside_; }

  const PersistentContact& contact() const noexcept { return contact_; }
  ContactState state() const noexcept { return contact_.state(); }
  int triangle() const noexcept { return triangle_; }
  const SurfacePoint& point() const noexcept { return point_; }
  const Vector3& offset() const noexcept { return offset_; }
  /// It began to touch in this step.
  bool fresh() const noexcept { return fresh_; }
  /// Held at an offset, by its reach.
  bool reached() const noexcept { return reached_; }

 private:
  /// How far to go in one step of `length` that are wanted.
  double catch_up(double length, double share) const noexcept;
  void touch(const Vector3& tip, DeformedSurface& surface) noexcept;
  bool reach_for(const Input& input, DeformedSurface& surface) noexcept;

  PersistentContact contact_;
  int triangle_ = 0;
  SurfacePoint point_;
  Vector3 offset_ = Vector3::Zero();
  bool fresh_ = false;
  bool reached_ = false;
  bool grabbed_before_ = false;  ///< the button was down in the last step, or may have been
  /// The tip was outside the surface when last seen. Only from there can it make a contact.
  bool outside_ = false;
  Vector3 last_tip_ = Vector3::Zero();  ///< relative to the free motion [m], B
  Vector3 tip_ = Vector3::Zero();       ///< of this step [m], B
  double slid_ = 0.0;                   ///< in this step, by slip [m]
  double tip_moved_ = 0.0;              ///< since the step before [m]
};

}  // namespace irdm
