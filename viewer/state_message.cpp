#include <algorithm>
#include <array>

#include "common/utf8.hpp"
#include "viewer/message_parts.hpp"

namespace irdm::viewer {
namespace {

void put_percentiles(Writer& writer, const Percentiles& value) {
  for (const float part : {value.p50, value.p99, value.max}) writer.put(part);
}

Percentiles get_percentiles(Reader& reader) {
  const float p50 = reader.get_single();
  const float p99 = reader.get_single();
  return {p50, p99, reader.get_single()};
}

}  // namespace

Bytes encode(const Health& health) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kHealth);
  writer.put(health.steps);
  put_percentiles(writer, health.step_time);
  put_percentiles(writer, health.wakeup_delay);
  for (const std::uint64_t count :
       {health.missed, health.unsolved, health.resets, health.lost_steps}) {
    writer.put(count);
  }
  writer.put(health.surface_rate);
  writer.put(health.viewers);
  for (const std::uint64_t count : {health.sessions, health.samples, health.forces,
                                    health.forces_replaced, health.protocol_errors}) {
    writer.put(count);
  }
  writer.put(static_cast<std::uint16_t>(health.links.size()));
  writer.put_zeros(6);
  for (const LinkHealth& link : health.links) {
    writer.put(std::uint32_t{link.reported ? 1U : 0U});
    put_percentiles(writer, link.round_trip);
    put_percentiles(writer, link.age);
    writer.put_zeros(4);
  }
  return bytes;
}

Health decode_health(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  expect_type(reader, Type::kHealth);
  Health health;
  health.steps = reader.get<std::uint64_t>();
  health.step_time = get_percentiles(reader);
  health.wakeup_delay = get_percentiles(reader);
  for (std::uint64_t* count :
       {&health.missed, &health.unsolved, &health.resets, &health.lost_steps}) {
    *count = reader.get<std::uint64_t>();
  }
  health.surface_rate = reader.get_single();
  health.viewers = reader.get<std::uint32_t>();
  for (std::uint64_t* count : {&health.sessions, &health.samples, &health.forces,
                               &health.forces_replaced, &health.protocol_errors}) {
    *count = reader.get<std::uint64_t>();
  }
  const auto links = reader.get<std::uint16_t>();
  if (links > kMaxStyluses) throw MessageError("a count is out of range");
  reader.skip(6);
  for (std::uint16_t i = 0; i < links; ++i) {
    LinkHealth& link = health.links.emplace_back();
    link.reported = reader.get<std::uint32_t>() == 1;
    link.round_trip = get_percentiles(reader);
    link.age = get_percentiles(reader);
    reader.skip(4);
  }
  reader.finish();
  return health;
}

namespace {

/// The flags of a State, bit by bit.
template <typename AnyState>
auto flags_of(AnyState& state) {
  return std::array{&state.looks_on,   &state.stylus_free, &state.holds_stylus, &state.paused,
                    &state.recording,  &state.playback,    &state.playing,      &state.can_record,
                    &state.has_scenes, &state.can_load,    &state.preparing};
}

void put_scenes(Writer& writer, std::span<const std::string> scenes) {
  for (const std::string& scene : scenes) {
    const std::string name = as_utf8(scene, kMaxSceneName);
    writer.put(static_cast<std::uint16_t>(name.size()));
    writer.put_text(name);
  }
}

std::vector<std::string> get_scenes(Reader& reader, std::size_t count) {
  std::vector<std::string> scenes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto length = reader.get<std::uint16_t>();
    if (length > kMaxSceneName) throw MessageError("a name is too long");
    scenes.push_back(reader.get_text(length));
  }
  return scenes;
}

}  // namespace

Bytes encode(const State& state) {
  Bytes bytes;
  Writer writer(bytes);
  put_header(writer, Type::kState);
  std::uint32_t flags = 0;
  std::uint32_t bit = 1;
  for (const bool* flag : flags_of(state)) {
    if (*flag) flags |= bit;
    bit <<= 1U;
  }
  const std::string notice = as_utf8(state.notice, kMaxNotice);
  const std::size_t recordings = std::min(state.recordings.size(), kMaxRecordings);
  const std::size_t scenes = std::min(state.scenes.size(), kMaxScenes);
  writer.put(flags);
  writer.put(state.settings_changes);
  writer.put(state.length);
  writer.put(state.speed);
  writer.put(state.shown);
  writer.put(static_cast<std::uint16_t>(recordings));
  writer.put(static_cast<std::uint16_t>(notice.size()));
  writer.put(static_cast<std::uint16_t>(scenes));
  writer.put(state.scene);
  writer.put_zeros(6);
  writer.put(state.settings.gravity);
  for (std::size_t i = 0; i < state.choices.size(); ++i) {
    put_settings(writer, state.settings.object[i], state.choices[i]);
  }
  for (std::size_t i = 0; i < recordings; ++i) {
    const std::string name = as_utf8(state.recordings[i].name, kMaxRecordingName);
    writer.put(state.recordings[i].number);
    writer.put(static_cast<std::uint16_t>(name.size()));
    writer.put_text(name);
    writer.put_zeros(kMaxRecordingName - name.size());
  }
  put_scenes(writer, std::span(state.scenes).first(scenes));
  writer.put_text(notice);
  writer.align();
  return bytes;
}

State decode_state(std::span<const std::uint8_t> bytes, std::size_t objects) {
  Reader reader(bytes);
  expect_type(reader, Type::kState);
  State state;
  auto flags = reader.get<std::uint32_t>();
  for (bool* flag : flags_of(state)) {
    *flag = (flags & 1U) != 0;
    flags >>= 1U;
  }
  state.settings_changes = reader.get<std::uint32_t>();
  state.length = reader.get_double();
  state.speed = reader.get_double();
  state.shown = reader.get<std::uint16_t>();
  const auto recordings = reader.get<std::uint16_t>();
  const auto notice = reader.get<std::uint16_t>();
  const auto scenes = reader.get<std::uint16_t>();
  if (recordings > kMaxRecordings || notice > kMaxNotice || scenes > kMaxScenes) {
    throw MessageError("a count is out of range");
  }
  state.scene = reader.get<std::uint16_t>();
  reader.skip(6);
  state.settings.gravity = get_bounded_vector(reader, kMostGravity);
  for (std::size_t i = 0; i < objects; ++i) {
    state.settings.object.at(i) = get_settings(reader, state.choices.emplace_back());
  }
  for (std::uint16_t i = 0; i < recordings; ++i) {
    const auto number = reader.get<std::uint16_t>();
    const auto length = reader.get<std::uint16_t>();
    if (length > kMaxRecordingName) throw MessageError("a name is too long");
    state.recordings.push_back({number, reader.get_text(length)});
    reader.skip(kMaxRecordingName - length);
  }
  state.scenes = get_scenes(reader, scenes);
  state.notice = reader.get_text(notice);
  reader.align();
  reader.finish();
  return state;
}

}  // namespace irdm::viewer
