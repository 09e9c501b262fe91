#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace irdm {

/// The word of a list that was probably meant: as few letters as possible have to be put in, left
/// out, replaced or swapped with the next one, at most one in three. Nothing where no word is so
/// near. Case does not count.
std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& words);

}  // namespace irdm
