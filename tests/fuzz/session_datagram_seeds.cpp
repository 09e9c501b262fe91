// What happens in sessions with datagrams.
#include "common/wire/frame.hpp"
#include "tests/fuzz/mended_frames.hpp"
#include "tests/fuzz/seed_folder.hpp"

namespace irdm::fuzz {
namespace {

/// What happens in a session with datagrams, in its order.
class Events {
 public:
  explicit Events(std::uint8_t options) : bytes_{options} {}

  Events& stream(std::span<const std::uint8_t> bytes) { return add(0, bytes.size(), bytes); }
  /// The frame has a number of its own.
  Events& stream(const wire::Message& message, std::uint32_t session = kFuzzedSession) {
    return stream(wire::encode_frame(message, session, ++sequence_ + kGreetings, 1000).view());
  }
  Events& sealed(std::span<const std::uint8_t> text) { return add(1, text.size(), text); }
  Events& frame(const wire::Message& message) {
    const wire::FrameBytes bytes = wire::encode_frame(message, kFuzzedSession, ++sequence_, 1000);
    return add(2, bytes.size, bytes.view());
  }
  Events& foreign(std::span<const std::uint8_t> bytes) { return add(3, bytes.size(), bytes); }
  Events& again() { return add(4, 0); }
  Events& spoilt(std::size_t bit) { return add(5, bit); }
  Events& lost(std::size_t count) { return add(6, count); }
  /// The next frame gets this number and one.
  Events& at(std::uint64_t sequence) {
    sequence_ = sequence;
    return *this;
  }
  Events& traffic(std::size_t number) { return add(7, number); }
  Events& time(std::size_t milliseconds) { return add(8, milliseconds); }
  const SeedBytes& bytes() const { return bytes_; }

 private:
  static constexpr std::uint64_t kGreetings = 2;
  Events& add(std::uint8_t kind, std::size_t number, std::span<const std::uint8_t> bytes = {}) {
    add_record(bytes_, kind, number, bytes);
    return *this;
  }

  SeedBytes bytes_;
  std::uint64_t sequence_ = 0;
};

wire::Message sample(std::uint64_t sequence, std::uint16_t stylus = 0) {
  return wire::SampleMessage{stylus, {.sequence = sequence, .tip = Vector3(0.01, 0.02, 0.03)}};
}

void write_bridge_datagrams(const Seeds& seeds) {
  const auto write = [&](const std::string& name, const Events& events) {
    seeds.write("bridge_datagrams", name, events.bytes());
  };
  const wire::PartText probe = wire::probe_text();
  const SeedBytes anything(60, 7);
  write("whole", Events(0)
                     .sealed(probe.view())
                     .again()
                     .spoilt(300)
                     .foreign(anything)
                     .frame(sample(3))
                     .frame(sample(4, 1))
                     .lost(3)
                     .traffic(0)
                     .frame(wire::AppliedForcesMessage{0, {.step = 9, .count = 3, .past = {}}})
                     .frame(wire::Report{})
                     .frame(sample(3))
                     .traffic(0)
                     .time(10)
                     .stream(wire::Goodbye{})
                     .frame(sample(9)));
  write("not_finite", Events(0).frame(sample(3)).traffic(1).traffic(1));
  write("by_tcp", Events(2).stream(sample(3)).traffic(0).traffic(0).stream(sample(3)));
  write("overtaken",
        Events(0).at(10).frame(sample(9)).at(0).stream(sample(3)).stream(wire::Report{}));
  write("no_part", Events(0).sealed(std::span(anything).first(2)).traffic(0));
  write("goodbye", Events(0).frame(wire::Goodbye{}));
  write("others_sample", Events(0).frame(sample(3, 9)));
  write("lockstep", Events(1).stream(sample(1)).traffic(0).stream(sample(2)).time(5000));
  write("no_lockstep", Events(1 | 32).stream(sample(1)));
  write("no_stylus", Events(4).time(10).time(2000));
  write("makes_room", Events(4 | 8).frame(sample(3)).traffic(0));
  write("silent", Events(0).frame(sample(3)).time(1000).time(1200).time(2000));
  write("yields", Events(0).frame(sample(3)).time(41).time(61).time(61));
  write("partial", Events(0).stream(std::span(anything).first(9)).time(400).time(2002));
  write("no_hello", Events(16).time(2000).time(4000));
  write("displaced", Events(16 | 128).time(10));
  Events fast(0);
  for (int i = 0; i < 40; ++i) fast.sealed(probe.view().first(8));
  write("fast_parts", fast);
  Events probes(0);
  for (int i = 0; i < 30; ++i) probes.sealed(SeedBytes(wire::kLargestText, 0));
  write("fast_probes", probes);
  Events deaf(2);
  deaf.stream(sample(3));
  for (int i = 0; i < 1200; ++i) deaf.traffic(0);
  write("does_not_read", deaf.time(700).time(1300));
}

void write_server_datagrams(const Seeds& seeds) {
  const auto write = [&](const std::string& name, const Events& events) {
    seeds.write("server_datagrams", name, events.bytes());
  };
  const auto force = [](std::uint64_t step, std::uint64_t sequence) {
    return wire::ForceMessage{
        .force = {.force_step = step, .sample_sequence = sequence, .force = Vector3(0.5, 0, -1)}};
  };
  ContactModel model = wall();
  model.dt = 1.0;
  const wire::PartText probe = wire::probe_text();
  const SeedBytes anything(60, 7);
  constexpr std::size_t kThisSession = 1 + 16;
  write("whole", Events(0)
                     .traffic(kThisSession)
                     .sealed(probe.view())
                     .again()
                     .spoilt(300)
                     .foreign(anything)
                     .traffic(kThisSession)
                     .frame(force(5, 3))
                     .lost(3)
                     .frame(wire::ContactModelMessage{0, model})
                     .frame(wire::ContactModelMessage{0, wall()})
                     .frame(wire::Status{.steps = 9})
                     .traffic(2)
                     .time(1100)
                     .traffic(kThisSession)
                     .stream(wire::Goodbye{})
                     .time(600));
  write("no_part", Events(0).sealed(std::span(anything).first(2)));
  write("no_answer", Events(0).time(100).time(600).traffic(kThisSession).stream(force(5, 1)));
  write("unarmed", Events(0).traffic(1).time(0).time(5000).time(600));
  write("by_tcp", Events(4).traffic(kThisSession).stream(force(5, 1)).time(1500));
  write("has_none", Events(16 | 64).traffic(kThisSession).stream(force(5, 1)));
  write("offered_twice", Events(0).stream(wire::Datagrams{.port = 9}));
  write("not_asked", Events(4).traffic(1));
  write("no_answer_to_hello", Events(8).time(100).time(100));
  write("partial", Events(0).stream(std::span(anything).first(9)).time(2000).time(600));
  write("lockstep", Events(1 | 32).traffic(kThisSession).stream(force(5, 1)).time(9000));
  write("lockstep_not_offered", Events(32).time(10));
  write("stopped", Events(128).frame(force(5, 1)));
  write("does_not_predict", Events(2).frame(wire::ContactModelMessage{0, model}));
}

}  // namespace

void write_session_datagram_seeds(const Seeds& seeds) {
  write_bridge_datagrams(seeds);
  write_server_datagrams(seeds);
}

}  // namespace irdm::fuzz
