#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trace/trace_writer.hpp"

namespace irdm {

/// The head of a trace file. Throws Error when it is none, or one that cannot be understood.
TraceHeader read_trace_header(const std::filesystem::path& path);

/// What it says of each object, in the scene's order: its models may differ. Throws Error.
std::vector<TraceObject> read_trace_objects(const std::filesystem::path& path,
                                            const std::vector<std::string>& names);

}  // namespace irdm
