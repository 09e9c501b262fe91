#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace irdm {

/// Whether all bytes are characters of UTF-8 (RFC 3629: no overlong forms, no surrogates).
bool is_utf8(std::string_view text);

/// Returns UTF-8 of at most `most` bytes: a byte that belongs to no character becomes '?', and what
/// does not fit is cut off behind a whole character.
std::string as_utf8(std::string_view text, std::size_t most);

}  // namespace irdm
