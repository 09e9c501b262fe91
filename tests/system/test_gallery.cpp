// Every scene of the gallery (docs/configuration.md), played as it is in configs/, by processes in
// lockstep; and what physics says of it, found in the trace.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "scene/scene.hpp"
#include "tests/system/stage.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

const std::filesystem::path kConfigs = IRDM_SOURCE_DIR "/configs";

// A model of configs/models, made once a process.
std::filesystem::path gallery_model(const std::string& name) {
  static const TemporaryFolder folder;
  const std::filesystem::path model = folder.path() / (name + ".h5");
  if (!std::filesystem::exists(model)) {
    const FinishedProgram made = run_to_end(
        {IRDM_PRECOMPUTE, (kConfigs / "models" / (name + ".toml")).string(), "-o", model.string()});
    if (made.status != 0) throw std::runtime_error("no model: " + made.err);
  }
  return model;
}

/// The trace of a scene that was played to its end.
class Played {
 public:
  explicit Played(const std::string& scene, const std::string& bridge = "") {
    const std::string text = file_content(kConfigs / "scenes" / (scene + ".toml"));
    stage_.write("scene.toml", text);
    config_ = read_scene(TomlTable::parse_file(stage_.path("scene.toml")));
    for (const ObjectConfig& object : config_.objects) {
      if (std::filesystem::exists(object.model)) continue;
      std::filesystem::create_symlink(gallery_model(object.model.stem().string()), object.model);
    }
    Server server =
        stage_.start_server({"--lockstep", "--record", stage_.path("trace.h5").string()});
    const std::string name = (bridge.empty() ? scene : bridge) + ".toml";
    ChildProcess player({IRDM_BRIDGE, (kConfigs / "bridges" / name).string(), "--server",
                         "127.0.0.1:" + std::to_string(server.port)});
    REQUIRE(player.wait() == 0);
    REQUIRE(server.process.wait() == 0);
    CHECK(number_after(server.process.out(), "steps without a finite solution: ") == 0);
    file_ = std::make_unique<hdf5::File>(hdf5::File::open(stage_.path("trace.h5")));
    rows_ = file_->shape("/step/time")[0];
    dt_ = file_->read_double_attribute("/", "dt");
    mass_ = mass();
  }

