// A scene of the benchmark for an engine in JavaScript, and its result: adapter [--substeps N] SCENE.json RESULT.json
import { readFileSync, writeFileSync } from 'node:fs';

const percentile = (samples, share) =>
  [...samples].sort((a, b) => a - b)[Math.floor(share * (samples.length - 1))];

/** The scene, where its result goes, and the engine's steps in one of the scene. */
export function readArguments() {
  const rest = process.argv.slice(2);
  const substeps = rest[0] === '--substeps' ? Number(rest.splice(0, 2)[1]) : 1;
  return { scene: JSON.parse(readFileSync(rest[0], 'utf8')), output: rest[1], substeps };
}

/** Steps in one of the scene that are stable where elastic and damping forces are explicit. */
export const explicitSteps = (scene) => Math.max(...scene.bodies.map((body) => {
  const w = body.highest_frequency;
  const damping = body.material.rayleigh_beta * w / 2;  // as a ratio
  return Math.ceil(scene.dt * w / (2 * (Math.sqrt(1 + damping ** 2) - damping)));
}));

/** Centre of a tool [m]. */
export function toolAt(tool, time) {
  const { path } = tool;
  const next = path.findIndex(([t]) => t >= time);
  if (next === 0) return path[0].slice(1);
  if (next < 0) return path.at(-1).slice(1);
  const [a, b] = [path[next - 1], path[next]];
  const share = (time - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map((axis) => a[axis] + share * (b[axis] - a[axis]));
}

/** Whether a node of a body is held. */
export const fixed = (body, i) => 'fixed_below' in body && body.nodes[i][1] <= body.fixed_below + 1e-9;

/** What an engine did. */
export class Result {
  constructor({ scene, output, substeps }) {
    Object.assign(this, { scene, output, substeps });
    this.dt = scene.dt / substeps;
    this.force = [];
    this.times = [];
    this.positions = [];
  }
  /**
   * Runs the scene.
   * @param step takes the time at the step's end, returns the force on what the reference looks at [N]
   * @param at where node i of the first body is [m]
   */
  run(step, at) {
    const { scene } = this;
    const samples = new Set(scene.sample_times.map((time) => Math.round(time / scene.dt)));
    const steps = Math.round(scene.duration / scene.dt);
    for (let k = 1; k <= steps; ++k) {
      const sum = [0, 0, 0];
      const begin = process.cpuUsage();
      for (let i = 1; i <= this.substeps; ++i) {
        step((k - 1) * scene.dt + i * this.dt).forEach((f, axis) => { sum[axis] += f / this.substeps; });
      }
      const { user, system } = process.cpuUsage(begin);
      this.times.push(user + system);
      this.force.push(sum);
      if (samples.has(k)) this.positions.push(scene.watched.map((i) => at(i)));
    }
  }
  /** @param settings what was set, and why */
  write(version, settings) {
    writeFileSync(this.output, JSON.stringify({ version, settings, dt: this.scene.dt, force: this.force,
      step_us: [0.5, 0.99].map((share) => percentile(this.times, share)), positions: this.positions }));
  }
}
