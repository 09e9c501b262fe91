#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/checksum.hpp"
#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "scene/scene.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// The force on a point is that on the corners of its triangle, as a trace has it.
const std::string kPoint = "[[stylus]]\nradius = 0\n";

constexpr std::uint8_t kNoContact = 0;
constexpr double kHeldUntil = 1.0;  // of press_and_swing(), here [s]
constexpr double kAgain = 1.3;      // when it begins anew [s]

/// The body at the start of a step.
struct Body {
  Vector3 position;
  Quaternion orientation;
  Vector3 velocity;
  Vector3 angular_velocity;
};

Body body_before(const Trace& trace, const ObjectConfig& object, std::size_t k) {
  if (k == 0 || trace.reset[k] != 0) {
    return {object.position, object.orientation, object.velocity, object.angular_velocity};
  }
  return {trace.vector("/step/body_position", k - 1), trace.orientation(k - 1),
          trace.vector("/step/body_velocity", k - 1),
          trace.vector("/step/body_angular_velocity", k - 1)};
}

SurfacePoint contact_point(const Trace& trace, std::size_t k) {
  const Vector3 weights = trace.vector("/stylus/0/contact_weights", k);
  SurfacePoint point;
  for (std::size_t i = 0; i < 3; ++i) {
    point.nodes[i] = trace.contact_nodes[3 * k + i];
    point.weights[i] = weights[static_cast<Eigen::Index>(i)];
  }
  return point;
}

/// The constant w [rad/s], W, with which a body turns through a step of dt while its angular
/// momentum stays: that of the orientation half-way. Found here by repeating until nothing changes.
Vector3 free_angular_velocity(const Body& body, const Matrix3& inertia, double dt) {
  const Matrix3 Q = body.orientation.toRotationMatrix();
  const Vector3 momentum = Q * inertia * Q.transpose() * body.angular_velocity;
  Vector3 w = body.angular_velocity;
  for (int round = 0; round < 100 && w.norm() > 0; ++round) {
    const Matrix3 half = Eigen::AngleAxisd(0.5 * dt * w.norm(), w.normalized()) * Q;
    w = half * inertia.inverse() * half.transpose() * momentum;
  }
  return w;
}

/// The orientation half-way through a step without torque: forces in B have their direction in W by
/// it.
Quaternion halfway(const Body& body, const Model& model) {
  const Vector3 w = free_angular_velocity(body, model.body.inertia, model.dt);
  if (!(w.norm() > 0)) return body.orientation;
  return Eigen::AngleAxisd(0.5 * model.dt * w.norm(), w.normalized()) * body.orientation;
}

/// The force on the object [N], B, for one contact: docs/theory.md. Where the
/// point is wanted is taken into the frame that free motion leads to, with the whole of its
/// rotation.
Vector3 contact_force(const Model& model, const SceneConfig& scene, const Body& body,
                      const SurfacePoint& point, const Vector3& tip, const Vector3& offset,
                      ResponseEngine& engine) {
  const double dt = model.dt;
  const Matrix3 Q = body.orientation.toRotationMatrix();
  Vector3 h;
  ContactMatrix elastic;
  const ContactPatch patch(point);
  engine.predict({&patch, 1}, {&h, 1}, elastic);
  Vector3 r = h;
  for (std::size_t i = 0; i < 3; ++i) {
    r += point.weights[i] * model.mesh.rest_position(point.nodes[i]);
  }
  const Vector3 w_free = free_angular_velocity(body, model.body.inertia, dt);
  Matrix3 Q_free = Q;
  if (w_free.norm() > 0) Q_free = Eigen::AngleAxisd(dt * w_free.norm(), w_free.normalized()) * Q;
  const Vector3 p = Q_free.transpose() * (tip - body.position - dt * body.velocity -
                                          0.5 * dt * dt * scene.world.gravity) -
                    offset;
  const Matrix3 cross = skew(r + offset);
  const Matrix3 W =
      Matrix3(elastic) +
      0.5 * dt * dt *
          (Matrix3::Identity() / model.body.mass - cross * model.body.inertia.inverse() * cross) +
      Matrix3::Identity() / scene.contact.coupling_stiffness;
  return W.partialPivLu().solve(p - r);
}

/// The angular velocity half-way through a step without torque [rad/s], B: what inertial loading
/// holds during it.
Vector3 held_spin(const Body& body, const Model& model) {
  const Vector3 w = free_angular_velocity(body, model.body.inertia, model.dt);
  const Matrix3 half = Eigen::AngleAxisd(0.5 * model.dt * w.norm(), w.normalized()) *
                       body.orientation.toRotationMatrix();
  return half.transpose() * w;
}

