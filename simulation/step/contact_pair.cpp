#include "simulation/step/contact_pair.hpp"

#include <algorithm>

namespace irdm {

void ContactPair::choose(std::vector<Candidate>& candidates) const noexcept {
  const std::size_t most = found_.size();
  if (candidates.size() <= most) return;
  const auto end = candidates.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(candidates.begin(), end, candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     if (a.pressed != b.pressed) return a.pressed;
                     if (a.depth != b.depth) return a.depth > b.depth;
                     return a.sample < b.sample;
                   });
  candidates.resize(most);
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.sample < b.sample; });
}

}  // namespace irdm