  std::size_t rows() const { return rows_; }
  double dt() const { return dt_; }
  const SceneConfig& scene() const { return config_; }
  /// The row at whose end it is `time` [s].
  std::size_t row(double time) const {
    return static_cast<std::size_t>(std::lround(time / dt_)) - 1;
  }
  Vector3 vector(const std::string& set, std::size_t k) {
    std::vector<double>& values = vectors_[set];
    if (values.empty()) values = file_->read<double>(set, {rows_, 3});
    return Vector3(values.data() + 3 * k);
  }
  Vector3 position(std::size_t k) { return vector("/step/body_position", k); }
  Vector3 force(std::size_t k, int stylus = 0) {
    return vector("/stylus/" + std::to_string(stylus) + "/force", k);
  }
  Vector3 tip(std::size_t k, int stylus = 0) {
    return vector("/stylus/" + std::to_string(stylus) + "/tip", k);
  }
  Quaternion orientation(std::size_t k) {
    std::vector<double>& wxyz = vectors_["/step/body_orientation"];
    if (wxyz.empty()) wxyz = file_->read<double>("/step/body_orientation", {rows_, 4});
    return {wxyz[4 * k], wxyz[4 * k + 1], wxyz[4 * k + 2], wxyz[4 * k + 3]};
  }
  std::vector<std::uint8_t> flags(const std::string& set) const {
    return file_->read<std::uint8_t>(set, {rows_});
  }
  double mass(std::size_t object = 0) const { return model(object).body.mass; }
  Model model(std::size_t object = 0) const {
    return read_model(config_.objects[object].model, ResponseKind::kModal);
  }
  /// Sum of the forces on the object by another one, or by scenery i (-1 - i), in step k [N], W.
  Vector3 body_force(std::size_t k, int object, int other) {
    if (touching_.empty()) read_body_contacts();
    Vector3 sum = Vector3::Zero();
    for (const Touch& touch : touching_[k]) {
      if (touch.object == object && touch.other == other) sum += touch.force;
      if (touch.object == other && touch.other == object) sum -= touch.force;
    }
    return sum;
  }
  /// Of a floating object alone: mass times acceleration in step k, less all forces on it [N], W.
  /// Damping acts at both ends of a step, half of it each.
  Vector3 unbalanced(std::size_t k) {
    const double share = std::exp(-0.5 * dt_ * config_.objects[0].damping.linear);
    const Vector3 gained =
        vector("/step/body_velocity", k) / share - vector("/step/body_velocity", k - 1) * share;
    Vector3 forces = mass_ * config_.world.gravity;
    for (std::size_t s = 0; s < config_.styluses.size(); ++s)
      forces -= force(k, static_cast<int>(s));
    for (std::size_t i = 0; i < config_.scenery.size(); ++i) {
      forces += body_force(k, 0, -1 - static_cast<int>(i));
    }
    return mass_ / dt_ * gained - forces;
  }
  /// Sum of the floor's forces on the object in step k [N], W.
  Vector3 floor_force(std::size_t k) {
    const auto count = file_->read<std::int32_t>("/floor/count", {rows_});
    const auto force = file_->read<float>("/floor/force", {0, 3});
    std::size_t row = 0;
    for (std::size_t i = 0; i < k; ++i) row += static_cast<std::size_t>(count[i]);
    Vector3 sum = Vector3::Zero();
    for (std::int32_t c = 0; c < count[k]; ++c, ++row) {
      sum += Eigen::Map<const Eigen::Vector3f>(force.data() + 3 * row).cast<double>();
    }
    return orientation(k - 1) * sum;
  }
  /// Where the stylus touches its surface at rest in step k [m], B.
  Vector3 contact_at_rest(std::size_t k, int stylus, const Model& model) {
    const std::string group = "/stylus/" + std::to_string(stylus);
    std::vector<std::int32_t>& nodes = contact_nodes_[stylus];
    if (nodes.empty()) nodes = file_->read<std::int32_t>(group + "/contact_nodes", {rows_, 3});
    const Vector3 weights = vector(group + "/contact_weights", k);
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < 3; ++i) {
      sum += weights[i] * model.mesh.rest_position(nodes[3 * k + static_cast<std::size_t>(i)]);
    }
    return sum;
  }
  double peak_force(int stylus = 0) {
    double peak = 0.0;
    for (std::size_t k = 0; k < rows_; ++k) peak = std::max(peak, force(k, stylus).norm());
    return peak;
  }

 private:
  struct Touch {
    int object;
    int other;
    Vector3 force;
  };

  void read_body_contacts() {
    const auto step = file_->read<std::uint64_t>("/body_contact/force_step", {0});
    const auto object = file_->read<std::int32_t>("/body_contact/object", {0});
    const auto other = file_->read<std::int32_t>("/body_contact/other", {0});
    const auto force = file_->read<double>("/body_contact/force", {0, 3});
    const auto first = file_->read<std::uint64_t>("/step/force_step", {rows_}).front();
    touching_.resize(rows_);
    for (std::size_t i = 0; i < step.size(); ++i) {
      touching_[step[i] - first].push_back({object[i], other[i], Vector3(force.data() + 3 * i)});
    }
  }

  Stage stage_;
  SceneConfig config_;
  double mass_ = 0.0;                         ///< of the first object [kg]
  std::vector<std::vector<Touch>> touching_;  ///< of each step
  std::unique_ptr<hdf5::File> file_;
  std::size_t rows_ = 0;
  double dt_ = 0.0;
  std::map<std::string, std::vector<double>> vectors_;
  std::map<int, std::vector<std::int32_t>> contact_nodes_;
};

std::size_t count(const std::vector<std::uint8_t>& values, int value) {
  return static_cast<std::size_t>(std::count(values.begin(), values.end(), value));
}

}  // namespace