// Runs what is on the stage in lockstep.
Trace play(const Stage& stage) {
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  return read_trace(stage.path("trace.h5"));
}

// Everything that can move it: gravity, an attitude, a spin.
std::string moving_scene() {
  return scene_text("[world]\ngravity = [0.01, -0.05, 0.02]\n" + kPoint) +
         "position = [0.002, 0.001, -0.001]\norientation = [0.98, 0.02, -0.15, 0.03]\n"
         "velocity = [0.01, 0.0, -0.01]\nangular_velocity = [0.1, 0.4, -0.2]\n";
}

// Presses and swings, presses the reset button (bit 2) while it holds the object, and does it all
// again.
std::string twice_with_a_reset() {
  std::istringstream rows(press_and_swing());
  std::string line;
  std::getline(rows, line);
  std::string first = line + "\n";
  std::string second;
  while (std::getline(rows, line)) {
    const double time = std::stod(line);
    if (time < kHeldUntil) first += line + "\n";
    second += std::to_string(time + kAgain) + line.substr(line.find(',')) + "\n";
  }
  const std::string place = ",0.01,-0.04,0.02,";
  return first + std::to_string(kHeldUntil) + place + "5\n" + std::to_string(kHeldUntil + 0.02) +
         place + "0\n" + std::to_string(kAgain - 0.1) + ",0.01,0.1,0.02,0\n" + second;
}

void check_forces(const Trace& trace, std::size_t least_touching, std::size_t least_held) {
  const SceneConfig scene = read_scene(TomlTable::parse_text(trace.scene, "scene"));
  const ObjectConfig& object = scene.objects.at(0);
  REQUIRE(trace.model_checksum == sha256_of_file(object.model));
  const auto model = std::make_shared<const Model>(read_model(object.model, ResponseKind::kModal));
  const std::unique_ptr<ResponseEngine> engine = make_engine(model);
  double peak = 0.0;
  double worst = 0.0;
  std::size_t touching = 0;
  std::size_t held = 0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    std::vector<NodalForce> nodal;
    if (trace.reset[k] != 0) engine->reset();
    if (trace.contact[k] != kNoContact) {
      const Body body = body_before(trace, object, k);
      const SurfacePoint point = contact_point(trace, k);
      const Vector3 force = trace.vector("/stylus/0/force", k);  // on the stylus, W
      const bool releasing = trace.contact[k] == 2 && (trace.buttons[k] & 1) == 0;
      const Vector3 found =
          contact_force(*model, scene, body, point, trace.vector("/stylus/0/tip", k),
                        trace.vector("/stylus/0/offset", k), *engine);
      peak = std::max(peak, force.norm());
      // What slips is on the cone instead, and what is given up is held less and less.
      if (trace.slipping[k] == 0 && !releasing) {
        worst = std::max(worst, (halfway(body, *model) * found + force).norm());
        ++(trace.contact[k] == 1 ? touching : held);
      }
      const Vector3 on_object = -(halfway(body, *model).conjugate() * force);
      for (std::size_t i = 0; i < 3; ++i) {
        nodal.push_back({point.nodes[i], point.weights[i] * on_object});
      }
    }
    engine->advance(nodal);
  }
  REQUIRE(touching > least_touching);
  REQUIRE(held > least_held);
  REQUIRE(peak > 0.2);
  INFO("largest difference " << worst << " N, peak " << peak << " N");
  CHECK(worst < 1e-9 * peak);
}

SimulationConfig simulation_of(const SceneConfig& scene, std::shared_ptr<const Model> model) {
  const ObjectConfig& object = scene.objects.at(0);
  SimulationConfig config;
  config.gravity = scene.world.gravity;
  config.objects = {{std::move(model), object.position, object.orientation, object.velocity,
                     object.angular_velocity, object.friction, object.damping, object.tether}};
  config.styluses = scene.styluses;
  config.floor = scene.floor;
  config.release_time = scene.contact.release_time;
  return config;
}

/// The floor's forces in a trace of one object.
struct FloorSets {
  explicit FloorSets(const std::filesystem::path& path) {
    const hdf5::File file = hdf5::File::open(path);
    count = file.read<std::int32_t>("/floor/count", {0});
    node = file.read<std::int32_t>("/floor/node", {0});
    force = file.read<float>("/floor/force", {node.size(), 3});
  }
  NodalForce row(std::size_t i) const {
    return {node[i], Eigen::Map<const Eigen::Vector3f>(force.data() + 3 * i).cast<double>()};
  }
  std::vector<std::int32_t> count, node;
  std::vector<float> force;
};

