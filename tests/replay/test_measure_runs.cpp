// What compare says of two runs that were made so that the answers are known: a tap that lets a
// node ring.
#include <nlohmann/json.hpp>
#include <numbers>

#include "replay/compare/comparison_output.hpp"
#include "replay/output/run_output.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

/// A stylus presses node 5 in along y and lets go; then it rings.
struct StruckRun {
  int onset = 100;           ///< first frame with a force
  double force = 1.0;        ///< [N]
  double compliance = 5e-3;  ///< [m/N]
  double frequency = 12.0;   ///< that is heard [Hz]
  double decay = 4.0;        ///< [1/s]
  double interval = 0.002;   ///< between frames [s]
};

constexpr int kFrames = 800;
constexpr int kRelease = 300;
constexpr int kTapped = 5;

TracedScene tapped_cube() {
  TracedScene scene;
  scene.objects = {{"cube", "cube.h5", "sum", ResponseKind::kModal}};
  scene.config.objects.resize(1);
  scene.config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  scene.config.styluses.resize(1);
  return scene;
}

double displacement(const StruckRun& tap, int k) {
  const double pressed = tap.compliance * tap.force;
  if (k < tap.onset) return 0.0;
  if (k < kRelease) return -pressed;
  const double t = (k - kRelease) * tap.interval;
  return -pressed * std::exp(-tap.decay * t) * std::cos(2 * std::numbers::pi * tap.frequency * t);
}

void write_tap(const std::filesystem::path& path, const StruckRun& tap) {
  const TracedScene scene = tapped_cube();
  RunOutput output(path, scene, {"trace.h5", "inputs"});
  const int nodes = scene.config.objects[0].model->mesh.surface_node_count();
  const Quaternion Q = rotation_from_vector(Vector3(0.0, 0.0, 0.5 * std::numbers::pi));
  for (int k = 0; k < kFrames; ++k) {
    StepRecord record;
    record.object_count = record.stylus_count = 1;
    record.time = tap.interval * (k + 1);
    record.object[0].orientation = Q;
    const bool pressed = k >= tap.onset && k < kRelease;
    record.stylus[0].force = Q * Vector3(0.0, pressed ? tap.force : 0.0, 0.0);
    std::vector<Points> u(1, Points::Zero(nodes, 3));
    u[0](kTapped, 1) = displacement(tap, k);
    output.put({record, u});
  }
  output.finish();
}

struct TwoTaps {
  TwoTaps(const StruckRun& tap_a, const StruckRun& tap_b) {
    write_tap(folder.path() / "a.h5", tap_a);
    write_tap(folder.path() / "b.h5", tap_b);
    const RunReader a(folder.path() / "a.h5");
    const RunReader b(folder.path() / "b.h5");
    comparison = compare_runs(a, b);
    measures = measure_runs(a, b, comparison);
  }

  TemporaryFolder folder;
  Comparison comparison;
  Measures measures;
};

}  // namespace

