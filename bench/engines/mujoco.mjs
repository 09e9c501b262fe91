// Both scenes with the soft bodies (flex) of MuJoCo, in WebAssembly: node mujoco.mjs SCENES.json
import load from 'mujoco-js';
import { Peg, Press, readScenes } from './scene.mjs';

const kRadius = 0.0005;  // of what surfaces touch with [m]
// As stiff as the step allows: by default the cubes sink into each other and fall through.
const kContact = 'solref="0.002 1" solimp="0.95 0.99 0.0001"';

const mujoco = await load();
mujoco.FS.mkdir('/scenes');

function flex(name, body, position, contact) {
  const list = (rows) => rows.flat().join(' ');
  return `<flexcomp name="${name}" type="direct" dim="3" radius="${kRadius}" pos="${position.join(' ')}"
      mass="${body.mass.reduce((a, b) => a + b)}" point="${list(body.nodes)}" element="${list(body.tets)}">
    <contact selfcollide="none" internal="false" ${kContact} ${contact}/>
    <elasticity young="${body.young}" poisson="${body.poisson}" damping="${body.beta}"/>
  </flexcomp>`;
}

class World {
  constructor(xml, scene, count) {
    const file = '/scenes/scene.xml';
    mujoco.FS.writeFile(file, `<mujoco><size memory="400M"/>
      <option timestep="${scene.dt}" gravity="0 0 0" cone="elliptic" solver="Newton" jacobian="sparse"/>
      <worldbody>${xml}</worldbody></mujoco>`);
    this.model = mujoco.MjModel.loadFromXML(file);
    this.data = new mujoco.MjData(this.model);
    const { mass, alpha } = scene.body;
    this.mass = Array(count).fill(mass).flat();
    this.mass.forEach((m, i) => {
      for (let axis = 0; axis < 3; ++axis) this.model.dof_damping[3 * i + axis] = (alpha + scene.damping) * m;
    });
  }
  /** @param acceleration of node i along y [m/s^2] */
  load(acceleration) {
    const force = this.data.qfrc_applied;
    this.mass.forEach((m, i) => { force[3 * i + 1] = m * acceleration(i); });
  }
  step() { mujoco.mj_step(this.model, this.data); }
  /** @param first node of the body */
  at(first) {
    const x = this.data.flexvert_xpos;
    return (i) => [0, 1, 2].map((axis) => x[3 * (first + i) + axis]);
  }
  /** Of all contacts on a geom, along x [N]. */
  force(geom) {
    const force = new mujoco.DoubleBuffer(6);
    const contacts = this.data.contact;  // a copy
    let sum = 0;
    for (let i = 0; i < this.data.ncon; ++i) {
      const contact = contacts.get(i);
      const side = [...contact.geom].indexOf(geom);
      if (side >= 0) {
        mujoco.mj_contactForce(this.model, this.data, i, force);
        const f = force.GetView();
        const along = [0, 1, 2].reduce((all, axis) => all + contact.frame[3 * axis] * f[axis], 0);
        sum += side === 1 ? along : -along;
      }
      contact.delete();
    }
    contacts.delete();
    force.delete();
    return sum;
  }
}

function press(scene) {
  const { body } = scene;
  const place = Math.max(...body.nodes.map((x) => x[1])) + kRadius;
  const contact = 'condim="1"';
  const world = new World(flex('lower', body, [0, -place, 0], contact) +
    flex('upper', body, [0, place, 0], contact), scene, 2);
  const measure = new Press(scene);
  const count = body.nodes.length;
  for (let k = 0; k < measure.steps(); ++k) {
    const g = scene.gravity * measure.load(k);
    world.load((i) => (i < count ? g : -g));
    measure.time(k, () => world.step());
  }
  return measure.row('MuJoCo', world.at(0), world.at(count), 2 * kRadius);
}

function peg(scene) {
  const { body, friction } = scene;
  const rough = (value) => `friction="${value} 0 0" condim="3" ${kContact}`;
  const upright = 'euler="90 0 0"';  // a capsule lies along z
  const posts = scene.posts.map((post) => `<geom type="capsule" size="${post.radius} ${post.length / 2}"
    pos="${post.position.join(' ')}" ${upright} ${rough(friction.posts)} priority="1"/>`).join('');
  const world = new World(`<geom type="plane" size="1 1 1" euler="-90 0 0" ${rough(friction.table)} priority="1"/>${posts}
    <body mocap="true" name="pusher"><geom name="pusher" type="sphere" size="${scene.radius}"
      ${rough(friction.pusher)} priority="1"/></body>` +
    flex('cube', body, scene.position.map((x, axis) => x + (axis === 1 ? kRadius : 0)), 'condim="3"'),
    scene, 1);
  const measure = new Peg(scene);
  const geom = 3;
  world.load(() => -scene.gravity);
  for (let k = 0; k < measure.steps(); ++k) {
    measure.pusher(k).forEach((x, axis) => { world.data.mocap_pos[axis] = x; });
    measure.time(() => world.step());
    measure.follow(k, world.at(0), world.force(geom), kRadius);
  }
  return measure.row('MuJoCo');
}

const scenes = readScenes(process.argv[2]);
for (const [name, run] of Object.entries({ press, peg })) console.log(`${name} ${run(scenes[name])}`);
