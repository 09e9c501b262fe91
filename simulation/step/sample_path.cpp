#include "simulation/step/sample_path.hpp"

#include <algorithm>

namespace irdm {

void SamplePath::add(const Vector3& tip) noexcept {
  if (tip == (count_ > 0 ? sample(count_ - 1) : at_)) return;
  if (count_ == kKept) {
    at_ = sample(0);
    drop_first();
  }
  samples_[(first_ + count_++) % kKept] = tip;
}

// Part i of the way leads to sample i.
SamplePath::Place SamplePath::nearest_of_part(std::size_t i, const Vector3& told) const noexcept {
  const Vector3& from = i > 0 ? sample(i - 1) : at_;
  const Vector3& to = sample(i);
  const Vector3 way = to - from;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? (told - from).dot(way) / square : 1.0;
  if (share >= 1.0) return {to, i + 1};
  return {from + std::max(share, 0.0) * way, i};
}

// The first place as near, on from there as long as it comes nearer.
SamplePath::Place SamplePath::nearest(const Vector3& told) const noexcept {
  Place place{at_, 0};
  double distance = (told - at_).norm();
  double least = distance;
  for (std::size_t i = 0; i < count_; ++i) {
    least = std::min(least, (told - nearest_of_part(i, told).point).norm());
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Place next = nearest_of_part(i, told);
    const double there = (told - next.point).norm();
    if (distance <= least + kAsNear && there >= distance) break;
    place = next;
    distance = there;
  }
  return place;
}

const Vector3& SamplePath::follow(const Vector3& told, double longest) noexcept {
  const Place place = nearest(told);
  for (std::size_t i = 0; i <= place.next; ++i) {
    const bool last = i == place.next;
    const Vector3 way = (last ? place.point : sample(0)) - at_;
    const double length = way.norm();
    if (length > longest) return at_ += longest / length * way;
    longest -= length;
    at_ = last ? place.point : sample(0);
    if (!last) drop_first();
  }
  return at_;
}

}  // namespace irdm
