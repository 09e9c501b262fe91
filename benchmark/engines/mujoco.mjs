// A scene by the soft bodies (flex) of MuJoCo in WebAssembly: node mujoco.mjs SCENE.json RESULT.json
import load from 'mujoco-js';
import { Result, explicitSteps, fixed, readArguments, toolAt } from './scene.mjs';

const kRadius = 0.0001;  // of what surfaces touch with [m]

const mujoco = await load();
mujoco.FS.mkdir('/scenes');

class World {
  constructor(scene, dt) {
    this.scene = scene;
    // As stiff as MuJoCo allows: it raises a time constant below two steps.
    const contact = `solref="${2 * dt} 1" solimp="0.95 0.99 0.0001"`;
    const rough = (friction) => `condim="${friction > 0 ? 3 : 1}" friction="${friction} 0 0" ${contact}`;
    const flexes = scene.bodies.map((body, index) => this.flex(index, body, rough(scene.friction))).join('');
    const tools = scene.tools.map((tool, index) => `<body mocap="true" pos="${toolAt(tool, 0).join(' ')}">
      <geom name="tool${index}" type="sphere" size="${tool.radius - kRadius}"
        ${rough(tool.friction)} priority="1"/></body>`);
    mujoco.FS.writeFile('/scenes/scene.xml', `<mujoco><size memory="1G"/>
      <option timestep="${dt}" gravity="${scene.gravity.join(' ')}" cone="elliptic" solver="Newton" jacobian="sparse"/>
      <worldbody>${tools.join('')}${flexes}</worldbody></mujoco>`);
    this.model = mujoco.MjModel.loadFromXML('/scenes/scene.xml');
    this.data = new mujoco.MjData(this.model);
    this.first = [];
    let node = 0;
    for (const body of scene.bodies) {
      this.first.push(node);
      body.nodes.forEach((_, i) => this.start(body, i, node + i));
      node += body.nodes.length;
    }
    mujoco.mj_setConst(this.model, this.data);
    scene.bodies.forEach((body, index) => body.nodes.forEach((_, i) => this.push(body, i, this.first[index] + i)));
    mujoco.mj_forward(this.model, this.data);
  }
  flex(index, body, contact) {
    const list = (rows) => rows.flat().join(' ');
    const held = body.nodes.map((_, i) => i).filter((i) => fixed(body, i));
    const { youngs_modulus: young, poisson_ratio: poisson, rayleigh_beta: beta } = body.material;
    return `<flexcomp name="body${index}" type="direct" dim="3" radius="${kRadius}"
        mass="${body.node_mass.reduce((a, b) => a + b)}" point="${list(body.nodes)}" element="${list(body.tets)}">
      <contact selfcollide="none" internal="false" ${contact}/>
      ${held.length ? `<pin id="${held.join(' ')}"/>` : ''}
      <elasticity young="${young}" poisson="${poisson}" damping="${beta}"/>
    </flexcomp>`;
  }
  // The mass of a node; flexcomp gives all the same.
  start(body, i, node) {
    if (!fixed(body, i)) this.model.body_mass[this.model.flex_vertbodyid[node]] = body.node_mass[i];
  }
  push(body, i, node) {
    if (fixed(body, i) || !body.velocity) return;
    const dof = this.model.body_dofadr[this.model.flex_vertbodyid[node]];
    body.velocity.forEach((v, axis) => { this.data.qvel[dof + axis] = v; });
  }
  at(index, i) {
    const x = this.data.flexvert_xpos;
    return [0, 1, 2].map((axis) => x[3 * (this.first[index] + i) + axis]);
  }
  momentum(index) {
    const body = this.scene.bodies[index];
    return [0, 1, 2].map((axis) => body.node_mass.reduce((sum, m, i) => sum +
      m * this.data.qvel[this.model.body_dofadr[this.model.flex_vertbodyid[this.first[index] + i]] + axis], 0));
  }
  /** Of all contacts on tool 0 [N], W. */
  toolForce() {
    const force = new mujoco.DoubleBuffer(6);
    const contacts = this.data.contact;  // a copy
    const sum = [0, 0, 0];
    for (let i = 0; i < this.data.ncon; ++i) {
      const contact = contacts.get(i);
      const side = [...contact.geom].indexOf(0);
      if (side >= 0) {
        mujoco.mj_contactForce(this.model, this.data, i, force);
        const f = force.GetView();
        for (const axis of [0, 1, 2]) {  // from the first of the two on the second
          const along = [0, 1, 2].reduce((all, row) => all + contact.frame[3 * row + axis] * f[row], 0);
          sum[axis] += side === 1 ? along : -along;
        }
      }
      contact.delete();
    }
    contacts.delete();
    force.delete();
    return sum;
  }
  step(time) {
    if (this.scene.tools.length === 0) {
      if (this.scene.bodies.length < 2) {
        mujoco.mj_step(this.model, this.data);
        return [0, 0, 0];
      }
      const before = this.momentum(1);
      mujoco.mj_step(this.model, this.data);
      const { mass } = this.scene.bodies[1];
      return this.momentum(1).map((p, axis) =>
        (p - before[axis]) / this.model.opt.timestep - mass * this.scene.gravity[axis]);
    }
    this.scene.tools.forEach((tool, index) => toolAt(tool, time).forEach((x, axis) => {
      this.data.mocap_pos[3 * index + axis] = x;
    }));
    mujoco.mj_step(this.model, this.data);
    return this.toolForce();
  }
}

const given = readArguments();
given.substeps = explicitSteps(given.scene);
if (given.scene.bodies.some((body) => body.regions)) throw new Error('a flex has one material');
const result = new Result(given);
const world = new World(given.scene, result.dt);
result.run((time) => world.step(time), (i) => world.at(0, i));
result.write(mujoco.mj_versionString(), `flex, ${given.substeps} steps of ${(1e6 * result.dt).toFixed(1)} us ` +
  '(forces are explicit: stable ones), contact time constant two steps, solimp 0.95 0.99 0.0001, ' +
  'elliptic cone, Newton; WebAssembly; ' +
  `force: ${given.scene.tools.length ? 'contact forces on the tool' : 'change of momentum'}`);