TEST_CASE("a tap on a softer object that answers later is told from the other", "[slow]") {
  const StruckRun a;
  const StruckRun b{
      .onset = 104, .force = 1.2, .compliance = 6e-3, .frequency = 12.6, .decay = 6.0};
  const TwoTaps taps(a, b);
  REQUIRE(taps.measures.evenly_spaced);
  CHECK(taps.measures.interval == Approx(0.002));
  CHECK(taps.comparison.objects.at(0).node == kTapped);

  const SignalPair& node = taps.measures.nodes.at(0);
  CHECK(node.interval.first == kRelease);
  CHECK(node.interval.count == kFrames - kRelease);
  REQUIRE(node.ringing_a.size() == 1);
  REQUIRE(node.ringing_b.size() == 1);
  CHECK(node.ringing_a[0].frequency == Approx(12.0).epsilon(1e-6));
  CHECK(node.ringing_b[0].frequency == Approx(12.6).epsilon(1e-6));
  const auto ratio = [](const StruckRun& tap) {
    return tap.decay / std::hypot(tap.decay, 2 * std::numbers::pi * tap.frequency);
  };
  CHECK(node.ringing_a[0].damping_ratio == Approx(ratio(a)).epsilon(1e-5));
  CHECK(node.ringing_b[0].damping_ratio == Approx(ratio(b)).epsilon(1e-5));
  CHECK(node.ringing_a[0].amplitude == Approx(5e-3).epsilon(1e-5));

  const StylusMeasures& stylus = taps.measures.styluses.at(0);
  CHECK(stylus.compliance_a.value() == Approx(5e-3));
  CHECK(stylus.compliance_b.value() == Approx(6e-3));
  CHECK(stylus.compliance_share() == Approx(0.2));  // of that of A
  CHECK(stylus.noticeable_compliance() == std::optional(true));
  CHECK(stylus.difference.share.at(200) == Approx(0.2));
  CHECK(stylus.difference.noticeable() == std::optional(true));
  REQUIRE(stylus.onsets.delays.size() == 1);
  CHECK(stylus.onsets.delays[0] == Approx(0.008));
  CHECK(stylus.onsets.noticeable(taps.measures.interval) == std::optional(true));
}

TEST_CASE("a tap is not noticeably different from itself", "[slow]") {
  const TwoTaps taps({}, {});
  const StylusMeasures& stylus = taps.measures.styluses.at(0);
  CHECK(stylus.difference.noticeable() == std::optional(false));
  CHECK(stylus.noticeable_compliance() == std::optional(false));
  CHECK(stylus.vibration_difference.noticeable() == std::optional(false));
  CHECK(stylus.onsets.noticeable(taps.measures.interval) == std::optional(false));
  CHECK(stylus.vibration_a.level > 1.0);  // the tap itself is felt
  // Above the hand's own resonance twice the mass moves half as far.
  const RunReader run(taps.folder.path() / "a.h5");
  const Measures heavy = measure_runs(run, run, taps.comparison, {.mass = 0.24});
  const auto last = [](const Measures& all) {
    return all.styluses[0].vibration_a.spectrum.amplitude.back();
  };
  CHECK(last(heavy) == Approx(0.5 * last(taps.measures)).epsilon(1e-3));
  const std::string table = comparison_table(taps.comparison, taps.measures);
  CHECK_THAT(table, ContainsSubstring("12 Hz, damping 5.298 % (B 12 Hz, 5.298 %)") &&
                        ContainsSubstring("ms), 0 in one alone: not noticeable") &&
                        ContainsSubstring("all frames          one frame           0.1 s\n") &&
                        ContainsSubstring("none                none                0.5 N\n"));
}

TEST_CASE("a stylus without contact has no section and is not judged", "[slow]") {
  const TwoTaps taps({.force = 0.0}, {.force = 0.0});
  const std::string table = comparison_table(taps.comparison, taps.measures);
  CHECK_THAT(table, ContainsSubstring("stylus 0: no contact in A or B, not judged\n") &&
                        !ContainsSubstring("noticeable"));
  const auto json = nlohmann::json::parse(comparison_json(taps.comparison, taps.measures));
  CHECK(json["styluses"][0]["perception"]["force"]["noticeable"].is_null());
}

TEST_CASE("what a run has too few frames for is not judged", "[unsanitized]") {
  const TwoTaps taps({.interval = 0.02}, {.interval = 0.02});
  const auto json = nlohmann::json::parse(comparison_json(taps.comparison, taps.measures));
  const auto& perception = json["styluses"][0]["perception"];
  CHECK(perception["onset"]["resolution"].get<double>() == Approx(0.02));
  CHECK(perception["onset"]["noticeable"].is_null());
  CHECK(perception["vibration"]["noticeable"].is_null());
  CHECK_THAT(comparison_table(taps.comparison, taps.measures),
             ContainsSubstring("not judged: too few frames a second") &&
                 ContainsSubstring("not judged: the frames are too far apart"));
}
