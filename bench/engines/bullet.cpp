// Both scenes with the deformable bodies of Bullet: bullet SCENES.json (bench/engines/run.sh)
// The cubes are pressed together twice: face on face, which does not come to rest, and with a rigid
// plate between them.
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
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/statistics.hpp"

using irdm::bench::percentile;
using nlohmann::json;

namespace {

constexpr double kMargin = 0.001;  // of a soft body's surface [m]
constexpr double kPlate = 0.02;    // [m]

btVector3 vector(const json& x) {
  return {x[0].get<btScalar>(), x[1].get<btScalar>(), x[2].get<btScalar>()};
}

/// What is added to it lives as long as the process.
class World {
 public:
  explicit World(double gravity) : gravity_(btVector3(0, static_cast<btScalar>(-gravity), 0)) {
    solver_.setDeformableSolver(&deformable_);
    world_ = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
        &dispatcher_, &broadphase_, &solver_, &configuration_, &deformable_);
    world_->setGravity(btVector3(0, 0, 0));
    world_->setImplicit(false);
    world_->setLineSearch(false);
    world_->setUseProjection(true);
    // As in Bullet's examples of deformable bodies that touch.
    world_->getSolverInfo().m_deformable_erp = 0.3F;
    world_->getSolverInfo().m_deformable_maxErrorReduction = 200;
    world_->getSolverInfo().m_leastSquaresResidualThreshold = 1e-3F;
    world_->getSolverInfo().m_splitImpulse = false;
    world_->getSolverInfo().m_numIterations = 100;
  }

  btRigidBody* rigid(btCollisionShape* shape, const btVector3& at, double friction,
                     btScalar mass = 0) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    auto* body = new btRigidBody(mass, nullptr, shape, inertia);
    body->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    body->setFriction(static_cast<btScalar>(friction));
    body->setActivationState(DISABLE_DEACTIVATION);
    world_->addRigidBody(body);
    return body;
  }

  btSoftBody* soft(const json& body, const btVector3& at, double friction, double damping,
                   btScalar gravity = 1) {
    std::vector<btVector3> nodes;
    for (const json& node : body["nodes"]) nodes.push_back(at + vector(node));
    const auto mass = body["mass"].get<std::vector<btScalar>>();
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
    soft->m_cfg.kDF = static_cast<btScalar>(friction);
    soft->m_cfg.kKHR = 1;
    soft->m_cfg.kCHR = 1;
    soft->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN |
                             btSoftBody::fCollision::VF_DD;
    soft->m_sleepingThreshold = 0;
    soft->m_gravityFactor = gravity;
    soft->setActivationState(DISABLE_DEACTIVATION);
    world_->addSoftBody(soft);
    const double young = body["young"];
    const double poisson = body["poisson"];
    auto* elastic = new btDeformableLinearElasticityForce(
        static_cast<btScalar>(young / (2 * (1 + poisson))),
        static_cast<btScalar>(young * poisson / ((1 + poisson) * (1 - 2 * poisson))),
        static_cast<btScalar>(body["alpha"].get<double>() + damping), body["beta"]);
    world_->addForce(soft, elastic);
    world_->addForce(soft, &gravity_);
    return soft;
  }

  void set_gravity(double gravity) { gravity_.m_gravity.setY(static_cast<btScalar>(-gravity)); }
  /// Processor time that the step takes [us].
  double step(double dt) {
    return 1e6 * irdm::bench::elapsed([&] {
                   const auto step = static_cast<btScalar>(dt);
                   world_->stepSimulation(step, 0, step);
                 }).cpu;
  }

 private:
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_;
  btDeformableMultiBodyConstraintSolver solver_;
  btDeformableGravityForce gravity_;
  std::unique_ptr<btDeformableMultiBodyDynamicsWorld> world_;
};

double height(const json& body, const btSoftBody& soft) {
  double moment = 0.0;
  double mass = 0.0;
  for (int i = 0; i < soft.m_nodes.size(); ++i) {
    const double m = body["mass"][static_cast<std::size_t>(i)];
    moment += m * static_cast<double>(soft.m_nodes[i].m_x.y());
    mass += m;
  }
  return moment / mass;
}

// Nodes of the lower cube's top and of the upper one's bottom that lie on each other at rest.
double deepest(const json& body, const btSoftBody& lower, const btSoftBody& upper, double half) {
  double depth = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < lower.m_nodes.size(); ++i) {
    const btVector3 top = vector(body["nodes"][static_cast<std::size_t>(i)]);
    if (std::abs(static_cast<double>(top.y()) - half) > 1e-6) continue;
    for (int j = 0; j < upper.m_nodes.size(); ++j) {
      const btVector3 off = vector(body["nodes"][static_cast<std::size_t>(j)]) - top;
      if ((off + btVector3(0, static_cast<btScalar>(2 * half), 0)).length() > 1e-6F) continue;
      depth = std::max(depth, static_cast<double>(lower.m_nodes[i].m_x.y()) -
                                  static_cast<double>(upper.m_nodes[j].m_x.y()));
    }
  }
  return depth;
}

