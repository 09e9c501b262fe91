// What is held at a point is drawn as a patch that moves as one, not as a spike of a single node. Pure.

export interface Patch {
  /** on the surface at rest [m], B */
  middle: readonly [number, number, number];
  /** within which all has the displacement of the patch; twice as far out it is that of the surface [m] */
  radius: number;
}

/** Mean length of the triangles' edges at rest [m]. */
export function meanEdge(rest: Float32Array, triangles: Uint32Array): number {
  let sum = 0;
  for (let corner = 0; corner < triangles.length; ++corner) {
    const from = 3 * triangles[corner]!;
    const to = 3 * triangles[corner % 3 === 2 ? corner - 2 : corner + 1]!;
    sum += Math.hypot(rest[to]! - rest[from]!, rest[to + 1]! - rest[from + 1]!, rest[to + 2]! - rest[from + 2]!);
  }
  return sum / triangles.length;
}

/** Displacements of all nodes with those of each patch replaced by the patch's mean, smoothly to its surroundings. */
export function withPatches(rest: Float32Array, displacement: Float32Array, patches: readonly Patch[], into: Float32Array): void {
  into.set(displacement);
  for (const { middle, radius } of patches) {
    const away = Float32Array.from({ length: rest.length / 3 }, (_, i) =>
      Math.hypot(rest[3 * i]! - middle[0], rest[3 * i + 1]! - middle[1], rest[3 * i + 2]! - middle[2]),
    );
    const mean = meanWithin(away, radius, displacement);
    if (mean === null) continue;
    away.forEach((distance, i) => {
      const out = Math.min(Math.max(distance / radius - 1, 0), 1);
      const share = 1 - out * out * (3 - 2 * out);
      if (share === 0) return;
      for (let c = 0; c < 3; ++c) into[3 * i + c] = into[3 * i + c]! + share * (mean[c]! - into[3 * i + c]!);
    });
  }
}

function meanWithin(away: Float32Array, radius: number, vectors: Float32Array): number[] | null {
  const sum = [0, 0, 0];
  let count = 0;
  away.forEach((distance, i) => {
    if (distance > radius) return;
    ++count;
    for (let c = 0; c < 3; ++c) sum[c] = sum[c]! + vectors[3 * i + c]!;
  });
  return count === 0 ? null : sum.map((part) => part / count);
}
