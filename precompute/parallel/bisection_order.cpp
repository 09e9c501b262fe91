#include "precompute/parallel/bisection_order.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace irdm::precompute {
namespace {

constexpr std::size_t kSmallest = 4;

int longest_axis(const Points& points, std::span<const int> some) {
  Eigen::RowVector3d low = points.row(some.front());
  Eigen::RowVector3d high = low;
  for (const int i : some) {
    low = low.cwiseMin(points.row(i));
    high = high.cwiseMax(points.row(i));
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

void bisect(const Points& points, std::span<int> some) {
  if (some.size() <= kSmallest) return;
  const int axis = longest_axis(points, some);
  const std::size_t half = some.size() / 2;
  const auto before = [&](int a, int b) {
    return std::pair(points(a, axis), a) < std::pair(points(b, axis), b);
  };
  std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(half), some.end(),
                   before);
  bisect(points, some.first(half));
  bisect(points, some.subspan(half));
}

}  // namespace

std::vector<int> bisection_order(const Points& points) {
  std::vector<int> order(static_cast<std::size_t>(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  bisect(points, order);
  return order;
}

}  // namespace irdm::precompute
