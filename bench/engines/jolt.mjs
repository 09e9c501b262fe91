// Both scenes with the soft bodies of Jolt, in WebAssembly: node jolt.mjs SCENES.json
// They are particles held together by constraints, without a modulus, and do not touch each other:
// the cubes that are pressed together have a rigid plate between them.
import load from 'jolt-physics';
import { Peg, Press, readScenes } from './scene.mjs';

const kIterations = 5;   // of the solver a step: the default
const kPlate = 0.02;     // [m]
const kMoving = 1;       // layer

const Jolt = await load();
const vec = (x) => new Jolt.Vec3(...x);
const place = (x) => new Jolt.RVec3(...x);
const upright = new Jolt.Quat(0, 0, 0, 1);

class World {
  constructor(gravity) {
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
    this.system = this.jolt.GetPhysicsSystem();
    this.bodies = this.system.GetBodyInterface();
    this.system.SetGravity(vec([0, -gravity, 0]));
  }
  step(dt) { this.jolt.Step(dt, 1); }
  rigid(shape, position, friction, type = Jolt.EMotionType_Static, mass = 0) {
    const settings = new Jolt.BodyCreationSettings(shape, place(position), upright, type,
      type === Jolt.EMotionType_Static ? 0 : kMoving);
    settings.mFriction = friction;
    settings.mAllowSleeping = false;
    if (mass > 0) {
      settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
      settings.mMassPropertiesOverride.mMass = mass;
      settings.mGravityFactor = 0;
      settings.mLinearDamping = settings.mAngularDamping = 0;
    }
    const body = this.bodies.CreateBody(settings);
    this.bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    return body;
  }
  soft(shared, position, friction, damping, gravity = 1) {
    const settings = new Jolt.SoftBodyCreationSettings(shared, place(position), upright, kMoving);
    settings.mNumIterations = kIterations;
    settings.mFriction = friction;
    settings.mLinearDamping = damping;
    settings.mGravityFactor = gravity;
    settings.mAllowSleeping = false;
    const body = this.bodies.CreateSoftBody(settings);
    this.bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    const vertices = Jolt.castObject(body.GetMotionProperties(), Jolt.SoftBodyMotionProperties).GetVertices();
    return { body, at: (i) => {
      const x = vertices.at(i).mPosition, c = body.GetCenterOfMassPosition();
      return [c.GetX() + x.GetX(), c.GetY() + x.GetY(), c.GetZ() + x.GetZ()];
    } };
  }
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const volume = (a, b, c, d) => {
  const [u, v, w] = [minus(b, a), minus(c, a), minus(d, a)];
  return Math.abs(u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
    u[2] * (v[0] * w[1] - v[1] * w[0])) / 6;
};

// Springs k on all edges make a body of volume V whose strain is the same everywhere a solid of
// lambda = mu = k sum(length^2) / (15 V), if edges have all directions alike; energy of the
// change of the tetrahedra's volumes is what lambda has more.
function material(body) {
  const mu = body.young / (2 * (1 + body.poisson));
  const lambda = body.young * body.poisson / ((1 + body.poisson) * (1 - 2 * body.poisson));
  const x = body.nodes;
  const edges = new Map();
  for (const tet of body.tets) {
    for (let i = 0; i < 4; ++i) for (let j = 0; j < i; ++j) {
      const edge = [tet[i], tet[j]].sort((a, b) => a - b);
      edges.set(edge.join(), edge);
    }
  }
  const all = body.tets.reduce((sum, tet) => sum + volume(...tet.map((i) => x[i])), 0);
  const squares = [...edges.values()].reduce((sum, [i, j]) => sum + Math.hypot(...minus(x[i], x[j])) ** 2, 0);
  const shared = new Jolt.SoftBodySharedSettings();
  x.forEach((at, i) => {
    const vertex = new Jolt.SoftBodySharedSettingsVertex();
    vertex.mPosition = new Jolt.Float3(...at);
    vertex.mInvMass = 1 / body.mass[i];
    shared.mVertices.push_back(vertex);
  });
  for (const [a, b, c] of body.triangles) shared.AddFace(new Jolt.SoftBodySharedSettingsFace(a, b, c, 0));
  for (const [i, j] of edges.values()) {
    shared.mEdgeConstraints.push_back(new Jolt.SoftBodySharedSettingsEdge(i, j, squares / (15 * all * mu)));
  }
  for (const tet of body.tets) {
    const compliance = 36 * volume(...tet.map((i) => x[i])) / (lambda - mu);
    shared.mVolumeConstraints.push_back(new Jolt.SoftBodySharedSettingsVolume(...tet, compliance));
  }
  shared.CalculateEdgeLengths();
  shared.CalculateVolumeConstraintVolumes();
  shared.Optimize();
  return shared;
}

function press(scene) {
  const { body } = scene;
  const half = Math.max(...body.nodes.map((x) => x[1]));
  const world = new World(0);
  world.rigid(new Jolt.BoxShape(vec([1, kPlate / 2, 1])), [0, 0, 0], scene.friction);
  const shared = material(body);
  const cube = (side) =>
    world.soft(shared, [0, side * (half + kPlate / 2), 0], scene.friction, scene.damping, side);
  const lower = cube(-1), upper = cube(1);
  const measure = new Press(scene);
  for (let k = 0; k < measure.steps(); ++k) {
    world.system.SetGravity(vec([0, -scene.gravity * measure.load(k), 0]));
    measure.time(k, () => world.step(scene.dt));
  }
  return measure.row('Jolt, a rigid plate between the cubes', lower.at, upper.at, kPlate);
}

function peg(scene) {
  const { body, friction } = scene;
  const world = new World(scene.gravity);
  world.rigid(new Jolt.BoxShape(vec([1, kPlate / 2, 1])), [0, -kPlate / 2, 0], friction.table);
  for (const post of scene.posts) {
    world.rigid(new Jolt.CapsuleShape(post.length / 2, post.radius), post.position, friction.posts);
  }
  // The force is the momentum that the pusher, of 1 kg, loses in a step; then it has it again.
  const pusher = world.rigid(new Jolt.SphereShape(scene.radius), [scene.from, scene.position[1], 0],
    friction.pusher, Jolt.EMotionType_Dynamic, 1);
  const cube = world.soft(material(body), scene.position, 1, scene.damping);
  const measure = new Peg(scene);
  for (let k = 0; k < measure.steps(); ++k) {
    const [x, y, z] = k === 0 ? [scene.from, scene.position[1], 0] : measure.pusher(k - 1);
    const speed = (measure.pusher(k)[0] - x) / scene.dt;
    world.bodies.SetPositionRotationAndVelocity(pusher.GetID(), place([x, y, z]), upright,
      vec([speed, 0, 0]), vec([0, 0, 0]));
    measure.time(() => world.step(scene.dt));
    measure.follow(k, cube.at, (pusher.GetLinearVelocity().GetX() - speed) / scene.dt);
  }
  return measure.row('Jolt');
}

const scenes = readScenes(process.argv[2]);
for (const [name, run] of Object.entries({ press, peg })) console.log(`${name} ${run(scenes[name])}`);
