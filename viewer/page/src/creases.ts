// Smooth normals with edges that stay edges. Pure.

export interface CreasedMesh {
  /** for each vertex that is drawn: the node that it is */
  nodeOf: Uint32Array;
  /** three vertices a triangle */
  index: Uint32Array;
  /** for each vertex: the first one of its bundle, which has the same normal */
  firstOf: Uint32Array;
}

type Triple = [number, number, number];

function normalOf(points: ArrayLike<number>, triangles: Uint32Array, t: number): Triple {
  const [a, b, c] = [3 * triangles[3 * t]!, 3 * triangles[3 * t + 1]!, 3 * triangles[3 * t + 2]!];
  const u: Triple = [points[b]! - points[a]!, points[b + 1]! - points[a + 1]!, points[b + 2]! - points[a + 2]!];
  const v: Triple = [points[c]! - points[a]!, points[c + 1]! - points[a + 1]!, points[c + 2]! - points[a + 2]!];
  return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
}

/**
 * Gives a node one vertex for each bundle of its triangles that are smooth among themselves: those that can be
 * reached from each other by way of triangles whose normals at rest differ by less than the crease angle. Triangles
 * of different kinds share no vertex, so that each kind can have a colour of its own.
 * @param kinds a number for each triangle; null: all are of one kind
 */
export function creaseMesh(
  rest: ArrayLike<number>,
  triangles: Uint32Array,
  creaseDegrees = 35,
  kinds: ArrayLike<number> | null = null,
): CreasedMesh {
  const count = triangles.length / 3;
  const normals = Array.from({ length: count }, (_, t) => {
    const n = normalOf(rest, triangles, t);
    const length = Math.hypot(...n) || 1;
    return n.map((part) => part / length) as Triple;
  });
  const around = new Map<number, number[]>();
  triangles.forEach((node, corner) => {
    const list = around.get(node) ?? [];
    list.push(corner);
    around.set(node, list);
  });
  const least = Math.cos((creaseDegrees * Math.PI) / 180);
  const nodeOf: number[] = [];
  const firstOf: number[] = [];
  const index = new Uint32Array(triangles.length);
  for (const [node, corners] of around) {
    let left = corners;
    while (left.length > 0) {
      const bundle = [left[0]!];
      left = left.slice(1);
      for (let i = 0; i < bundle.length; ++i) {
        const mine = normals[Math.floor(bundle[i]! / 3)]!;
        const smooth = (corner: number): boolean => {
          const other = normals[Math.floor(corner / 3)]!;
          return mine[0] * other[0] + mine[1] * other[1] + mine[2] * other[2] >= least;
        };
        bundle.push(...left.filter(smooth));
        left = left.filter((corner) => !smooth(corner));
      }
      const first = nodeOf.length;
      for (const corners of byKind(bundle, kinds)) {
        for (const corner of corners) index[corner] = nodeOf.length;
        nodeOf.push(node);
        firstOf.push(first);
      }
    }
  }
  return { nodeOf: Uint32Array.from(nodeOf), index, firstOf: Uint32Array.from(firstOf) };
}

function byKind(corners: number[], kinds: ArrayLike<number> | null): number[][] {
  if (kinds === null) return [corners];
  const groups = new Map<number, number[]>();
  for (const corner of corners) {
    const kind = kinds[Math.floor(corner / 3)]!;
    groups.set(kind, [...(groups.get(kind) ?? []), corner]);
  }
  return [...groups.values()];
}

/** Normals of the vertices, weighted by area, the same in a bundle; `normals` has three numbers a vertex. */
export function vertexNormals(positions: Float32Array, { index, firstOf }: CreasedMesh, normals: Float32Array): void {
  normals.fill(0);
  for (let t = 0; t < index.length / 3; ++t) {
    const n = normalOf(positions, index, t);
    for (let i = 0; i < 3; ++i) {
      const at = 3 * firstOf[index[3 * t + i]!]!;
      for (let c = 0; c < 3; ++c) normals[at + c] = normals[at + c]! + n[c]!;
    }
  }
  for (let at = 0; at < normals.length; at += 3) {
    const length = Math.hypot(normals[at]!, normals[at + 1]!, normals[at + 2]!) || 1;
    for (let c = 0; c < 3; ++c) normals[at + c] = normals[at + c]! / length;
  }
  firstOf.forEach((first, v) => {
    if (first !== v) normals.copyWithin(3 * v, 3 * first, 3 * first + 3);
  });
}
