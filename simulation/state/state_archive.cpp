#include "simulation/state/state_archive.hpp"

#include <cstring>

#include "common/error.hpp"

namespace irdm {
namespace {

[[noreturn]] void refuse() {
  throw Error("state", "is not one of this scene", "load it into the scene that it was saved from");
}

}  // namespace

void StateArchive::bytes(std::byte* first, std::size_t count) {
  if (count == 0) return;
  if (!reading_) {
    written_.insert(written_.end(), first, first + count);
    return;
  }
  if (left_.size() < count) refuse();
  std::memcpy(first, left_.data(), count);
  left_ = left_.subspan(count);
}

std::size_t StateArchive::size(std::size_t now, std::size_t most) {
  std::uint64_t count = now;
  value(count);
  if (count > most) refuse();
  return static_cast<std::size_t>(count);
}

void StateArchive::same(std::uint64_t number) {
  std::uint64_t there = number;
  value(there);
  if (there != number) refuse();
}

void StateArchive::end() const {
  if (reading_ && !left_.empty()) refuse();
}

}  // namespace irdm
