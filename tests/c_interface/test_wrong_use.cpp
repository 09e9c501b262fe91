#include <unistd.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "tests/c_interface/c_scene.hpp"
#include "tests/support/catch.hpp"

using namespace irdm::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("C interface: null is wrong use, never a crash") {
  std::size_t count = 0;
  double number = 0.0;
  std::int32_t index = 0;
  irdm_command command{};
  irdm_object object{};
  irdm_contact contact{};
  irdm_simulation* simulation = nullptr;
  std::array<char, 64> message{};
  CHECK(irdm_simulation_open(nullptr, &simulation, message.data(), message.size()) ==
        IRDM_BAD_ARGUMENT);
  CHECK(std::string(message.data()) == "a pointer is null");
  CHECK(irdm_simulation_parse("", nullptr, nullptr, 0) == IRDM_BAD_ARGUMENT);
  irdm_simulation_close(nullptr);
  CHECK(std::isnan(irdm_simulation_dt(nullptr)));
  CHECK(irdm_simulation_stylus_count(nullptr) == -1);
  CHECK(irdm_simulation_object_count(nullptr) == -1);
  CHECK(irdm_simulation_find_object(nullptr, "cube") == -1);
  CHECK(irdm_simulation_step(nullptr, &command, 1, nullptr) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_reset(nullptr) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_save(nullptr, nullptr, 0, &count) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_load(nullptr, &number, 8, nullptr, 0) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_objects(nullptr, &object, 1) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_contacts(nullptr, &contact, 1, &count) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_surface(nullptr, 0, &number, 1, &count) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_simulation_triangles(nullptr, 0, &index, 1, &count) == IRDM_BAD_ARGUMENT);
}

TEST_CASE("C interface: a scene that is wrong is refused with a message") {
  const OpenSimulation no_object("[world]\n");
  CHECK(no_object.status == IRDM_FAILED);
  CHECK(no_object.handle == nullptr);
  CHECK_THAT(no_object.error, Catch::Matchers::ContainsSubstring("object is missing"));
  const OpenSimulation no_file("[[object]]\nmodel = \"/nowhere/cube.h5\"\n");
  CHECK(no_file.status == IRDM_FAILED);
  CHECK_THAT(no_file.error, Catch::Matchers::ContainsSubstring("/nowhere/cube.h5"));
  irdm_simulation* simulation = nullptr;
  std::array<char, 8> little{};
  little.fill('x');
  CHECK(irdm_simulation_open("/nowhere.toml", &simulation, little.data(), 4) == IRDM_FAILED);
  CHECK(std::string(little.data()) == "/no");
  CHECK(little[4] == 'x');
  CHECK(irdm_simulation_open("/nowhere.toml", &simulation, nullptr, 0) == IRDM_FAILED);
}

TEST_CASE("C interface: wrong commands and too little memory change nothing") {
  const CScene scene;
  const OpenSimulation open(scene.text());
  const OpenSimulation twin(scene.text());
  REQUIRE(open.status == IRDM_OK);
  CHECK(irdm_simulation_find_object(open.handle, "block") == 1);
  CHECK(irdm_simulation_find_object(open.handle, "table") == -1);
  CHECK(irdm_simulation_find_object(open.handle, nullptr) == -1);
  std::array<irdm_object, 2> objects{};
  CHECK(irdm_simulation_objects(open.handle, objects.data(), 2) == IRDM_BAD_ARGUMENT);
  std::mt19937 random(1);
  const double odd[] = {kNan, kInfinite, -kInfinite, 1e5, -1e300};
  for (int k = 0; k < 200; ++k) {
    const auto commands = CScene::commands(k);
    auto wrong = commands;
    irdm_command& one = wrong[random() % 2];
    one.present = 1;
    if (random() % 2 == 0) {
      one.tip[random() % 3] = odd[random() % 5];
    } else {
      one.orientation[random() % 4] = odd[random() % 5];
    }
    std::array<irdm_stylus, 2> styluses{};
    CHECK(irdm_simulation_step(open.handle, wrong.data(), 2, styluses.data()) == IRDM_BAD_ARGUMENT);
    CHECK(irdm_simulation_step(open.handle, commands.data(), 1, styluses.data()) ==
          IRDM_BAD_ARGUMENT);
    CHECK(irdm_simulation_step(open.handle, nullptr, 2, styluses.data()) == IRDM_BAD_ARGUMENT);
    CHECK(styluses[0].tip[0] == 0.0);
    std::array<irdm_stylus, 2> expected{};
    REQUIRE(irdm_simulation_step(open.handle, commands.data(), 2, styluses.data()) == IRDM_OK);
    REQUIRE(irdm_simulation_step(twin.handle, commands.data(), 2, expected.data()) == IRDM_OK);
    REQUIRE(std::memcmp(styluses.data(), expected.data(), sizeof styluses) == 0);
  }
  CHECK(irdm_simulation_objects(open.handle, objects.data(), 1) == IRDM_TOO_SMALL);
  const std::vector<irdm_contact> contacts = contacts_of(open.handle);
  REQUIRE(contacts.size() > 2);
  std::vector<irdm_contact> little(1);
  std::size_t count = 0;
  CHECK(irdm_simulation_contacts(open.handle, little.data(), 1, &count) == IRDM_TOO_SMALL);
  CHECK(count == contacts.size());
  CHECK(irdm_simulation_contacts(open.handle, nullptr, 1, &count) == IRDM_BAD_ARGUMENT);
  for (const std::int32_t object : {-1, 2, std::numeric_limits<std::int32_t>::max()}) {
    CHECK(irdm_simulation_surface(open.handle, object, nullptr, 0, &count) == IRDM_BAD_ARGUMENT);
    CHECK(irdm_simulation_triangles(open.handle, object, nullptr, 0, &count) == IRDM_BAD_ARGUMENT);
  }
}