TEST_CASE("gallery, press: at rest under the tip the tether carries the force, and lets it back") {
  Played played("press");
  const std::size_t pressed = played.row(2.45);
  const double stiffness = played.scene().objects[0].tether.stiffness;
  CHECK(played.force(pressed).norm() > 0.3);
  CHECK(-stiffness * played.position(pressed).y() ==
        Approx(played.force(pressed).y()).epsilon(0.02));
  // The tip goes deeper than the object gives way: it is soft.
  CHECK(0.06 - played.tip(pressed).y() > -1.5 * played.position(pressed).y());
  CHECK(played.position(played.rows() - 1).norm() < 5e-4);
}

TEST_CASE("gallery, tap: the cube drifts off with the momentum of the tap") {
  Played played("tap");
  const auto contact = played.flags("/stylus/0/contact");
  CHECK(count(contact, 1) > 10);
  CHECK(contact.back() == 0);
  Vector3 impulse = Vector3::Zero();
  for (std::size_t k = 0; k < played.rows(); ++k) impulse -= played.dt() * played.force(k);
  const Vector3 momentum = played.mass() * played.vector("/step/body_velocity", played.rows() - 1);
  CHECK(momentum.y() < -0.01);
  CHECK((momentum - impulse).norm() < 1e-10 * impulse.norm());
}

TEST_CASE("gallery, two cubes: the stiff one gives the larger and shorter blow") {
  Played played("two-cubes");
  const auto steps = [&](int stylus) {
    return count(played.flags("/stylus/" + std::to_string(stylus) + "/contact"), 1);
  };
  CHECK(played.peak_force(1) > 2.0 * played.peak_force(0));
  REQUIRE(steps(1) > 3);
  CHECK(3 * steps(1) < 2 * steps(0));
  // Each stylus touches the cube that is under it, and both cubes go down.
  for (const std::string name : {"soft", "stiff"}) {
    CHECK(played.vector("/object/" + name + "/body_position", played.rows() - 1).y() < -0.1);
  }
  CHECK(played.flags("/object/soft/stylus/1/contact") ==
        std::vector<std::uint8_t>(played.rows(), 0));
  CHECK(played.flags("/object/stiff/stylus/0/contact") ==
        std::vector<std::uint8_t>(played.rows(), 0));
}

TEST_CASE("gallery, pinch: friction lifts the cube as far as the pinched points go up") {
  Played played("pinch");
  const std::size_t below = played.row(1.55);
  const std::size_t above = played.row(3.5);
  // Of the points that the tips hold; between tip and point is the coupling spring.
  const auto held = [&](std::size_t k) {
    return 0.5 * (played.vector("/stylus/0/proxy", k) + played.vector("/stylus/1/proxy", k)).y();
  };
  const double lift = held(above) - held(below);
  CHECK(lift > 0.04);
  CHECK(played.position(above).y() - played.position(below).y() == Approx(lift).margin(2e-3));
  // In the air the two of them carry it.
  const double weight = 9.81 * played.mass();
  CHECK(-(played.force(above, 0) + played.force(above, 1)).y() == Approx(weight).epsilon(0.02));
  CHECK(played.floor_force(above).isZero(0.0));
  CHECK(played.floor_force(played.rows() - 1).y() == Approx(weight).epsilon(0.02));
  CHECK(std::abs(played.position(played.rows() - 1).y()) < 1e-3);
}

TEST_CASE("gallery, swing: the object follows the stylus that holds it") {
  Played played("swing");
  const auto contact = played.flags("/stylus/0/contact");
  const double stiffness = played.scene().styluses[0].coupling_stiffness;
  double farthest = 0.0;
  double off = 0.0;
  for (std::size_t k = played.row(0.75); k < played.row(5.15); ++k) {
    REQUIRE(contact[k] == 2);
    farthest = std::max(farthest, std::abs(played.position(k).x()));
    // What is held is where the coupling spring lets it be, at the offset that it was taken at.
    const Vector3 held =
        played.tip(k) - played.orientation(k) * played.vector("/stylus/0/offset", k);
    off = std::max(off, (held - played.vector("/stylus/0/proxy", k)).norm() -
                            played.force(k).norm() / stiffness);
  }
  INFO("centre of mass " << farthest << " m to the side, point off by " << off << " m");
  CHECK(farthest > 0.015);
  CHECK(off < 2e-4);
  CHECK(contact.back() == 0);
}

