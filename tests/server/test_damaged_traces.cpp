// What a reader of traces refuses: numbers that no run has, and rows that fit nothing.
#include <limits>

#include "common/error.hpp"
#include "tests/server/two_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/edited_numbers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"
#include "trace/trace_writer.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Of two cubes on a floor and two styluses, with forces that came late and some of a bridge.
struct DamagedTrace : TemporaryFolder {
  static constexpr int kSteps = 120;

  DamagedTrace() {
    Simulation simulation(config);
    std::vector<StepRecord> records(kSteps);
    for (int k = 0; k < kSteps; ++k) {
      StepRecord& record = records[static_cast<std::size_t>(k)];
      play_step(simulation, k, record);
      if (k % 9 == 0) record.stylus[0].bridged = BridgedForce{.object = k % 2};
    }
    TraceWriter writer(whole,
                       {{{"one", "a.h5", "1"}, {"two", "b.h5", "2"}}, "scene", 0.002, 2, true});
    writer.append(records);
    writer.close();
  }

  std::vector<double> numbers(const std::string& set) const {
    std::vector<double> found;
    edit_numbers(whole, set, [&](std::vector<double>& values) { found = values; });
    return found;
  }
  /// The first row of which this is true.
  template <typename True>
  std::size_t row(const std::string& set, const True& is_true) const {
    const std::vector<double> values = numbers(set);
    const auto found = std::find_if(values.begin(), values.end(), is_true);
    REQUIRE(found != values.end());
    return static_cast<std::size_t>(found - values.begin());
  }

  Recording read(const std::filesystem::path& path) const { return {path, config, {"one", "two"}}; }

  void refuses(const std::string& set, std::size_t place, double value,
               const std::string& message) const {
    CAPTURE(set, place, value);
    std::filesystem::copy_file(whole, damaged, std::filesystem::copy_options::overwrite_existing);
    set_number(damaged, set, place, value);
    CHECK_THROWS_WITH(read(damaged), ContainsSubstring(message));
  }
  /// Also for what is infinite, and for what is finite and nothing else.
  void refuses_absurd(const std::string& set, std::size_t place, std::size_t step) const {
    const std::string message = "damaged.h5: " + set + " of step " + std::to_string(step) + " is ";
    for (const double value : {kNan, kInfinite, -1e300}) refuses(set, place, value, message);
  }

  SimulationConfig config = two_cubes();
  std::filesystem::path whole = path() / "whole.h5";
  std::filesystem::path damaged = path() / "damaged.h5";
};

bool is_contact(double state) {
  return state > 0.0;
}

}  // namespace

TEST_CASE("a trace with numbers that no run has is refused with its set and step") {
  const DamagedTrace trace;
  CHECK(trace.read(trace.whole).steps() == DamagedTrace::kSteps);
  for (const char* set :
       {"/stylus/0/tip", "/stylus/0/proxy", "/stylus/1/force", "/object/two/body_position",
        "/object/two/body_velocity", "/object/one/body_angular_velocity",
        "/object/one/stylus/0/force", "/object/one/stylus/1/proxy", "/object/two/stylus/1/offset",
        "/object/one/stylus/0/arm_shift"}) {
    trace.refuses_absurd(set, 3 * 17 + 1, 17);
  }
}

TEST_CASE("a trace with an orientation that is none is refused with its set and step") {
  const DamagedTrace trace;
  for (const double value : {0.0, 2.0, kNan, 1e300}) {
    trace.refuses("/object/one/body_orientation", 4 * 20, value,
                  "/object/one/body_orientation of step 20 is no quaternion of length 1");
    trace.refuses("/late/body_orientation", 0, value, "/late/body_orientation of step ");
  }
}

TEST_CASE("a trace with weights that are none is refused with their set and step") {
  const DamagedTrace trace;
  const std::string path = "/object/one/stylus/0";
  const std::size_t row = trace.row(path + "/contact", is_contact);
  for (const double value : {-1.0, 2.0, kNan, 1e300}) {
    trace.refuses(
        path + "/contact_weights", 3 * row, value,
        path + "/contact_weights of step " + std::to_string(row) + " are no barycentric weights");
    trace.refuses("/late/contact_weights", 1, value, "/late/contact_weights of step ");
  }
}

TEST_CASE("a trace with settings that no step bears is refused with their set and step") {
  const DamagedTrace trace;
  const std::string first = "/settings/object/0/";
  for (const double value : {kNan, 1e300, -1e9}) {
    trace.refuses("/settings/gravity", 4, value, "/settings/gravity of step 60 is ");
    for (const char* name : {"friction", "damping", "tether"}) {
      trace.refuses(first + name, 0, value, first + name + " of step 0 is ");
    }
    trace.refuses(first + "material_damping", 1, value, first + "material_damping of step 60 is ");
  }
  trace.refuses(first + "friction", 1, 5.0, "friction of step 0 is more while it slides");
  trace.refuses(first + "damping", 0, 1e6, "/settings of step 0 cannot be: ");
  trace.refuses(first + "tether", 1, 1e8, "/settings of step 0 cannot be: ");
}