TEST_CASE("C interface: a state that is damaged or of other models changes nothing") {
  const CScene scene;
  const OpenSimulation open(scene.text());
  REQUIRE(open.status == IRDM_OK);
  const std::vector<char> state = state_of(open.handle);
  std::size_t count = 0;
  CHECK(irdm_simulation_save(open.handle, nullptr, 1, &count) == IRDM_BAD_ARGUMENT);
  std::vector<char> little(state.size() - 1);
  CHECK(irdm_simulation_save(open.handle, little.data(), little.size(), &count) == IRDM_TOO_SMALL);
  CHECK(count == state.size());
  std::array<char, 200> message{};
  const auto load = [&](const std::vector<char>& bytes) {
    return irdm_simulation_load(open.handle, bytes.data(), bytes.size(), message.data(),
                                message.size());
  };
  CHECK(irdm_simulation_load(open.handle, nullptr, 8, nullptr, 0) == IRDM_BAD_ARGUMENT);
  for (const std::size_t at : {std::size_t{3}, std::size_t{70}, state.size() / 2}) {
    std::vector<char> damaged = state;
    damaged[at] ^= 4;
    CHECK(load(damaged) == IRDM_FAILED);
    CHECK_THAT(std::string(message.data()),
               Catch::Matchers::ContainsSubstring(at < 64 ? "these models" : "is damaged"));
  }
  CHECK(load({'i'}) == IRDM_FAILED);
  const std::string table = "[[scenery]]";
  const std::string fewer = scene.text().substr(0, scene.text().find(table));
  const OpenSimulation alone(fewer);
  REQUIRE(alone.status == IRDM_OK);
  CHECK(load(state_of(alone.handle)) == IRDM_FAILED);
  CHECK_THAT(std::string(message.data()),
             Catch::Matchers::ContainsSubstring("not one of this scene"));
  CHECK((state_of(open.handle) == state));
}

TEST_CASE("C interface: opened and closed very often, nothing is left", "[slow]") {
  const CScene scene;
  for (int i = 0; i < 200; ++i) {
    const OpenSimulation open(scene.text());
    REQUIRE(open.status == IRDM_OK);
  }
}

TEST_CASE("C interface: a hundred thousand simulations take no memory with them", "[exhaustive]") {
  const CScene scene(1);
  const auto resident = [] {
    std::ifstream statm("/proc/self/statm");
    long size = 0;
    long pages = 0;
    statm >> size >> pages;
    return pages * sysconf(_SC_PAGESIZE);
  };
  long before = 0;
  for (int i = 0; i < 100'000; ++i) {
    if (i == 500) before = resident();
    const OpenSimulation open(scene.text());
    REQUIRE(open.status == IRDM_OK);
    if (i % 100 != 0) continue;
    const std::vector<char> state = state_of(open.handle);
    REQUIRE(irdm_simulation_load(open.handle, state.data(), state.size(), nullptr, 0) == IRDM_OK);
  }
  CHECK(resident() - before < 1'000'000);  // 10 bytes each
}