// A cube that drops 5 mm onto a floor, and is pressed on it and pushed along.
void set_on_floor(const Stage& stage) {
  stage.write("scene.toml", scene_text("[world]\ngravity = [0, -9.81, 0]\n[floor]\nheight = "
                                       "-0.065\nfriction = { static = 0.3, kinetic = 0.2 }\n" +
                                       kPoint));
  stage.write("script.csv",
              "time,x,y,z,button\n0,0.02,0.07,0.01,0\n0.6,0.02,0.07,0.01,0\n"
              "0.9,0.02,0.045,0.01,0\n1.4,0.05,0.045,0.01,0\n1.6,0.05,0.08,0.01,4\n"
              "2.0,0.05,0.08,0.01,0\n");
}

}  // namespace

TEST_CASE("forces are recomputed from a trace and its model alone") {
  const Stage stage;
  stage.write("scene.toml", moving_scene());
  check_forces(play(stage), 50, 250);
}

TEST_CASE("forces are recomputed from a trace in which everything was reset", "[unsanitized]") {
  const Stage stage;
  stage.write("scene.toml", moving_scene());
  stage.write("script.csv", twice_with_a_reset());
  const Trace trace = play(stage);
  REQUIRE(std::count(trace.reset.begin(), trace.reset.end(), 1) == 1);
  const auto k = static_cast<std::size_t>(std::find(trace.reset.begin(), trace.reset.end(), 1) -
                                          trace.reset.begin());
  // The reset takes the object out of the hand that holds it, and what it gives back is as it was.
  CHECK(trace.contact[k - 1] == 2);
  CHECK(trace.contact[k] == 0);
  CHECK(trace.buttons[k] == 3);
  CHECK(trace.vector("/step/body_position", k) == trace.vector("/step/body_position", 0));
  CHECK(trace.vector("/step/body_angular_velocity", k) ==
        trace.vector("/step/body_angular_velocity", 0));
  check_forces(trace, 80, 350);
}

TEST_CASE("poses are recomputed from the forces of a trace, those of the floor included") {
  const Stage stage;
  set_on_floor(stage);
  const Trace trace = play(stage);
  const FloorSets floor(stage.path("trace.h5"));
  REQUIRE(floor.count.size() == trace.rows());
  const SceneConfig scene = read_scene(TomlTable::parse_text(trace.scene, "scene"));
  const ObjectConfig& object = scene.objects.at(0);
  const auto model = std::make_shared<const Model>(read_model(object.model, ResponseKind::kModal));
  const std::unique_ptr<ResponseEngine> engine = make_engine(model);
  const double dt = model->dt;
  const double mass = model->body.mass;
  const auto momentum = [&](const Matrix3& Q, const Vector3& w) {
    return Vector3(Q * model->body.inertia * Q.transpose() * w);
  };
  double worst_velocity = 0.0;
  double worst_momentum = 0.0;
  double worst_position = 0.0;
  std::size_t row = 0;
  std::size_t pressed = 0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    if (trace.reset[k] != 0) engine->reset();
    const Body body = body_before(trace, object, k);
    const Quaternion Q_half = halfway(body, *model);
    std::vector<NodalForce> nodal;
    for (std::int32_t c = 0; c < floor.count[k]; ++c) nodal.push_back(floor.row(row++));
    if (trace.contact[k] != kNoContact) {
      const SurfacePoint point = contact_point(trace, k);
      const Vector3 force = -(Q_half.conjugate() * trace.vector("/stylus/0/force", k));
      for (std::size_t i = 0; i < 3; ++i) {
        nodal.push_back({point.nodes[i], point.weights[i] * force});
      }
      pressed += floor.count[k] > 0 ? 1 : 0;
    }
    Vector3 force = Vector3::Zero();
    Vector3 torque = Vector3::Zero();
    if (trace.contact[k] != kNoContact) {  // it acts where the tip is felt
      torque -=
          Vector3(trace.vector("/stylus/0/offset", k) + trace.vector("/stylus/0/arm_shift", k))
              .cross(Q_half.conjugate() * trace.vector("/stylus/0/force", k));
    }
    for (const NodalForce& at : nodal) {
      const Vector3 arm = model->mesh.rest_position(at.node) + engine->free_displacement(at.node);
      force += at.force;
      torque += arm.cross(at.force);
    }
    engine->advance(nodal);
    const Vector3 velocity = body.velocity + dt * (scene.world.gravity + Q_half * force / mass);
    worst_velocity =
        std::max(worst_velocity, (trace.vector("/step/body_velocity", k) - velocity).norm());
    const Vector3 position = body.position + 0.5 * dt * (body.velocity + velocity);
    worst_position =
        std::max(worst_position, (trace.vector("/step/body_position", k) - position).norm());
    const Vector3 turning = momentum(body.orientation.toRotationMatrix(), body.angular_velocity) +
                            dt * (Q_half * torque);
    worst_momentum =
        std::max(worst_momentum, (momentum(trace.orientation(k).toRotationMatrix(),
                                           trace.vector("/step/body_angular_velocity", k)) -
                                  turning)
                                     .norm());
  }
  CHECK(row == floor.node.size());
  CHECK(pressed > 100);
  INFO("off by " << worst_velocity << " m/s, " << worst_position << " m, " << worst_momentum
                 << " N m s");
  CHECK(worst_velocity < 1e-12);
  CHECK(worst_position < 1e-14);
  CHECK(worst_momentum < 1e-14);
}

