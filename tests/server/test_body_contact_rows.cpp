// Contacts between bodies in a trace: given back to the bit, and what is refused of them.
#include <limits>

#include "common/error.hpp"
#include "simulation/contact/contact_sampling.hpp"
#include "tests/server/records.hpp"
#include "tests/server/touching_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/edited_numbers.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"
#include "trace/trace_writer.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
const std::string kContactGroup = "/body_contact/";

/// Of two cubes that touch each other and a plane.
struct TouchingTrace : TemporaryFolder {
  static constexpr int kSteps = 60;

  TouchingTrace() {
    Simulation simulation(config);
    for (StepRecord& record : records) step_alone(simulation, record);
    write(whole, touches_bodies(config));
  }

  void write(const std::filesystem::path& file, bool bodies) const {
    TraceWriter writer(
        file, {{{"one", "a.h5", "1"}, {"two", "b.h5", "2"}}, "scene", 0.002, 1, false, bodies});
    const std::span<const StepRecord> all(records);
    writer.append(all.first(1));
    writer.append(all.subspan(1, 30));
    writer.append(all.subspan(31));
    writer.close();
  }
  Recording read(const std::filesystem::path& file) const { return {file, config, {"one", "two"}}; }

  std::vector<double> numbers(const std::string& set) const {
    std::vector<double> found;
    edit_numbers(whole, kContactGroup + set, [&](std::vector<double>& values) { found = values; });
    return found;
  }
  /// The first row of a contact with the other object, or with scenery.
  std::size_t row(bool scenery) const {
    const std::vector<double> other = numbers("other");
    const auto found = std::find_if(other.begin(), other.end(),
                                    [&](double body) { return (body < 0.0) == scenery; });
    REQUIRE(found != other.end());
    return static_cast<std::size_t>(found - other.begin());
  }
  std::filesystem::path edited(const std::string& set, std::size_t place, double value) const {
    std::filesystem::copy_file(whole, damaged, std::filesystem::copy_options::overwrite_existing);
    set_number(damaged, kContactGroup + set, place, value);
    return damaged;
  }
  void refuses(const std::string& set, std::size_t place, double value,
               const std::string& message) const {
    CAPTURE(set, place, value);
    CHECK_THROWS_WITH(read(edited(set, place, value)), ContainsSubstring("damaged.h5: " + message));
  }

  SimulationConfig config = touching_cubes(fem_cube({.cells = 2, .poisson_ratio = 0.45}), true);
  std::vector<StepRecord> records = std::vector<StepRecord>(kSteps);
  std::filesystem::path whole = path() / "whole.h5";
  std::filesystem::path damaged = path() / "damaged.h5";
};

}  // namespace

TEST_CASE("a trace gives back every contact between bodies of every step to the bit") {
  const TouchingTrace trace;
  const Recording recording = trace.read(trace.whole);
  REQUIRE(recording.steps() == TouchingTrace::kSteps);
  const auto record = std::make_unique<StepRecord>();
  std::size_t most = 0;
  bool some_without = false;
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, *record);
    CHECK(same_body_contacts(*record, trace.records[k]));
    most = std::max(most, record->body_contact.size());
    some_without = some_without || record->body_contact.empty();
  }
  CHECK(most > 5);
  CHECK(some_without);
}

TEST_CASE("sets of contacts between bodies have their units, where objects can touch alone") {
  const TouchingTrace trace;
  const hdf5::File file = hdf5::File::open(trace.whole);
  CHECK(read_trace_header(trace.whole).bodies);
  for (const auto& [set, unit] :
       {std::pair{"weights", "1"}, std::pair{"force", "N"}, std::pair{"position", "m"},
        std::pair{"normal", "1"}, std::pair{"slip", "m"}, std::pair{"area", "m^2"}}) {
    CHECK(file.read_string_attribute(kContactGroup + set, "unit") == unit);
  }
  const hsize_t rows = file.shape(kContactGroup + "force_step")[0];
  for (const char* set : {"object", "other", "sample", "slipping", "triangle", "area"}) {
    CHECK(file.shape(kContactGroup + set) == hdf5::Shape{rows});
  }
  for (const char* set : {"weights", "force", "position", "normal", "slip"}) {
    CHECK(file.shape(kContactGroup + set) == hdf5::Shape{rows, 3});
  }
}

