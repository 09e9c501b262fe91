// A program that uses the C interface in any order with anything: numbers, sizes, states, texts.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "c_interface/irdm.h"
#include "precompute/precompute.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::fuzz {
namespace {

constexpr int kMostCalls = 200;
constexpr std::size_t kObjects = 2;
constexpr double kPlace = 1e4;

// Two cubes, one on the other, under a stylus that takes hold and one that leads a block.
const std::string& scene_text() {
  static const TemporaryFolder folder;
  static const std::string text = [] {
    precompute::PrecomputeConfig config;
    config.name = "cube";
    config.mesh.source = precompute::BoxConfig{Vector3::Constant(0.12), {1, 1, 1}};
    config.mesh.order = 1;
    config.material = {5000.0, 0.4, 110.0, 8.0, 2e-4};
    config.response.dt = 0.002;
    config.response.steps = 50;
    std::ostringstream ignored;
    precompute::precompute_model(config, folder.path() / "cube.h5", {ignored, false});
    const std::string model = "model = \"" + (folder.path() / "cube.h5").string() + "\"\n";
    return "[[stylus]]\ncoupling_stiffness = 500\nreach = 0.01\n"
           "[[stylus]]\ntool = { object = \"two\" }\n"
           "[[object]]\nname = \"one\"\n" +
           model + "[[object]]\nname = \"two\"\nposition = [0, 0.13, 0]\n" + model;
  }();
  return text;
}

class Bytes {
 public:
  explicit Bytes(Input input) : left_(input) {}
  bool any() const { return !left_.empty(); }
  // What is missing is zero.
  template <typename Number>
  Number number() {
    Number value{};
    const std::size_t count = std::min(sizeof value, left_.size());
    std::memcpy(&value, left_.data(), count);
    left_ = left_.subspan(count);
    return value;
  }
  std::string text() {
    const std::size_t count = std::min<std::size_t>(number<std::uint8_t>(), left_.size());
    std::string taken(text_of(left_.first(count)));
    left_ = left_.subspan(count);
    return taken;
  }

 private:
  Input left_;
};

irdm_command command_of(Bytes& bytes) {
  irdm_command command{};
  command.present = bytes.number<std::uint8_t>() % 4;
  command.buttons = bytes.number<std::uint8_t>();
  for (double& number : command.tip) number = bytes.number<double>();
  for (double& number : command.orientation) number = bytes.number<double>();
  return command;
}

bool is_place(const irdm_command& command) {
  return command.present == 0 || std::all_of(command.tip, command.tip + 3, [](double number) {
           return std::abs(number) <= kPlace;
         });
}

class Caller {
 public:
  Caller() {
    std::array<char, 200> message{};
    const irdm_status status =
        irdm_simulation_parse(scene_text().c_str(), &simulation_, message.data(), message.size());
    expect(status == IRDM_OK, "the scene is one");
  }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;
  ~Caller() { irdm_simulation_close(simulation_); }

  void call(Bytes& bytes) {
    switch (bytes.number<std::uint8_t>() % 8) {
      case 0:
        return step(bytes);
      case 1:
        return step_wrongly(bytes);
      case 2:
        return look(bytes);
      case 3:
        return surface(bytes);
      case 4:
        return load_edited(bytes);
      case 5:
        return load(bytes.text());
      case 6:
        return parse(bytes.text());
      default:
        expect(irdm_simulation_reset(simulation_) == IRDM_OK, "a reset is done");
    }
  }

 private:
  void step(Bytes& bytes) {
    const std::array<irdm_command, 2> commands{command_of(bytes), command_of(bytes)};
    std::array<irdm_stylus, 2> styluses{};
    const irdm_status status =
        irdm_simulation_step(simulation_, commands.data(), 2, styluses.data());
    if (status == IRDM_BAD_ARGUMENT) return;
    expect(status == IRDM_OK, "a step is made, or the command is wrong");
    expect(is_place(commands[0]) && is_place(commands[1]), "tips of a step are places");
    for (const irdm_stylus& stylus : styluses) {
      for (int i = 0; i < 3; ++i) {
        expect(std::isfinite(stylus.force[i]) && std::isfinite(stylus.torque[i]),
               "forces are finite");
      }
    }
  }

