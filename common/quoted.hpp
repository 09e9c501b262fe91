#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace irdm {

inline constexpr std::size_t kMostQuoted = 80;  ///< bytes of an input in a message

/// Words of an input for a message: what is beyond `most` bytes becomes "...", and each byte that
/// is no character, or one of control, "?".
std::string shortened(std::string_view words, std::size_t most = kMostQuoted);
/// The same, 'in quotes'.
std::string in_quotes(std::string_view words);

}  // namespace irdm