TEST_CASE("a run is rerun, to the bit, from the tips and buttons of its trace") {
  const Stage stage;
  set_on_floor(stage);
  const Trace trace = play(stage);
  const FloorSets floor(stage.path("trace.h5"));
  const SceneConfig scene = read_scene(TomlTable::parse_text(trace.scene, "scene"));
  const auto model =
      std::make_shared<const Model>(read_model(scene.objects.at(0).model, ResponseKind::kModal));
  Simulation simulation(simulation_of(scene, model));
  StepRecord record;
  std::size_t row = 0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    const StylusCommand command{trace.present[k] != 0, static_cast<std::uint32_t>(trace.buttons[k]),
                                trace.vector("/stylus/0/tip", k), std::nullopt};
    simulation.step({&command, 1}, record);
    const ObjectRecord& object = record.object[0];
    REQUIRE(record.reset == (trace.reset[k] != 0));
    REQUIRE(object.position == trace.vector("/step/body_position", k));
    REQUIRE(object.orientation.coeffs() == trace.orientation(k).coeffs());
    REQUIRE(object.velocity == trace.vector("/step/body_velocity", k));
    REQUIRE(object.angular_velocity == trace.vector("/step/body_angular_velocity", k));
    REQUIRE(record.stylus[0].force == trace.vector("/stylus/0/force", k));
    REQUIRE(object.floor_count == floor.count[k]);
    for (std::size_t c = 0; c < static_cast<std::size_t>(floor.count[k]); ++c, ++row) {
      REQUIRE(object.floor[c].node == floor.node[row]);
      REQUIRE(object.floor[c].force.cast<double>() == floor.row(row).force);
    }
  }
  CHECK(row > 1000);
  CHECK(std::count(trace.reset.begin(), trace.reset.end(), 1) == 1);
}

TEST_CASE("the touched point's place is recomputed from a trace, inertial loading included",
          "[slow]") {
  const std::string kind = GENERATE("modal", "dense");
  const Stage stage;
  stage.write("scene.toml", scene_text(kPoint, kind) +
                                "angular_velocity = [0.5, 3.0, -0.2]\ninertial_loading = true\n");
  const Trace trace = play(stage);
  const ObjectConfig object = read_scene(TomlTable::parse_text(trace.scene, "scene")).objects.at(0);
  const auto model = std::make_shared<const Model>(
      read_model(object.model, kind == "modal" ? ResponseKind::kModal : ResponseKind::kDense));
  const auto with = make_engine(model);
  const auto without = make_engine(model);
  double worst = 0.0;
  double worst_without = 0.0;
  std::size_t compared = 0;
  Points u;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    const Body before = body_before(trace, object, k);
    const SurfacePoint point = contact_point(trace, k);
    const bool free = trace.contact[k] == kNoContact;
    std::vector<NodalForce> nodal;
    const Vector3 force =
        -(halfway(before, *model).conjugate() * trace.vector("/stylus/0/force", k));
    for (std::size_t i = 0; i < 3 && !free; ++i) {
      nodal.push_back({point.nodes[i], point.weights[i] * force});
    }
    with->capabilities().inertial_loading->set_angular_velocity(held_spin(before, *model));
    with->advance(nodal);
    without->advance(nodal);
    if (free) continue;
    const auto error = [&](const ResponseEngine& engine) {
      engine.displacement(u);
      Vector3 r = Vector3::Zero();
      for (std::size_t i = 0; i < 3; ++i) {
        r += point.weights[i] *
             (model->mesh.rest_position(point.nodes[i]) + u.row(point.nodes[i]).transpose());
      }
      return (trace.vector("/step/body_position", k) + trace.orientation(k) * r -
              trace.vector("/stylus/0/proxy", k))
          .norm();
    };
    worst = std::max(worst, error(*with));
    worst_without = std::max(worst_without, error(*without));
    ++compared;
  }
  INFO("largest difference " << worst << " m, without the spin " << worst_without << " m");
  CHECK(compared > 300);
  CHECK(worst < 1e-12);
  CHECK(worst_without > 1e-5);
}
