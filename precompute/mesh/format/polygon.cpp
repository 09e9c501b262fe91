#include "precompute/mesh/format/polygon.hpp"

#include <numeric>

namespace irdm::precompute {
namespace {

// Area vector by Newell's sum, which does not depend on the first corner.
Vector3 area(const std::vector<Vector3>& corners) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 a = corners[i] - corners[0];
    const Vector3 b = corners[(i + 1) % corners.size()] - corners[0];
    sum += a.cross(b);
  }
  return sum;
}

// Twice the signed area of a triangle, seen against the normal.
double turn(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& normal) {
  const Vector3 along = b - a;
  const Vector3 across = c - a;
  return along.cross(across).dot(normal);
}

bool holds(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& point,
           const Vector3& normal) {
  return turn(a, b, point, normal) >= 0.0 && turn(b, c, point, normal) >= 0.0 &&
         turn(c, a, point, normal) >= 0.0;
}

class EarClipping {
 public:
  EarClipping(const std::vector<Vector3>& corners, const Vector3& normal)
      : corners_(corners), normal_(normal), left_(corners.size()) {
    std::iota(left_.begin(), left_.end(), 0);
  }

  std::vector<std::array<int, 3>> run() {
    std::vector<std::array<int, 3>> triangles;
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.push_back(triangle_at(ear));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  std::array<int, 3> triangle_at(std::size_t i) const {
    const std::size_t n = left_.size();
    return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
  }

  const Vector3& corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }

  bool is_ear(std::size_t i) const {
    const auto [a, b, c] = triangle_at(i);
    if (!(turn(corner(a), corner(b), corner(c), normal_) > 0.0)) return false;
    for (const int other : left_) {
      if (other == a || other == b || other == c) continue;
      const Vector3& point = corner(other);
      // Corners of a keyhole stand at one place twice.
      if (point == corner(a) || point == corner(b) || point == corner(c)) continue;
      if (holds(corner(a), corner(b), corner(c), point, normal_)) return false;
    }
    return true;
  }

  // The first ear; where rounding leaves none, the first corner that is not turned inwards.
  std::size_t find_ear() const {
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (is_ear(i)) return i;
    }
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const auto [a, b, c] = triangle_at(i);
      if (turn(corner(a), corner(b), corner(c), normal_) >= 0.0) return i;
    }
    return 0;
  }

  const std::vector<Vector3>& corners_;
  Vector3 normal_;
  std::vector<int> left_;
};

bool is_convex(const std::vector<Vector3>& corners, const Vector3& normal) {
  const std::size_t n = corners.size();
  // Rounding of a corner on a straight edge is no bend inwards.
  const double rounding = 1e-9 * normal.squaredNorm();
  for (std::size_t i = 0; i < n; ++i) {
    const double bend = turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n], normal);
    if (bend < -rounding) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> cut_polygon(const std::vector<Vector3>& corners) {
  const Vector3 normal = area(corners);
  if (corners.size() > 3 && !is_convex(corners, normal)) return EarClipping(corners, normal).run();
  std::vector<std::array<int, 3>> fan;
  for (int i = 2; i < static_cast<int>(corners.size()); ++i) fan.push_back({0, i - 1, i});
  return fan;
}

}  // namespace irdm::precompute