TEST_CASE("gallery, slide: the contact slips along the top, with kinetic friction") {
  Played played("slide");
  const auto slipping = played.flags("/stylus/0/slipping");
  const double friction = played.scene().objects[0].friction.kinetic;
  const std::size_t begin = played.row(1.5);
  const std::size_t end = played.row(2.5);
  double worst = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    REQUIRE(slipping[k] == 1);
    const Vector3 force = played.orientation(k - 1).conjugate() * played.force(k);
    const double along = Vector3(force.x(), 0, force.z()).norm();
    worst = std::max(worst, std::abs(along / force.y() - friction));
    CHECK(force.x() < 0.0);  // against the motion
  }
  INFO("friction off by " << worst);
  CHECK(worst < 0.01);
  CHECK((played.vector("/stylus/0/proxy", end) - played.vector("/stylus/0/proxy", begin)).x() >
        0.04);
}

TEST_CASE(
    "gallery, rest: the floor carries the cube that has dropped on it, and pushed it slides") {
  Played played("rest");
  const double weight = 9.81 * played.mass();
  double mean = 0.0;
  const std::size_t begin = played.row(2.0);
  const std::size_t end = played.row(2.5);
  for (std::size_t k = begin; k < end; ++k) mean += played.floor_force(k).y() / (end - begin);
  CHECK(mean == Approx(weight).epsilon(0.002));
  CHECK((played.position(end) - played.position(begin)).norm() < 3e-4);
  const double pushed = played.position(played.rows() - 1).x() - played.position(end).x();
  CHECK(pushed < -0.015);
  // While it slides, the stylus has to overcome friction; the floor takes what it presses down.
  CHECK(played.peak_force() > played.scene().floor->friction.kinetic * weight);
  CHECK(std::abs(played.position(played.rows() - 1).y() - played.position(end).y()) < 1e-3);
}

TEST_CASE(
    "gallery, stack: at rest each cube carries what is above it; pushed over, all three lie") {
  Played played("stack");
  const double weight = 9.81 * played.mass();
  const std::size_t rest = played.row(2.9);
  for (int i = 0; i < 3; ++i) {
    const Vector3 carried = played.body_force(rest, i, i - 1);  // the plane is -1
    CHECK(carried.y() == Approx((3 - i) * weight).epsilon(0.005));
    CHECK(Vector3(carried.x(), 0, carried.z()).norm() < 0.01 * weight);
  }
  const std::size_t end = played.rows() - 1;
  double farthest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const std::string set =
        "/object/" + played.scene().objects[static_cast<std::size_t>(i)].name + "/body_position";
    CHECK(played.vector(set, end).y() == Approx(0.06).margin(1e-3));
    CHECK(played.body_force(end, i, -1).y() == Approx(weight).epsilon(0.01));
    CHECK(played.vector(set, end).x() < farthest - 0.1);  // each beside the one that was below it
    farthest = played.vector(set, end).x();
  }
}

TEST_CASE("gallery, tray: led against all four walls, the cube stays inside", "[slow]") {
  Played played("tray");
  const double inner = 0.13 - 0.06;  // m, of the centre, if the cube were rigid
  double farthest = 0.0;
  double lowest = 1.0;
  double highest = 0.0;
  double unbalanced = 0.0;
  std::array<double, 5> largest{};  // of the base and the walls
  for (std::size_t k = 1; k < played.rows(); ++k) {
    const Vector3 place = played.position(k);
    farthest = std::max({farthest, std::abs(place.x()), std::abs(place.z())});
    lowest = std::min(lowest, place.y());
    highest = std::max(highest, place.y());
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    for (int i = 0; i < 5; ++i) {
      double& most = largest[static_cast<std::size_t>(i)];
      most = std::max(most, played.body_force(k, 0, -1 - i).norm());
    }
  }
  INFO("centre as far as " << farthest << " m, from " << lowest << " to " << highest
                           << " m high, forces off by " << unbalanced << " N");
  CHECK(farthest < inner + 0.01);
  CHECK(lowest > 0.05);
  CHECK(highest < 0.07);
  CHECK(unbalanced < 1e-9);
  for (const double most : largest) CHECK(most > 0.3);
  const double weight = 9.81 * played.mass();
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.02));
}

