// A scene by the deformable bodies of Bullet: bullet SCENE.json RESULT.json
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

using nlohmann::json;

namespace {

constexpr double kMargin = 0.0005;  // of a soft body's surface [m]
constexpr double kToolMass = 1.0;   // [kg]

btVector3 vector(const json& x) {
  return {x[0], x[1], x[2]};
}
json list(const btVector3& x) {
  return {x.x(), x.y(), x.z()};
}

/// Centre of a tool [m].
btVector3 tool_at(const json& tool, double time) {
  const json& path = tool["path"];
  const auto point = [&](std::size_t i) { return btVector3(path[i][1], path[i][2], path[i][3]); };
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double end = path[i][0];
    if (end < time) continue;
    if (i == 0) return point(0);
    const double begin = path[i - 1][0];
    return point(i - 1).lerp(point(i), (time - begin) / (end - begin));
  }
  return point(path.size() - 1);
}

bool is_fixed(const json& body, std::size_t node) {
  return body.contains("fixed_below") &&
         body["nodes"][node][1].get<double>() <= body["fixed_below"].get<double>() + 1e-9;
}

/// What is added to it lives as long as the process.
class World {
 public:
  explicit World(const json& scene) : gravity_(vector(scene["gravity"])) {
    solver_.setDeformableSolver(&deformable_);
    world_ = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
        &dispatcher_, &broadphase_, &solver_, &configuration_, &deformable_);
    world_->setGravity(btVector3(0, 0, 0));
    // With implicit elastic forces a body that is touched does not get their momentum.
    world_->setImplicit(false);
    world_->setLineSearch(false);
    world_->setUseProjection(true);
    // As in Bullet's examples of deformable bodies that touch.
    world_->getSolverInfo().m_deformable_erp = 0.3;
    world_->getSolverInfo().m_deformable_maxErrorReduction = 200;
    world_->getSolverInfo().m_leastSquaresResidualThreshold = 1e-3;
    world_->getSolverInfo().m_splitImpulse = false;
    world_->getSolverInfo().m_numIterations = 100;
  }

  /// Smaller by the margin that the surface has.
  btRigidBody* ball(const json& tool) {
    auto* shape = new btSphereShape(tool["radius"].get<double>() - kMargin);
    btVector3 inertia(0, 0, 0);
    shape->calculateLocalInertia(kToolMass, inertia);
    auto* body = new btRigidBody(kToolMass, nullptr, shape, inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), tool_at(tool, 0.0)));
    body->setFriction(tool["friction"]);
    body->setActivationState(DISABLE_DEACTIVATION);
    world_->addRigidBody(body);
    return body;
  }

  btSoftBody* soft(const json& body, double friction) {
    std::vector<btVector3> nodes;
    for (const json& node : body["nodes"]) nodes.push_back(vector(node));
    auto mass = body["node_mass"].get<std::vector<btScalar>>();
    for (std::size_t i = 0; i < mass.size(); ++i) {
      if (is_fixed(body, i)) mass[i] = 0;  // does not move
    }
    auto* soft = new btSoftBody(&world_->getWorldInfo(), static_cast<int>(nodes.size()),
                                nodes.data(), mass.data());
    for (const json& tet : body["tets"]) {
      const auto node = tet.get<std::vector<int>>();
      soft->appendTetra(node[0], node[1], node[2], node[3]);
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) soft->appendLink(node[i], node[j], nullptr, true);
      }
    }
    btSoftBodyHelpers::generateBoundaryFaces(soft);
    soft->initializeDmInverse();
    soft->m_tetraScratches.resize(soft->m_tetras.size());
    soft->m_tetraScratchesTn.resize(soft->m_tetras.size());
    soft->getCollisionShape()->setMargin(kMargin);
    soft->m_cfg.kDF = friction;
    soft->m_cfg.kKHR = 1;
    soft->m_cfg.kCHR = 1;
    soft->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN |
                             btSoftBody::fCollision::VF_DD;
    soft->m_sleepingThreshold = 0;
    soft->setActivationState(DISABLE_DEACTIVATION);
    if (body.contains("velocity")) soft->setVelocity(vector(body["velocity"]));
    world_->addSoftBody(soft);
    const json& material = body["material"];
    const double young = material["youngs_modulus"];
    const double poisson = material["poisson_ratio"];
    world_->addForce(soft, new btDeformableLinearElasticityForce(
                               young / (2 * (1 + poisson)),
                               young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                               material["rayleigh_alpha"], material["rayleigh_beta"]));
    world_->addForce(soft, &gravity_);
    return soft;
  }

  void step(double dt) { world_->stepSimulation(dt, 0, dt); }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  btDeformableGravityForce gravity_;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world_;
};

