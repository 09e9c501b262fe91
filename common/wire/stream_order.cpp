#include "common/wire/stream_order.hpp"

#include <optional>

namespace irdm::wire {
namespace {

struct Place {
  std::size_t kind = 0;
  std::size_t stylus = 0;
};

std::optional<Place> place_of(const Message& message) noexcept {
  if (const auto* sample = std::get_if<SampleMessage>(&message)) return Place{0, sample->stylus};
  if (const auto* force = std::get_if<ForceMessage>(&message)) return Place{1, force->stylus};
  if (const auto* model = std::get_if<ContactModelMessage>(&message)) {
    return Place{2, model->stylus};
  }
  if (const auto* applied = std::get_if<AppliedForcesMessage>(&message)) {
    return Place{3, applied->stylus};
  }
  return std::nullopt;
}

}  // namespace

bool is_of_stream(const Message& message) noexcept {
  return place_of(message).has_value();
}

// A stylus that no server has is for the session to refuse.
bool StreamOrder::take(const Frame& frame) noexcept {
  const std::optional<Place> place = place_of(frame.message);
  if (!place || place->stylus >= kStyluses) return true;
  std::optional<std::uint64_t>& newest = newest_[place->kind][place->stylus];
  if (newest && frame.header.sequence <= *newest) return false;
  newest = frame.header.sequence;
  return true;
}

}  // namespace irdm::wire
