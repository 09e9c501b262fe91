// A scene by the soft bodies of Jolt in WebAssembly: node jolt.mjs [--substeps N] SCENE.json RESULT.json
// They are particles held together by constraints, and do not touch each other.
import load from 'jolt-physics';
import { Result, fixed, readArguments, toolAt } from './scene.mjs';

const kIterations = 5;     // of the solver a step: the default
const kToolMass = 1;       // [kg]
const kMoving = 1;         // layer

const Jolt = await load();
const vec = (x) => new Jolt.Vec3(...x);
const place = (x) => new Jolt.RVec3(...x);
const upright = new Jolt.Quat(0, 0, 0, 1);

class World {
  constructor(scene, dt) {
    Object.assign(this, { scene, dt });
    const settings = new Jolt.JoltSettings();
    const pairs = new Jolt.ObjectLayerPairFilterTable(2);
    pairs.EnableCollision(0, kMoving);
    pairs.EnableCollision(kMoving, kMoving);
    const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 1);
    for (const layer of [0, kMoving]) layers.MapObjectToBroadPhaseLayer(layer, new Jolt.BroadPhaseLayer(0));
    settings.mObjectLayerPairFilter = pairs;
    settings.mBroadPhaseLayerInterface = layers;
    settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 2);
    settings.mMaxWorkerThreads = 0;
    this.jolt = new Jolt.JoltInterface(settings);
    this.bodies = this.jolt.GetPhysicsSystem().GetBodyInterface();
    this.jolt.GetPhysicsSystem().SetGravity(vec(scene.gravity));
    this.soft = this.add(scene.bodies[0]);
    if (scene.tools.length === 0) return;
    this.balls = scene.tools.map((tool) => this.tool(tool));
  }
  tool(tool) {
    const { radius, friction } = tool;
    const settings = new Jolt.BodyCreationSettings(new Jolt.SphereShape(radius), place(toolAt(tool, 0)), upright,
      Jolt.EMotionType_Dynamic, kMoving);
    settings.mFriction = friction;
    settings.mAllowSleeping = false;
    settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
    settings.mMassPropertiesOverride.mMass = kToolMass;
    settings.mGravityFactor = settings.mLinearDamping = settings.mAngularDamping = 0;
    const body = this.bodies.CreateBody(settings);
    this.bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    return { tool, body, centre: toolAt(tool, 0) };
  }
  add(body) {
    const settings = new Jolt.SoftBodyCreationSettings(material(body), place([0, 0, 0]), upright, kMoving);
    settings.mNumIterations = kIterations;
    settings.mFriction = this.scene.tools[0]?.friction ?? 0;  // of a pair it is the geometric mean
    settings.mLinearDamping = 0;
    settings.mAllowSleeping = false;
    const soft = this.bodies.CreateSoftBody(settings);
    this.bodies.AddBody(soft.GetID(), Jolt.EActivation_Activate);
    return soft;
  }
  at(i) {
    const vertices = Jolt.castObject(this.soft.GetMotionProperties(), Jolt.SoftBodyMotionProperties).GetVertices();
    const x = vertices.at(i).mPosition, c = this.soft.GetCenterOfMassPosition();
    return [c.GetX() + x.GetX(), c.GetY() + x.GetY(), c.GetZ() + x.GetZ()];
  }
  /** The force is the momentum that the first ball gets in a step; then they are led on. */
  step(time) {
    if (!this.balls) {
      this.jolt.Step(this.dt, 1);
      return [0, 0, 0];
    }
    const speeds = this.balls.map(({ tool, body, centre }) => {
      const speed = toolAt(tool, time).map((x, axis) => (x - centre[axis]) / this.dt);
      this.bodies.SetPositionRotationAndVelocity(body.GetID(), place(centre), upright, vec(speed), vec([0, 0, 0]));
      return speed;
    });
    this.jolt.Step(this.dt, 1);
    for (const ball of this.balls) ball.centre = toolAt(ball.tool, time);
    const v = this.balls[0].body.GetLinearVelocity();
    return [v.GetX(), v.GetY(), v.GetZ()].map((x, axis) => kToolMass * (x - speeds[0][axis]) / this.dt);
  }
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const volume = (a, b, c, d) => {
  const [u, v, w] = [minus(b, a), minus(c, a), minus(d, a)];
  return Math.abs(u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
    u[2] * (v[0] * w[1] - v[1] * w[0])) / 6;
};

// Springs k on the edges of a tetrahedron of volume V make it a solid of lambda = mu = k sum(length^2) / (15 V), if
// edges have all directions alike; energy of the change of volume is what lambda has more.
function material(body) {
  const { poisson_ratio: poisson } = body.material;
  const mu = body.youngs_modulus.map((young) => young / (2 * (1 + poisson)));
  const lambda = mu.map((shear) => 2 * shear * poisson / (1 - 2 * poisson));
  const x = body.nodes;
  const edges = new Map();
  for (const [index, tet] of body.tets.entries()) {
    const pairs = tet.flatMap((i, a) => tet.slice(0, a).map((j) => [Math.min(i, j), Math.max(i, j)]));
    const squares = pairs.reduce((sum, [i, j]) => sum + Math.hypot(...minus(x[i], x[j])) ** 2, 0);
    const stiffness = 15 * volume(...tet.map((i) => x[i])) * mu[index] / squares;
    for (const pair of pairs) edges.set(pair.join(), [...pair, stiffness + (edges.get(pair.join())?.[2] ?? 0)]);
  }
  const shared = new Jolt.SoftBodySharedSettings();
  x.forEach((at, i) => {
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    vertex.mPosition = new Jolt.Float3(...at);
    vertex.mVelocity = new Jolt.Float3(...(body.velocity ?? [0, 0, 0]));
    vertex.mInvMass = fixed(body, i) ? 0 : 1 / body.node_mass[i];
    shared.mVertices.push_back(vertex);
  });
  for (const [a, b, c] of body.triangles) shared.AddFace(new Jolt.SoftBodySharedSettingsFace(a, b, c, 0));
  for (const [i, j, stiffness] of edges.values()) {
    shared.mEdgeConstraints.push_back(new Jolt.SoftBodySharedSettingsEdge(i, j, 1 / stiffness));
  }
  for (const [index, tet] of body.tets.entries()) {
    const compliance = 36 * volume(...tet.map((i) => x[i])) / (lambda[index] - mu[index]);
    shared.mVolumeConstraints.push_back(new Jolt.SoftBodySharedSettingsVolume(...tet, compliance));
  }
  shared.CalculateEdgeLengths();
  shared.CalculateVolumeConstraintVolumes();
  shared.Optimize();
  return shared;
}

const given = readArguments();
if (given.scene.bodies.length > 1) throw new Error("Jolt's soft bodies do not touch each other");
const result = new Result(given);
const world = new World(given.scene, result.dt);
result.run((time) => world.step(time), (i) => world.at(i));
result.write('1.1.0', `${given.substeps} steps of ${1e6 * result.dt} us, ${kIterations} iterations (the default), ` +
  'springs on edges and volumes of tetrahedra with compliances by the moduli, ' +
  'no damping (there is none by stiffness); ' +
  'WebAssembly, single precision; force: momentum that the ball, of 1 kg, gets in a step');
