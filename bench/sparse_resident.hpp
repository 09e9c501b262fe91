#pragma once

#include <vector>

#include "common/model/model.hpp"

namespace irdm::bench {

/// A dense response of which only some columns are there: room is set aside for all of R, whatever
/// the memory of the machine, and takes memory where it is written to. So objects can be measured
/// whose R is far larger than memory, as long as contacts stay on the nodes that are there. The
/// numbers elsewhere are zero and cost nothing to read.
/// @param nodes surface nodes whose columns are there, with numbers of any kind that decay
template <typename Scalar>
DenseResponse sparse_resident(int degrees_of_freedom, int steps, const std::vector<int>& nodes);

/// Room for that many numbers alone: the vector's capacity, not its size.
template <typename Scalar>
std::vector<Scalar> sparse_numbers(std::size_t count);

}  // namespace irdm::bench
