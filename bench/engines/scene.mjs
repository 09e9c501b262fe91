// The two scenes as bench_engines wrote them, and what is measured in every engine alike.
import { readFileSync } from 'node:fs';

/** Scenes of a file of `bench_engines --scenes`. */
export const readScenes = (file) => JSON.parse(readFileSync(file, 'utf8'));

const percentile = (samples, share) =>
  [...samples].sort((a, b) => a - b)[Math.floor(share * (samples.length - 1))];

/** Microseconds of processor time that `work` takes. */
export function microseconds(work) {
  const begin = process.cpuUsage();
  work();
  const { user, system } = process.cpuUsage(begin);
  return user + system;
}

/** Mean height of a body's nodes, weighted with their masses. @param at node to [x, y, z] */
function height(body, at) {
  let moment = 0, mass = 0;
  body.mass.forEach((m, i) => { moment += m * at(i)[1]; mass += m; });
  return moment / mass;
}

// Nodes of the lower cube's top and of the upper cube's bottom that lie on each other.
function facing(body) {
  const top = Math.max(...body.surface.map((i) => body.nodes[i][1]));
  const key = (i) => [0, 2].map((axis) => Math.round(1e6 * body.nodes[i][axis])).join();
  const on = (y) => body.surface.filter((i) => Math.abs(body.nodes[i][1] - y) < 1e-6);
  const above = new Map(on(-top).map((i) => [key(i), i]));
  return on(top).map((i) => [i, above.get(key(i))]);
}

/** Two cubes pressed together, as they are measured. */
export class Press {
  constructor(scene) {
    this.scene = scene;
    this.pairs = facing(scene.body);
    this.times = [];
  }
  steps() { return Math.round(this.scene.seconds / this.scene.dt); }
  /** Share of the load in step k. */
  load(k) { return Math.min(1, (k * this.scene.dt) / this.scene.ramp); }
  time(k, work) {
    const taken = microseconds(work);
    if (2 * k > this.steps()) this.times.push(taken);
  }
  /** @param thickness between surfaces that touch [m] */
  row(engine, lower, upper, thickness = 0) {
    const { body, fem } = this.scene;
    const half = Math.max(...body.nodes.map((x) => x[1]));
    const apart = 2 * half + thickness;
    const approach = apart - (height(body, upper) - height(body, lower));
    const depth = Math.max(...this.pairs.map(([i, j]) => lower(i)[1] - upper(j)[1] + thickness));
    return row(engine, this.scene.dt, this.times,
      `${(1e3 * approach).toFixed(2)} mm`, `${(100 * (fem.approach / approach - 1)).toFixed(1)} %`, depth);
  }
}

/** A cube pushed into a gap, as it is measured. */
export class Peg {
  constructor(scene) {
    this.scene = scene;
    this.times = [];
    this.peak = 0;
    this.depth = 0;
  }
  steps() { return Math.round(this.scene.seconds / this.scene.dt); }
  /** Where the middle of the pusher is at the end of step k. */
  pusher(k) {
    const { from, to, speed, dt } = this.scene;
    return [Math.max(to, from - speed * (k + 1) * dt), this.scene.position[1], 0];
  }
  time(work) { this.times.push(microseconds(work)); }
  /** After step k. @param force on the pusher along x [N]  @param thickness of the surfaces [m] */
  follow(k, at, force, thickness = 0) {
    const { scene } = this;
    this.peak = Math.max(this.peak, force);
    this.last = force;
    const pusher = this.pusher(k);
    for (const i of scene.body.surface) {
      const x = at(i);
      const off = [x[1], Math.hypot(x[0] - pusher[0], x[1] - pusher[1], x[2] - pusher[2]) - scene.radius,
        ...scene.posts.map((post) => Math.hypot(x[0] - post.position[0], x[2] - post.position[2]) - post.radius)];
      this.depth = Math.max(this.depth, thickness - Math.min(...off));
    }
  }
  row(engine) {
    return row(engine, this.scene.dt, this.times,
      `${this.peak.toFixed(2)} N`, `${this.last.toFixed(2)} N`, this.depth);
  }
}

function row(engine, dt, times, first, second, depth) {
  const [median, late] = [0.5, 0.99].map((share) => percentile(times, share).toFixed(0));
  const inside = (1e3 * Math.max(0, depth)).toFixed(3);
  return `| ${engine} | ${1e3 * dt} | ${median}, ${late} | ${first} | ${second} | ${inside} |`;
}