TEST_CASE("a trace with events that no run has is refused with their set and step") {
  const DamagedTrace trace;
  const auto late = static_cast<std::size_t>(trace.numbers("/late/force_step").at(2));
  for (const char* set : {"/late/force", "/late/arm", "/late/body_position", "/late/body_velocity",
                          "/late/body_angular_momentum"}) {
    trace.refuses_absurd(set, 3 * 2, late);
  }
  for (const char* set : {"/bridged/force", "/bridged/arm"}) trace.refuses_absurd(set, 3 * 2, 18);
  trace.refuses("/bridged/share", 2, 1.5, "/bridged/share of step 18 is 1.5");
  const std::string floor = "/object/one/floor/";
  const std::size_t step = trace.row(floor + "count", [](double count) { return count > 0.0; });
  trace.refuses_absurd(floor + "force", 0, step);
}

TEST_CASE("a trace that speaks of a node beyond the mesh is refused") {
  const DamagedTrace trace;
  const int nodes = trace.config.objects[0].model->mesh.surface_node_count();
  const std::string path = "/object/one/stylus/0";
  const std::size_t row = trace.row(path + "/contact", is_contact);
  const std::string message = " touches a node that the model does not have";
  trace.refuses(path + "/contact_nodes", 3 * row + 2, nodes, path + message);
  trace.refuses("/object/one/floor/node", 0, nodes, "/object/one/floor" + message);
  trace.refuses("/late/contact_nodes", 0, nodes, "/late has a force on something");
}

TEST_CASE("a trace that counts more contacts with the floor than it has is refused") {
  const DamagedTrace trace;
  const std::string set = "/object/one/floor/count";
  const std::size_t last = DamagedTrace::kSteps - 1;
  const double count = trace.numbers(set).at(last);
  trace.refuses(set, last, count + 1.0, set + " does not fit the rows that are there");
  trace.refuses(set, last, -1.0, set + " does not fit the rows that are there");
}

TEST_CASE("a trace whose dt is none is refused") {
  const DamagedTrace trace;
  for (const double dt : {kNan, 0.0, 1e-10, 1e300}) {
    set_attribute(trace.whole, "/", "dt", dt);
    CHECK_THROWS_WITH(trace.read(trace.whole), ContainsSubstring("has a dt of "));
    CHECK_THROWS_WITH(read_trace_header(trace.whole), ContainsSubstring("has a dt of "));
  }
}

TEST_CASE("a trace with flags and states that do not exist is refused with set and step") {
  const DamagedTrace trace;
  trace.refuses("/step/reset", 30, 9, "/step/reset of step 30 is 9, not from 0 to 1");
  trace.refuses("/stylus/1/present", 30, 3, "/stylus/1/present of step 30 is 3, not from 0 to 1");
  trace.refuses("/object/one/stylus/0/contact", 30, 7,
                "/object/one/stylus/0/contact of step 30 is 7, not from 0 to 2");
  trace.refuses("/object/two/stylus/0/slipping", 30, 2, "slipping of step 30 is 2");
  trace.refuses("/settings/object/0/inertial_loading", 0, 2, "inertial_loading of step 0 is 2");
  trace.refuses_absurd("/step/time", 40, 40);
}

TEST_CASE("a trace that says it has more steps than rows, or lacks a group, is refused") {
  const DamagedTrace trace;
  trace.refuses("/committed", 0, DamagedTrace::kSteps + 1,
                "says that it has 121 steps and has 120 rows");
  for (const std::string group : {"/late", "/bridged", "/settings"}) {
    std::filesystem::copy_file(trace.whole, trace.damaged,
                               std::filesystem::copy_options::overwrite_existing);
    take_away(trace.damaged, group);
    CHECK_THROWS_WITH(trace.read(trace.damaged), ContainsSubstring("has no dataset " + group));
  }
  std::filesystem::copy_file(trace.whole, trace.damaged,
                             std::filesystem::copy_options::overwrite_existing);
  replace_attribute(trace.damaged, "/stylus/0/tip", "unit", std::string("mm"));
  CHECK_THROWS_WITH(trace.read(trace.damaged),
                    ContainsSubstring("attribute unit of /stylus/0/tip is 'mm', not 'm'"));
}

TEST_CASE("what is wrong after the last step that is read does not matter") {
  const DamagedTrace trace;
  set_number(trace.whole, "/object/two/body_position", 3 * 100, kNan);
  CHECK_THROWS_WITH(trace.read(trace.whole), ContainsSubstring(" is nan"));
  const Recording begin(trace.whole, trace.config, {"one", "two"}, 90);
  CHECK(begin.steps() == 90);
}

// Traces of servers from before world.bound have such rows.
TEST_CASE("a trace of a stylus that was where no hand is can be read: there it has no contact") {
  const DamagedTrace trace;
  const std::string path = "/object/one/stylus/0";
  const std::size_t row = trace.row(path + "/contact", is_contact);
  set_number(trace.whole, path + "/arm_shift", 3 * row + 1, 5.6e6);
  StepRecord record;
  trace.read(trace.whole).step(row, record);
  CHECK(record.object[0].contact[0].state == ContactState::kFree);
  CHECK(record.object[0].contact[0].arm_shift.isZero(0.0));
  trace.read(trace.whole).step(row + 1, record);
  CHECK(record.object[0].contact[0].state != ContactState::kFree);
}
