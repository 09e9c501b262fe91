#pragma once

#include <span>

#include "common/geometry.hpp"

namespace irdm {

/// Where an engine gets columns of R that are not all in memory. The columns of a surface node are
/// those of the forces on it, three of them: entry (a, 3 node + axis) of R[s] stands at
/// (axis * 3n + a) * T + s, in the numbers of R.
///
/// Several engines, each in its own thread, may share one. Real-time safe where a run in real time
/// asks.
class ColumnSupply {
 public:
  virtual ~ColumnSupply() = default;

  /// The columns of a node, which stay where they are until they are given back as often as they
  /// were taken. Null: they are not there, or not yet; whoever goes on asking gets them before
  /// others.
  virtual const void* acquire(int node) noexcept = 0;
  virtual void release(int node) noexcept = 0;
  /// Of how many nodes an engine may have the columns at a time.
  virtual int share() const noexcept = 0;
  /// Where tips are: what is near them is wanted next. Of one engine's thread only.
  /// @param tips [m], B
  virtual void prefetch(std::span<const Vector3> tips) noexcept = 0;
};

}  // namespace irdm
