#include <algorithm>

#include "common/wire/frame.hpp"
#include "tests/fuzz/mended_frames.hpp"
#include "tests/fuzz/seed_folder.hpp"

namespace irdm::fuzz {
namespace {

/// Of one end of a connection: frames in their order.
SeedBytes said(const std::vector<wire::Message>& messages, std::uint32_t session) {
  SeedBytes stream;
  std::uint64_t sequence = 0;
  for (const wire::Message& message : messages) {
    const bool greets = std::holds_alternative<wire::Hello>(message);
    const wire::FrameBytes frame =
        wire::encode_frame(message, greets ? 0 : session, sequence++, 1000);
    stream.insert(stream.end(), frame.view().begin(), frame.view().end());
  }
  return stream;
}

}  // namespace

void write_session_seeds(const Seeds& seeds) {
  const wire::Hello hello{.capabilities = 0x1F, .name = "bridge"};
  const StylusSample sample{.sequence = 3, .tip = Vector3(0.01, 0.02, 0.03)};
  seeds.write(
      "bridge_session", "whole",
      said({hello, wire::SampleMessage{.sample = sample}, wire::Report{},
            wire::AppliedForcesMessage{0, {.step = 102, .count = 3, .past = {}}}, wire::Goodbye{}},
           kFuzzedSession));
  const auto bridge_says = [&](const std::string& name, std::vector<wire::Message> messages) {
    messages.insert(messages.begin(), hello);
    seeds.write("bridge_session", name, said(messages, kFuzzedSession));
  };
  bridge_says("twice",
              {wire::SampleMessage{.sample = sample}, wire::SampleMessage{.sample = sample}});
  bridge_says("silent", {wire::SampleMessage{.sample = sample}});
  bridge_says("yields", {wire::SampleMessage{.sample = sample}, wire::Report{}});
  bridge_says("fast", std::vector<wire::Message>(30, wire::Report{}));
  bridge_says("hello_again", {hello});
  bridge_says("status", {wire::Status{}});
  bridge_says("others_sample", {wire::SampleMessage{.stylus = 3, .sample = sample}});
  bridge_says("others_forces",
              {wire::AppliedForcesMessage{3, {.step = 1, .count = 1, .past = {}}}});
  bridge_says("others_report", {wire::Report{.stylus = 3}});
  seeds.write("bridge_session", "no_hello", said({wire::Report{}}, 0));
  seeds.write("bridge_session", "many", said({wire::Hello{.styluses = 9}}, 0));
  const wire::Welcome welcome{.capabilities = 0xF, .session = 9, .dt = 0.002};
  const auto force = [](std::uint64_t step) {
    return wire::ForceMessage{
        .force = {.force_step = step, .sample_sequence = 5, .force = Vector3(0.5, 0, -1)}};
  };
  SeedBytes whole = {0};
  const SeedBytes stream = said({welcome, force(5), force(9), wire::ContactModelMessage{0, wall()},
                                 wire::Status{.steps = 9}, wire::Goodbye{}},
                                9);
  whole.insert(whole.end(), stream.begin(), stream.end());
  seeds.write("server_session", "whole", whole);
  SeedBytes unended(whole.begin(), whole.end() - wire::kHeaderSize - 4);  // no Goodbye
  seeds.write("server_session", "silent", unended);
  unended[0] = 2;
  seeds.write("server_session", "stopped", unended);
  SeedBytes untrue_model = {0};
  const SeedBytes models =
      said({welcome, wire::ContactModelMessage{0, untrue_models()[0]}, hello}, 9);
  untrue_model.insert(untrue_model.end(), models.begin(), models.end());
  seeds.write("server_session", "untrue_model", untrue_model);
  SeedBytes refused = {1};
  const SeedBytes refusal =
      said({wire::Refuse{.reason = wire::RefuseReason::kTooManyStyluses, .text = "no"}}, 0);
  refused.insert(refused.end(), refusal.begin(), refusal.end());
  seeds.write("server_session", "refused", refused);
}

}  // namespace irdm::fuzz
