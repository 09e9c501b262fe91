#pragma once

#include <string>

namespace irdm::trace {

/// Unit of a trace's dataset, by the last part of its path; empty: it has none (numbers of things,
/// flags). "1": a number without unit.
std::string unit_of(const std::string& path);

}  // namespace irdm::trace
