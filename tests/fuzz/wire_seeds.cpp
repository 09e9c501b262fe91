#include <algorithm>
#include <limits>

#include "common/wire/frame.hpp"
#include "tests/fuzz/mended_frames.hpp"
#include "tests/fuzz/seed_folder.hpp"

namespace irdm::fuzz {

ContactModel wall() {
  ContactModel model;
  model.valid = true;
  model.step = 100;
  model.newest = 101;
  model.dt = 0.002;
  model.horizon = 25;
  model.body = {1.0, 1e-3 * Matrix3::Identity(), Support::kFixed};
  model.normal = Vector3(0, 1, 0);
  model.friction = {0.6, 0.5};
  for (std::size_t n = 0; n < 25; ++n) {
    model.response[n] = 1e-3 / static_cast<double>(n + 1) * Matrix3::Identity();
  }
  return model;
}

namespace {

using Change = void (*)(ContactModel&);

}  // namespace

std::vector<ContactModel> untrue_models() {
  const Change changes[] = {
      [](ContactModel& it) { it.body.mass = 1e-9; },
      [](ContactModel& it) { it.body.inertia(0, 0) = -1.0; },
      [](ContactModel& it) { it.motion.position.x() = 1e6; },
      [](ContactModel& it) { it.normal *= 2.0; },
      [](ContactModel& it) { it.friction.kinetic = 7.0; },
      [](ContactModel& it) { it.response[0] *= -1.0; },
      [](ContactModel& it) { it.response[0] *= 1e9; },
      [](ContactModel& it) { it.response[3] *= 1e3; },
      [](ContactModel& it) { it.path[2].x() = 1e6; },
      [](ContactModel& it) { it.dt = 5.0; },
      [](ContactModel& it) { it.normal.x() = std::numeric_limits<double>::quiet_NaN(); },
  };
  std::vector<ContactModel> models;
  for (const Change change : changes) change(models.emplace_back(wall()));
  return models;
}

void add_record(SeedBytes& records, std::uint8_t kind, std::size_t number,
                std::span<const std::uint8_t> bytes) {
  records.push_back(kind);
  records.push_back(static_cast<std::uint8_t>(number % 256));
  records.push_back(static_cast<std::uint8_t>(number / 256));
  records.insert(records.end(), bytes.begin(), bytes.end());
}

namespace {

void write_contact_models(const Seeds& seeds) {
  ContactModel model = wall();
  const auto write = [&](const std::string& name) {
    const wire::FrameBytes frame = wire::encode_frame(wire::ContactModelMessage{0, model}, 7, 1, 2);
    seeds.write("contact_model", name, frame.view().subspan(wire::kHeaderSize));
  };
  write("touching_fixed");
  model.body.support = Support::kFloating;
  model.state = ContactState::kHeld;
  model.motion.angular_momentum = Vector3(0, 1e-3, 0);
  model.free_forces.gravity = Vector3(0, -9.81, 0);
  model.missing = 6;
  write("held_floating");
  model.valid = false;
  model.paused = true;
  write("standing");
  int number = 0;
  for (const ContactModel& each : untrue_models()) {
    model = each;
    write("untrue_" + std::to_string(number++));
  }
}

/// A frame with the byte before it that has its checksum mended.
SeedBytes framed(const wire::Message& message) {
  const wire::FrameBytes frame = wire::encode_frame(message, 7, 1, 1000);
  SeedBytes bytes(1 + frame.size, 0);
  std::copy(frame.view().begin(), frame.view().end(), bytes.begin() + 1);
  return bytes;
}

void write_wire_frames(const Seeds& seeds) {
  const wire::Message messages[] = {
      wire::Hello{.name = "bridge"},
      wire::Welcome{.session = 7, .dt = 0.002},
      wire::Refuse{.reason = wire::RefuseReason::kNoFreeStylus, .text = "all in use"},
      wire::Goodbye{},
      wire::SampleMessage{.sample = {.sequence = 3, .tip = Vector3(0.01, 0.02, 0.03)}},
      wire::ForceMessage{.force = {.force_step = 5, .force = Vector3(0.5, 0, -1)}},
      wire::Report{.round_trip = {900.0F, 1500.0F, 3000.0F}},
      wire::ContactModelMessage{0, wall()},
      wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}},
      wire::Status{.steps = 9},
      wire::Datagrams{.port = 4000},
  };
  SeedBytes stream = {0};
  for (const wire::Message& message : messages) {
    const wire::FrameBytes frame = wire::encode_frame(message, 7, 1, 1000);
    SeedBytes single(1 + frame.size, 5);
    std::copy(frame.view().begin(), frame.view().end(), single.begin() + 1);
    stream.insert(stream.end(), frame.view().begin(), frame.view().end());
    seeds.write("wire_frames", "type_" + std::to_string(static_cast<int>(wire::type_of(message))),
                single);
  }
  seeds.write("wire_frames", "all", stream);
  seeds.write(
      "wire_frames", "type_6_torque",
      framed(wire::ForceMessage{.force = {.torque = Vector3(0, 0.1, 0)}, .with_torque = true}));
  SeedBytes flags = framed(wire::ContactModelMessage{0, wall()});
  flags[1 + wire::kHeaderSize + 3] = 0xFF;
  seeds.write("wire_frames", "unknown_flags", flags);
  SeedBytes horizon = framed(wire::ContactModelMessage{0, wall()});
  horizon[1 + wire::kHeaderSize + 7] = 0xFF;
  seeds.write("wire_frames", "far_horizon", horizon);
  int number = 0;
  for (const ContactModel& model : untrue_models()) {
    seeds.write("wire_frames", "untrue_" + std::to_string(number++),
                framed(wire::ContactModelMessage{0, model}));
  }
  seeds.write("wire_frames", "no_forces", framed(wire::AppliedForcesMessage{0, {}}));
  seeds.write("wire_frames", "too_early",
              framed(wire::AppliedForcesMessage{0, {.step = 2, .count = 4, .past = {}}}));
}

