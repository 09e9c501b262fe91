#pragma once

#include <random>

#include "common/geometry.hpp"

namespace irdm::test {

using Random = std::mt19937;

inline double between(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

inline bool chance(Random& random, double share) {
  return between(random, 0.0, 1.0) < share;
}

/// Each coordinate between -reach and reach.
inline Vector3 anywhere(Random& random, double reach) {
  return {between(random, -reach, reach), between(random, -reach, reach),
          between(random, -reach, reach)};
}

}  // namespace irdm::test
