#include <catch2/catch.hpp>
#include <cmath>

#include "common/checksum.hpp"
#include "common/model/model_file.hpp"
#include "server/config/scene.hpp"
#include "server/engine/response_engine.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr std::uint8_t kFree = 0;

/// The body at the start of a step.
struct Body {
  Vector3 position;
  Quaternion orientation;
  Vector3 velocity;
  Vector3 angular_velocity;
};

Body body_before(const Trace& trace, const ObjectConfig& object, std::size_t k) {
  if (k == 0) {
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

/// The force on the object [N], B, for one contact: docs/architecture.md, one force step. Where the
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
  const Vector3 v_free = body.velocity + dt * scene.world.gravity;
  const Vector3 w_free = free_angular_velocity(body, model.body.inertia, dt);
  Matrix3 Q_free = Q;
  if (w_free.norm() > 0) Q_free = Eigen::AngleAxisd(dt * w_free.norm(), w_free.normalized()) * Q;
  const Vector3 p = Q_free.transpose() * (tip - body.position - dt * v_free) - offset;
  const Matrix3 cross = skew(r);
  const Matrix3 W =
      Matrix3(elastic) +
      dt * dt *
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

}  // namespace

TEST_CASE("forces are recomputed from a trace and its model alone") {
  const Stage stage;
  // Everything that can move it: gravity, an attitude, a spin, two kinds of contact.
  stage.write("scene.toml",
              scene_text("[world]\ngravity = [0.01, -0.05, 0.02]\n") +
                  "position = [0.002, 0.001, -0.001]\norientation = [0.98, 0.02, -0.15, 0.03]\n"
                  "velocity = [0.01, 0.0, -0.01]\nangular_velocity = [0.1, 0.4, -0.2]\n");
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);

  const Trace trace = read_trace(stage.path("trace.h5"));
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
    if (trace.contact[k] != kFree) {
      const Body body = body_before(trace, object, k);
      const SurfacePoint point = contact_point(trace, k);
      const Vector3 force = trace.vector("/stylus/0/force", k);  // on the stylus, W
      const Vector3 found =
          contact_force(*model, scene, body, point, trace.vector("/stylus/0/tip", k),
                        trace.vector("/stylus/0/offset", k), *engine);
      peak = std::max(peak, force.norm());
      worst = std::max(worst, (body.orientation * found + force).norm());
      ++(trace.contact[k] == 1 ? touching : held);
      const Vector3 on_object = -(body.orientation.conjugate() * force);
      for (std::size_t i = 0; i < 3; ++i) {
        nodal.push_back({point.nodes[i], point.weights[i] * on_object});
      }
    }
    engine->advance(nodal);
  }
  REQUIRE(touching > 50);
  REQUIRE(held > 250);
  REQUIRE(peak > 0.2);
  INFO("largest difference " << worst << " N, peak " << peak << " N");
  CHECK(worst < 1e-9 * peak);
}

TEST_CASE("the touched point's place is recomputed from a trace, inertial loading included") {
  const std::string kind = GENERATE("modal", "dense");
  const Stage stage;
  stage.write("scene.toml", scene_text("", kind) +
                                "angular_velocity = [0.5, 3.0, -0.2]\ninertial_loading = true\n");
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);

  const Trace trace = read_trace(stage.path("trace.h5"));
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
    const bool free = trace.contact[k] == kFree;
    std::vector<NodalForce> nodal;
    const Vector3 force = -(before.orientation.conjugate() * trace.vector("/stylus/0/force", k));
    for (std::size_t i = 0; i < 3 && !free; ++i) {
      nodal.push_back({point.nodes[i], point.weights[i] * force});
    }
    with->hold_spin(held_spin(before, *model));
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
