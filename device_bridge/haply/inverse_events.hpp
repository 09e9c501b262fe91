#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace irdm::haply {

/// What an event of the service means for a device. Of the others none is made.
enum class EventMeaning {
  kLost,      ///< unplugged, or it no longer answers the service
  kLocked,    ///< its emergency brake is engaged
  kUnlocked,  ///< and released
  kNotice,    ///< something that a person should know
};

struct InverseEvent {
  EventMeaning meaning = EventMeaning::kNotice;
  std::string device = {};  ///< its id; a grip's, or none, in a notice
  std::string text = {};    ///< the service's, for a person
};

/// An event of the channel of services from 3.5 on, as docs.haply.co/inverseSDK/service/events has
/// them: JSON with name, level, data and message. None: it is of no use here, or not understood.
/// Pure.
std::optional<InverseEvent> decode_event(std::string_view text);

}  // namespace irdm::haply