void press(const json& scene, bool plate) {
  const json& body = scene["body"];
  World world(0.0);
  double half = 0.0;
  for (const json& node : body["nodes"]) half = std::max(half, node[1].get<double>());
  const double apart = 2.0 * half + 2.0 * kMargin + (plate ? kPlate : 0.0);
  if (plate) {
    world.rigid(new btBoxShape(btVector3(1, kPlate / 2, 1)), btVector3(0, 0, 0), 0.0);
  }
  const auto cube = [&](double side) {
    return world.soft(body, btVector3(0, static_cast<btScalar>(side * apart / 2), 0),
                      scene["friction"], scene["damping"], static_cast<btScalar>(side));
  };
  const btSoftBody* lower = cube(-1.0);
  const btSoftBody* upper = cube(1.0);
  const double dt = scene["dt"];
  const int steps = static_cast<int>(std::lround(scene["seconds"].get<double>() / dt));
  std::vector<double> times;
  for (int k = 0; k < steps; ++k) {
    const double load = std::min(1.0, k * dt / scene["ramp"].get<double>());
    world.set_gravity(scene["gravity"].get<double>() * load);
    const double time = world.step(dt);
    if (2 * k > steps) times.push_back(time);
  }
  const double approach = apart - (height(body, *upper) - height(body, *lower));
  const double depth = deepest(body, *lower, *upper, half) + (plate ? kPlate : 0.0);
  std::printf("press | Bullet%s | %.0f | %.0f, %.0f | %.2f mm | %.1f %% | %.3f |\n",
              plate ? ", a rigid plate between the cubes" : "", 1e3 * dt, percentile(times, 0.5),
              percentile(times, 0.99), 1e3 * approach,
              100 * (scene["fem"]["approach"].get<double>() / approach - 1.0),
              1e3 * std::max(0.0, depth));
  std::fflush(stdout);
}

void peg(const json& scene) {
  const json& friction = scene["friction"];
  World world(scene["gravity"]);
  world.rigid(new btBoxShape(btVector3(1, kPlate / 2, 1)), btVector3(0, -kPlate / 2, 0),
              friction["table"]);
  for (const json& post : scene["posts"]) {
    world.rigid(new btCapsuleShape(post["radius"], post["length"]), vector(post["position"]),
                friction["posts"]);
  }
  // The force is the momentum that the pusher, of 1 kg, loses in a step; then it has it again.
  const double radius = scene["radius"];
  const btVector3 start = vector(scene["position"]);
  btVector3 at(scene["from"].get<btScalar>(), start.y(), 0);
  btRigidBody* pusher =
      world.rigid(new btSphereShape(static_cast<btScalar>(radius)), at, friction["pusher"], 1);
  const btSoftBody* cube =
      world.soft(scene["body"], start + btVector3(0, kMargin, 0), 1.0, scene["damping"]);
  const double dt = scene["dt"];
  const int steps = static_cast<int>(std::lround(scene["seconds"].get<double>() / dt));
  std::vector<double> times;
  double peak = 0.0;
  double last = 0.0;
  double depth = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double next =
        std::max(scene["to"].get<double>(),
                 scene["from"].get<double>() - scene["speed"].get<double>() * (k + 1) * dt);
    const auto speed = static_cast<btScalar>((next - static_cast<double>(at.x())) / dt);
    pusher->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    pusher->setLinearVelocity(btVector3(speed, 0, 0));
    pusher->setAngularVelocity(btVector3(0, 0, 0));
    times.push_back(world.step(dt));
    last = static_cast<double>(pusher->getLinearVelocity().x() - speed) / dt;
    peak = std::max(peak, last);
    at.setX(static_cast<btScalar>(next));
    for (const json& i : scene["body"]["surface"]) {
      const btVector3& x = cube->m_nodes[i.get<int>()].m_x;
      depth = std::max(
          {depth, static_cast<double>(-x.y()), radius - static_cast<double>((x - at).length())});
      for (const json& post : scene["posts"]) {
        const btVector3 off = x - vector(post["position"]);
        depth = std::max(depth, post["radius"].get<double>() -
                                    static_cast<double>(std::hypot(off.x(), off.z())));
      }
    }
  }
  std::printf("peg | Bullet | %.0f | %.0f, %.0f | %.2f N | %.2f N | %.3f |\n", 1e3 * dt,
              percentile(times, 0.5), percentile(times, 0.99), peak, last, 1e3 * depth);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: bullet SCENES.json (of bench_engines --scenes)\n", stderr);
    return 2;
  }
  const json scenes = json::parse(std::ifstream(argv[1]));
  press(scenes["press"], false);
  press(scenes["press"], true);
  peg(scenes["peg"]);
}
