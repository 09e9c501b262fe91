#pragma once

#include <boost/align/aligned_allocator.hpp>
#include <vector>

namespace irdm {

/// Numbers of which the first begins a line of the cache, so that no wide register has to be filled
/// from two of them: that is up to half of the time of a kernel. (Of several rows the others begin
/// one, too, if a row has a multiple of eight numbers.)
using AlignedNumbers = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

}  // namespace irdm
