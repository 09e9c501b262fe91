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

}  // namespace irdm::viewer
