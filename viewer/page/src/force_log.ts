import type { Frame } from "./protocol";

const KEPT_SECONDS = 60;
const MOST_ROWS = 120_000;

/** Forces of the last minute, step by step, on every stylus. Pure. */
export class ForceLog {
  /** [s] */
  readonly times: number[] = [];
  readonly steps: number[] = [];
  /** for each stylus x, y, z, magnitude [N]; null: the step was not seen */
  readonly columns: (number | null)[][][];
  private newest = -1;

  constructor(
    styluses: number,
    private readonly dt: number,
  ) {
    this.columns = Array.from({ length: styluses }, () => [[], [], [], []]);
  }

  /** Takes the steps of a frame that are new. */
  follow(frame: Frame): void {
    if (frame.step < this.newest) this.clear(); // the server has begun anew, or a recorded run went back
    const styluses = this.columns.length;
    for (let i = 0; i < frame.trail; ++i) {
      const step = frame.step - (frame.trail - 1 - i);
      if (step <= this.newest) continue;
      if (this.newest >= 0 && step > this.newest + 1) this.push(step - 1, null);
      const at = 3 * i * styluses;
      this.push(step, frame.forces.subarray(at, at + 3 * styluses));
      this.newest = step;
    }
    this.forget();
  }

  clear(): void {
    for (const list of [this.times, this.steps, ...this.columns.flat()]) list.length = 0;
    this.newest = -1;
  }

  private push(step: number, forces: Float32Array | null): void {
    this.steps.push(step);
    this.times.push((step + 1) * this.dt);
    this.columns.forEach((column, s) => {
      const parts = forces === null ? null : [forces[3 * s]!, forces[3 * s + 1]!, forces[3 * s + 2]!];
      for (let c = 0; c < 3; ++c) column[c]!.push(parts === null ? null : parts[c]!);
      column[3]!.push(parts === null ? null : Math.hypot(...parts));
    });
  }

  private forget(): void {
    const oldest = this.times[this.times.length - 1]! - KEPT_SECONDS;
    let old = Math.max(0, this.times.length - MOST_ROWS);
    while (old < this.times.length && this.times[old]! < oldest) ++old;
    // In large pieces: cutting an array moves all of it.
    if (old < this.times.length / 4) return;
    for (const list of [this.times, this.steps, ...this.columns.flat()]) list.splice(0, old);
  }

  /** What one stylus felt since a time, as uPlot wants it. */
  since(time: number, stylus: number): [number[], ...(number | null)[][]] {
    let low = 0;
    let high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle]! < time) low = middle + 1;
      else high = middle;
    }
    return [this.times.slice(low), ...this.columns[stylus]!.map((column) => column.slice(low))];
  }

  csv(): string {
    const names = this.columns.flatMap((_, s) => ["x", "y", "z"].map((axis) => `stylus${s}_${axis}_N`));
    const rows = this.times.flatMap((time, i) => {
      const values = this.columns.flatMap((column) => [column[0]![i], column[1]![i], column[2]![i]]);
      if (values.some((value) => value === null)) return [];
      return [[this.steps[i], time.toFixed(6), ...values.map((value) => value!.toPrecision(6))].join(",")];
    });
    return ["step,time_s," + names.join(","), ...rows, ""].join("\n");
  }
}