TEST_CASE("a trace without contacts between bodies is read, as older ones are") {
  const TouchingTrace trace;
  const std::filesystem::path older = trace.path() / "older.h5";
  trace.write(older, false);
  CHECK_FALSE(hdf5::File::open(older).exists("/body_contact"));
  CHECK_FALSE(read_trace_header(older).bodies);
  const Recording recording = trace.read(older);
  const auto record = std::make_unique<StepRecord>();
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    record->body_contact.resize(7);
    recording.step(k, *record);
    CHECK(record->body_contact.empty());
  }
}

TEST_CASE("contacts of bodies, samples and triangles that there are not are refused") {
  const TouchingTrace trace;
  const std::size_t row = trace.row(false);
  const std::string bodies = "/body_contact has a contact of bodies that the scene does not have";
  for (const double body : {-1.0, 2.0, 1e9}) trace.refuses("object", row, body, bodies);
  for (const double body : {-2.0, 2.0, -1e9}) trace.refuses("other", row, body, bodies);
  trace.refuses("other", row, trace.numbers("object")[row], bodies);  // itself
  const std::string place = "/body_contact has a sample or a triangle that the model does not have";
  const RestSurface surface(trace.config.objects[0].model->mesh);
  const ContactSampling sampling(surface, trace.config.contact_samples);
  const auto samples = static_cast<double>(sampling.samples().size());
  for (const double sample : {-1.0, samples, 1e9}) trace.refuses("sample", row, sample, place);
  CHECK(trace.read(trace.edited("sample", row, samples - 1.0)).steps() == TouchingTrace::kSteps);
  for (const double triangle : {-1.0, static_cast<double>(surface.triangle_count())}) {
    trace.refuses("triangle", row, triangle, place);
    CHECK_NOTHROW(trace.read(trace.edited("triangle", trace.row(true), triangle)));
  }
}

TEST_CASE("contacts between bodies with numbers that no run has are refused with set and step") {
  const TouchingTrace trace;
  const std::size_t row = trace.row(false);
  const std::string of_step =
      " of step " +
      std::to_string(static_cast<std::uint64_t>(trace.numbers("force_step").at(row))) + " ";
  for (const double value : {kNotANumber, std::numeric_limits<double>::infinity(), -1e300}) {
    for (const char* set : {"force", "position", "slip"}) {
      trace.refuses(set, 3 * row + 1, value, kContactGroup + set + of_step + "is ");
    }
    trace.refuses("area", row, value, "/body_contact/area" + of_step + "is ");
    trace.refuses("normal", 3 * row, value, "/body_contact/normal" + of_step + "is no direction");
    trace.refuses("weights", 3 * row, value, "/body_contact/weights" + of_step + "are no bary");
  }
  trace.refuses("area", row, 0.0, "/body_contact/area" + of_step + "is 0");
  trace.refuses("normal", 3 * row, 0.5, "/body_contact/normal" + of_step + "is no direction");
  trace.refuses("weights", 3 * row, 2.0, "/body_contact/weights" + of_step + "are no barycentric");
}

TEST_CASE("steps of contacts between bodies increase, and none has more than a step can have") {
  const TouchingTrace trace;
  const std::size_t rows = trace.numbers("force_step").size();
  trace.refuses("force_step", rows - 1, 0.0, "/body_contact/force_step decreases");
  REQUIRE(rows > kMaxBodyContacts);
  trace.edited("force_step", 0, 0.0);
  edit_numbers(trace.damaged, kContactGroup + "force_step",
               [](std::vector<double>& steps) { std::fill(steps.begin(), steps.end(), 3.0); });
  CHECK_THROWS_WITH(
      trace.read(trace.damaged),
      ContainsSubstring("/body_contact has " + std::to_string(rows) + " contacts in step 3"));
}

TEST_CASE("contacts between bodies of steps that a killed server has not completed do not count") {
  const TouchingTrace trace;
  const std::size_t rows = trace.numbers("force_step").size();
  set_number(trace.whole, kContactGroup + "force_step", rows - 1, 1e6);
  set_number(trace.whole, kContactGroup + "area", rows - 1, kNotANumber);
  const Recording recording = trace.read(trace.whole);
  const auto record = std::make_unique<StepRecord>();
  recording.step(recording.steps() - 1, *record);
  CHECK(record->body_contact.size() == trace.records.back().body_contact.size() - 1);
}

TEST_CASE("contacts between bodies are refused in a scene whose objects do not touch") {
  TouchingTrace trace;
  trace.config.between_objects = false;
  CHECK_THROWS_WITH(trace.read(trace.whole),
                    ContainsSubstring("/body_contact has a contact of bodies"));
}