void write_datagrams(const Seeds& seeds) {
  constexpr std::uint8_t kForeign = 0, kSealed = 1, kFrame = 2, kAgain = 3, kSpoilt = 4, kLost = 5;
  SeedBytes all;
  for (const wire::Message& message :
       {wire::Message(wire::SampleMessage{.sample = {.sequence = 3}}),
        wire::Message(wire::ContactModelMessage{0, wall()}),
        wire::Message(wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}}),
        wire::Message(wire::ForceMessage{.force = {.force_step = 5}}),
        wire::Message(wire::Report{})}) {
    const wire::FrameBytes frame = wire::encode_frame(message, kFuzzedSession, 1, 1000);
    add_record(all, kFrame, frame.size, frame.view());
    add_record(all, kLost, 3);
  }
  const wire::PartText probe = wire::probe_text();
  add_record(all, kSealed, probe.size, probe.view());
  add_record(all, kAgain, 0);
  add_record(all, kSpoilt, 100);
  SeedBytes forged(28);
  forged[0] = kFuzzedSession;
  add_record(all, kForeign, forged.size(), forged);
  add_record(all, kForeign, 5, SeedBytes(5, 1));
  seeds.write("datagrams", "all", all);
  const auto text = [&](const std::string& name, std::vector<SeedBytes> texts) {
    SeedBytes records;
    for (const SeedBytes& each : texts) add_record(records, kSealed, each.size(), each);
    seeds.write("datagrams", name, records);
  };
  const auto part = [](std::uint8_t number, std::uint8_t of, std::size_t size) {
    SeedBytes bytes(wire::kPartHeaderSize + size, 0x49);
    bytes[0] = number;
    bytes[1] = of;
    return bytes;
  };
  text("empty", {{}});
  text("cut", {part(0, 3, 100)});
  text("beyond", {part(3, 3, 100)});
  text("misfits", {part(0, 3, wire::kLargestPart), part(1, 4, wire::kLargestPart)});
  text("no_frame", {part(0, 1, 100)});
  text("many", std::vector<SeedBytes>(20, part(0, 2, wire::kLargestPart)));
  const wire::FrameBytes goodbye = wire::encode_frame(wire::Goodbye{}, kFuzzedSession, 1, 0);
  SeedBytes more = part(0, 1, goodbye.size + 1);
  std::copy(goodbye.view().begin(), goodbye.view().end(),
            more.begin() + static_cast<std::ptrdiff_t>(wire::kPartHeaderSize));
  text("more", {more});
}

}  // namespace

void write_wire_seeds(const Seeds& seeds) {
  write_wire_frames(seeds);
  write_datagrams(seeds);
  write_contact_models(seeds);
}

}  // namespace irdm::fuzz
