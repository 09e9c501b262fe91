#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/collision/deformed_surface.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/contact/contact_sampling.hpp"

namespace irdm {

class StateArchive;

/// Which parts of a body's surface can come to touch each other: each sample has the triangles that
/// it sees at rest through the outside, in front of both, that face it, are no farther than the
/// radius of the body, and have no node of the sample. A convex body has none. Of two faces one
/// gives the patches, the one whose normal is nearer to a direction in which most of them face;
/// edge samples have all that they see. Built once, read only.
class SelfReach {
 public:
  /// @param sampling of the surface; must outlive this
  SelfReach(const RestSurface& surface, const ContactSampling& sampling);

  bool any() const noexcept { return any_; }
  /// Flags of the triangles that a sample can meet; empty: none.
  TriangleSet across(int sample) const noexcept {
    const int row = rows_[static_cast<std::size_t>(sample)];
    if (row < 0) return {};
    return {flags_.data() + static_cast<std::size_t>(row) * triangle_count_, triangle_count_};
  }
  /// The nearest of them at rest.
  int nearest(int sample) const noexcept { return nearest_[static_cast<std::size_t>(sample)]; }
  /// From the sample to that one [m]; infinite: it meets none.
  double gap(int sample) const noexcept { return gaps_[static_cast<std::size_t>(sample)]; }
  double least_gap() const noexcept { return least_gap_; }
  /// Of the sample at rest [m], B.
  const Vector3& place(int sample) const noexcept {
    return sampling_.samples()[static_cast<std::size_t>(sample)].place.position;
  }
  int sample_count() const noexcept { return static_cast<int>(rows_.size()); }

 private:
  struct View {
    int sample = 0;
    int triangle = 0;
    double distance = 0.0;  ///< [m]
    Vector3 facing = Vector3::Zero();
  };
  void add(const View& view);

  const ContactSampling& sampling_;
  std::size_t triangle_count_;
  std::vector<int> rows_;     ///< of each sample into flags_; -1: it meets nothing
  std::vector<int> nearest_;  ///< of each sample
  std::vector<double> gaps_;  ///< of each sample
  std::vector<std::uint8_t> flags_;
  double least_gap_;
  bool any_ = false;
};

/// Where the samples of a deforming body come to other parts of its surface, from step to step.
/// Samples that are still far from what they can meet cost nothing. Real-time safe after
/// construction; one thread.
class SelfSearch {
 public:
  /// @param ahead samples that are nearer to what they can meet are found [m]
  /// @param reach, surface must outlive this
  SelfSearch(const SelfReach& reach, DeformedSurface& surface, double ahead);

  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);
  /// A step begins. False: the body is bent too little for any part to meet another.
  bool begin_step() noexcept;
  /// Whether a sample is certainly farther away in this step from what it can meet.
  bool is_far(int sample) noexcept;

  struct Found {
    SurfaceHit nearest;               ///< of what the sample can meet; its distance has no sign
    std::optional<SurfaceHit> entry;  ///< where the sample has come through it, or is just before
  };
  /// Where a sample that is at a place now has come to, its way begun within its own part.
  /// @param place [m], B  @param outward unit, of the sample, B
  /// @param depth that the way begins inside [m], besides how far the sample moved since it was
  /// found
  Found find(int sample, const Vector3& place, const Vector3& outward, double depth) noexcept;

 private:
  struct Seen {
    int nearest = 0;                  ///< triangle
    bool any = false;                 ///< it was found in some step
    Vector3 place = Vector3::Zero();  ///< [m], B
    double distance = 0.0;            ///< [m]
    DeformedSurface::Mark when;
  };

  const SelfReach& reach_;
  DeformedSurface& surface_;
  double ahead_;
  std::vector<Seen> seen_;  ///< of each sample
};

}  // namespace irdm