btVector3 momentum(const json& body, const btSoftBody& soft) {
  btVector3 sum(0, 0, 0);
  for (int i = 0; i < soft.m_nodes.size(); ++i) {
    sum += soft.m_nodes[i].m_v * body["node_mass"][static_cast<std::size_t>(i)].get<double>();
  }
  return sum;
}

/// The force on the tool or on the second body is its change of momentum in a step; then a tool is
/// led on.
class Run {
 public:
  Run(const json& scene, int substeps)
      : scene_(scene), world_(scene), dt_(scene["dt"].get<double>() / substeps) {
    for (const json& body : scene["bodies"]) soft_.push_back(world_.soft(body, scene["friction"]));
    if (!scene["tools"].empty()) {
      ball_ = world_.ball(scene["tools"][0]);
      at_ = tool_at(scene["tools"][0], 0.0);
    }
  }
  btVector3 step(double time) {
    if (ball_ == nullptr && soft_.size() < 2) {
      world_.step(dt_);
      return {0, 0, 0};
    }
    if (ball_ == nullptr) {
      const btVector3 before = momentum(scene_["bodies"][1], *soft_[1]);
      world_.step(dt_);
      return (momentum(scene_["bodies"][1], *soft_[1]) - before) / dt_ -
             scene_["bodies"][1]["mass"].get<double>() * vector(scene_["gravity"]);
    }
    const btVector3 next = tool_at(scene_["tools"][0], time);
    const btVector3 speed = (next - at_) / dt_;
    ball_->setWorldTransform(btTransform(btQuaternion::getIdentity(), at_));
    ball_->setLinearVelocity(speed);
    ball_->setAngularVelocity(btVector3(0, 0, 0));
    world_.step(dt_);
    at_ = next;
    return kToolMass * (ball_->getLinearVelocity() - speed) / dt_;
  }
  double dt() const { return dt_; }
  json watched() const {
    json positions = json::array();
    for (const json& i : scene_["watched"]) {
      positions.push_back(list(soft_[0]->m_nodes[i.get<int>()].m_x));
    }
    return positions;
  }

 private:
  const json& scene_;
  World world_;
  double dt_;
  std::vector<btSoftBody*> soft_;
  btRigidBody* ball_ = nullptr;
  btVector3 at_;
};

/// Steps in one of the scene that are stable: elastic forces are explicit, damping is implicit.
int explicit_steps(const json& scene) {
  double highest = 0.0;
  for (const json& body : scene["bodies"]) {
    highest = std::max(highest, body["highest_frequency"].get<double>());
  }
  return static_cast<int>(std::ceil(scene["dt"].get<double>() * highest / 2));
}

json result_of(const json& scene, int substeps) {
  Run run(scene, substeps);
  const double dt = scene["dt"];
  std::set<long> samples;
  for (const json& time : scene["sample_times"])
    samples.insert(std::lround(time.get<double>() / dt));
  std::vector<double> times;
  json result;
  const long steps = std::lround(scene["duration"].get<double>() / dt);
  for (long k = 1; k <= steps; ++k) {
    btVector3 force(0, 0, 0);
    const std::clock_t begin = std::clock();
    for (int i = 1; i <= substeps; ++i) {
      force += run.step((k - 1) * dt + i * run.dt()) / substeps;
    }
    times.push_back(1e6 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    result["force"].push_back(list(force));
    if (samples.count(k) > 0) result["positions"].push_back(run.watched());
  }
  std::sort(times.begin(), times.end());
  const auto share = [&](double p) {
    return times[static_cast<std::size_t>(p * (times.size() - 1))];
  };
  const int version = btGetVersion();
  result["version"] = std::to_string(version / 100) + "." + std::to_string(version % 100);
  result["dt"] = dt;
  result["step_us"] = {share(0.5), share(0.99)};
  result["settings"] =
      std::to_string(substeps) + " steps of " + std::to_string(std::lround(1e6 * run.dt())) +
      " us (elastic forces are explicit: stable ones), btDeformableLinearElasticityForce, contact "
      "as in Bullet's examples (erp 0.3, 100 iterations), "
      "margin 0.5 mm; double precision; force: change of momentum of " +
      (scene["tools"].empty() ? "the body" : "the ball, of 1 kg") + " in a step";
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: bullet SCENE.json RESULT.json\n", stderr);
    return 2;
  }
  const json scene = json::parse(std::ifstream(argv[1]));
  for (const json& body : scene["bodies"]) {
    if (!body.contains("regions")) continue;
    std::fputs("a btDeformableLinearElasticityForce has one material\n", stderr);
    return 1;
  }
  if (scene["tools"].size() > 1) {
    std::fputs("one tool is led, not more\n", stderr);
    return 1;
  }
  std::ofstream(argv[2]) << result_of(scene, explicit_steps(scene));
}