TEST_CASE("gallery, peg: both posts resist alike, until the cube has come between them", "[slow]") {
  Played played("peg");
  const double weight = 9.81 * played.mass();
  const std::size_t pushed = played.row(3.0);
  const Vector3 front = played.body_force(pushed, 0, -2);
  const Vector3 back = played.body_force(pushed, 0, -3);
  INFO("posts " << front.transpose() << " N, " << back.transpose() << " N");
  CHECK(front.z() < -0.5);
  CHECK((front + back).z() == Approx(0.0).margin(0.05 * back.z()));
  CHECK((front - back).x() == Approx(0.0).margin(0.05 * back.x()));
  CHECK(back.x() > 0.1);  // against the push
  CHECK(played.force(pushed).x() > (front + back).x());
  double unbalanced = 0.0;
  for (std::size_t k = 1; k < played.rows(); ++k) {
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
  }
  INFO("forces off by " << unbalanced << " N");
  CHECK(unbalanced < 1e-9);
  // It stays in the gap when the stylus is gone, squeezed by both, its weight on the table.
  const std::size_t end = played.rows() - 1;
  CHECK(played.force(end).isZero(0.0));
  CHECK(std::abs(played.position(end).x()) < 0.03);
  CHECK((played.position(end) - played.position(played.row(5.5))).norm() < 5e-4);
  const Vector3 in_front = played.body_force(end, 0, -2);
  const Vector3 behind = played.body_force(end, 0, -3);
  CHECK(behind.z() > 0.3);
  // What they differ by the friction of the table takes.
  CHECK((in_front + behind).z() == Approx(0.0).margin(0.2 * behind.z()));
  CHECK((played.body_force(end, 0, -1) + in_front + behind).y() == Approx(weight).epsilon(0.01));
}

TEST_CASE("gallery, squeeze: friction alone lifts the ball, inside the cone, and carries it",
          "[slow]") {
  Played played("squeeze");
  const double weight = 9.81 * played.mass();
  const Model ball = played.model();
  const double friction = played.scene().objects[0].friction.static_;
  const std::size_t begin = played.row(3.6);
  const std::size_t end = played.row(4.1);
  CHECK(played.position(begin).y() - played.position(played.row(0.9)).y() > 0.04);
  double steepest = 0.0;  // of a force, as a share of that across the surface
  double by_pressure = -weight;
  double carried_off = 0.0;
  double unbalanced = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    Vector3 pressure = Vector3::Zero();
    for (int s = 0; s < 2; ++s) {
      const Vector3 rest = played.contact_at_rest(k, s, ball);
      const Vector3 normal = (played.orientation(k) * rest).normalized();  // of a ball
      const Vector3 force = -played.force(k, s);
      const Vector3 across = force.dot(normal) * normal;
      steepest = std::max(steepest, (force - across).norm() / across.norm());
      pressure += across;
    }
    by_pressure = std::max(by_pressure, pressure.y());
    carried_off = std::max(
        carried_off, std::abs(-(played.force(k, 0) + played.force(k, 1)).y() - weight) / weight);
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    CHECK(played.body_force(k, 0, -1).isZero(0.0));
  }
  INFO("forces along the surface up to " << steepest << " of those across it, which lift "
                                         << by_pressure << " N of " << weight << " N");
  CHECK(steepest < friction);
  CHECK(by_pressure < 0.0);  // they hold it above its middle: pressing pushes it down
  CHECK(carried_off < 0.01);
  CHECK(unbalanced < 1e-9);
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.1));
}