  void step_wrongly(Bytes& bytes) {
    const std::array<irdm_command, 2> commands{};
    const auto count = bytes.number<std::uint64_t>();
    if (count != 2) {
      expect(
          irdm_simulation_step(simulation_, commands.data(), count, nullptr) == IRDM_BAD_ARGUMENT,
          "the number of commands is looked at");
    }
    expect(irdm_simulation_step(simulation_, nullptr, 2, nullptr) == IRDM_BAD_ARGUMENT,
           "null is no command");
  }

  void look(Bytes& bytes) {
    std::vector<irdm_contact> contacts(bytes.number<std::uint8_t>());
    std::size_t count = 0;
    const irdm_status status =
        irdm_simulation_contacts(simulation_, contacts.data(), contacts.size(), &count);
    expect((status == IRDM_OK) == (count <= contacts.size()), "there is room, or not");
    std::vector<irdm_object> objects(bytes.number<std::uint8_t>() % 4);
    const irdm_status told = irdm_simulation_objects(simulation_, objects.data(), objects.size());
    expect(objects.size() >= kObjects || told != IRDM_OK, "objects have room");
    for (std::size_t i = 0; told == IRDM_OK && i < kObjects; ++i) {
      expect(std::isfinite(objects[i].energy), "energy is finite");
    }
  }

  void surface(Bytes& bytes) {
    const auto object = bytes.number<std::int32_t>();
    std::vector<double> nodes(3 * static_cast<std::size_t>(bytes.number<std::uint8_t>()));
    std::size_t count = 0;
    irdm_status status =
        irdm_simulation_surface(simulation_, object, nodes.data(), nodes.size() / 3, &count);
    const bool there = object >= 0 && object < static_cast<std::int32_t>(kObjects);
    expect(there || status == IRDM_BAD_ARGUMENT, "only objects that there are have a surface");
    std::vector<std::int32_t> triangles(3 * static_cast<std::size_t>(bytes.number<std::uint8_t>()));
    status = irdm_simulation_triangles(simulation_, object, triangles.data(), triangles.size() / 3,
                                       &count);
    expect(there || status == IRDM_BAD_ARGUMENT, "and triangles");
  }

  std::vector<char> saved() const {
    std::size_t count = 0;
    expect(irdm_simulation_save(simulation_, nullptr, 0, &count) == IRDM_TOO_SMALL,
           "a state has bytes");
    std::vector<char> state(count);
    expect(irdm_simulation_save(simulation_, state.data(), state.size(), &count) == IRDM_OK,
           "a state fits in its bytes");
    return state;
  }

  void load_edited(Bytes& bytes) {
    const std::vector<char> before = saved();
    expect(before.size() > 128, "a state has a head and more");
    const auto less = static_cast<std::ptrdiff_t>(bytes.number<std::uint8_t>() % 3);
    std::vector<char> state(before.begin(), before.end() - less);
    state[bytes.number<std::uint32_t>() % state.size()] ^=
        static_cast<char>(bytes.number<std::uint8_t>());
    const irdm_status status =
        irdm_simulation_load(simulation_, state.data(), state.size(), nullptr, 0);
    expect((status == IRDM_OK) == (state == before), "a state that was edited is refused");
    expect(saved() == before, "and nothing is changed by that");
  }

  void load(const std::string& state) {
    std::array<char, 80> message{};
    expect(irdm_simulation_load(simulation_, state.data(), state.size(), message.data(),
                                message.size()) == IRDM_FAILED,
           "no few bytes are a state");
    expect(message[0] != '\0', "why is said");
  }

  static void parse(const std::string& text) {
    std::array<char, 80> message{};
    irdm_simulation* other = nullptr;
    const irdm_status status =
        irdm_simulation_parse(text.c_str(), &other, message.data(), message.size());
    expect((status == IRDM_OK) == (other != nullptr), "a scene is opened, or there is none");
    irdm_simulation_close(other);
  }

  irdm_simulation* simulation_ = nullptr;
};

}  // namespace

void c_calls(Input input) {
  Caller caller;
  Bytes bytes(input);
  for (int call = 0; bytes.any() && call < kMostCalls; ++call) caller.call(bytes);
}

}  // namespace irdm::fuzz