TEST_CASE("gallery, five fingers: they press alike, and friction carries the ball", "[slow]") {
  Played played("five-fingers");
  const double weight = 9.81 * played.mass();
  double unbalanced = 0.0;
  double carried_off = 0.0;
  double aside = 0.0;
  double least = 1e3;
  double most = 0.0;
  for (std::size_t k = played.row(3.6); k < played.row(4.1); ++k) {
    Vector3 sum = Vector3::Zero();
    for (int s = 0; s < 5; ++s) {
      const Vector3 force = -played.force(k, s);
      sum += force;
      const double push = Vector3(force.x(), 0, force.z()).norm();
      least = std::min(least, push);
      most = std::max(most, push);
    }
    carried_off = std::max(carried_off, std::abs(sum.y() - weight) / weight);
    aside = std::max(aside, Vector3(sum.x(), 0, sum.z()).norm());
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    CHECK(played.body_force(k, 0, -1).isZero(0.0));
  }
  INFO("they press with " << least << " to " << most << " N, aside " << aside << " N");
  CHECK(carried_off < 0.01);
  CHECK(aside < 0.01 * weight);
  CHECK(least > 0.9 * most);
  CHECK(unbalanced < 1e-9);
  CHECK(played.position(played.row(4.0)).y() - played.position(played.row(0.9)).y() > 0.04);
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.1));
}

TEST_CASE("gallery, spatula: it takes the slab's weight from the rails and gives it back",
          "[slow]") {
  Played played("spatula");
  const double weight = 9.81 * played.mass(0);
  const double tool = 9.81 * played.mass(1);
  const std::size_t lifted = played.row(7.5);
  CHECK(played.body_force(lifted, 0, 1).y() == Approx(weight).epsilon(0.005));
  CHECK(-played.force(lifted).y() == Approx(weight + tool).epsilon(0.005));
  CHECK(played.body_force(lifted, 0, -1).isZero(0.0));
  CHECK(played.body_force(lifted, 0, -2).isZero(0.0));
  for (const std::size_t k : {played.row(1.4), played.rows() - 1}) {
    const Vector3 front = played.body_force(k, 0, -1);
    const Vector3 back = played.body_force(k, 0, -2);
    CHECK((front + back).y() == Approx(weight).epsilon(0.005));
    CHECK(front.y() == Approx(back.y()).epsilon(0.02));
    CHECK((front + back).z() == Approx(0.0).margin(0.02 * weight));
    CHECK(-played.force(k).y() == Approx(tool).epsilon(0.005));
  }
  const std::string slab = "/object/slab/body_position";
  CHECK(played.vector(slab, lifted).y() - played.vector(slab, played.row(1.4)).y() > 0.03);
}

TEST_CASE("gallery, bowl: the rod stirs the cube, which stays inside", "[slow]") {
  Played played("bowl");
  const std::string cube = "/object/cube/body_position";
  double way = 0.0;
  double farthest = 0.0;
  double pushed = 0.0;
  for (std::size_t k = 1; k < played.rows(); ++k) {
    const Vector3 place = played.vector(cube, k);
    way += (place - played.vector(cube, k - 1)).norm();
    farthest = std::max({farthest, std::abs(place.x()), std::abs(place.z())});
    pushed = std::max(pushed, played.body_force(k, 0, 1).norm());
  }
  INFO("way " << way << " m, as far as " << farthest << " m, pushed with " << pushed << " N");
  CHECK(way > 0.1);
  CHECK(farthest < 0.13 - 0.03 + 0.01);
  CHECK(pushed > 0.3);
  const std::size_t end = played.rows() - 1;
  const double weight = 9.81 * played.mass(0);
  CHECK(played.body_force(end, 0, -1).y() == Approx(weight).epsilon(0.02));
  CHECK(-played.force(end).y() == Approx(9.81 * played.mass(1)).epsilon(0.02));
}

TEST_CASE("gallery, liver: it resists on both lobes, and stays where it is fixed", "[slow]") {
  Played played("liver", "palpate");
  const std::size_t thick = played.row(2.4);
  const std::size_t thin = played.row(6.4);
  for (const std::size_t k : {thick, thin}) {
    CHECK(played.force(k).y() > 0.2);
    // At rest, the hand's spring carries it: 300 N/m from the script to the tip.
    const double scripted = k == thick ? 0.017 : 0.007;
    CHECK(played.force(k).y() == Approx(300.0 * (played.tip(k).y() - scripted)).epsilon(0.02));
  }
  CHECK(played.position(played.rows() - 1).isZero(0.0));
  CHECK(played.flags("/stylus/0/contact").back() == 0);
}
