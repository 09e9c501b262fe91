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

/** Two triangles of an edge and its nodes; at a bound of the surface there is one triangle. */
interface Edge {
  nodes: readonly [number, number];
  triangles: number[];
}

function edgesOf(triangles: Uint32Array): Edge[] {
  const edges = new Map<string, Edge>();
  for (let corner = 0; corner < triangles.length; ++corner) {
    const from = triangles[corner]!;
    const to = triangles[corner % 3 === 2 ? corner - 2 : corner + 1]!;
    const nodes = [Math.min(from, to), Math.max(from, to)] as const;
    const edge = edges.get(nodes.join()) ?? { nodes, triangles: [] };
    edge.triangles.push(Math.floor(corner / 3));
    edges.set(nodes.join(), edge);
  }
  return [...edges.values()];
}

/** Without those that lead to an end: what is left are closed lines, and lines between them. */
function closed(edges: Edge[]): Set<Edge> {
  const at = new Map<number, Set<Edge>>();
  for (const edge of edges) {
    for (const node of edge.nodes) at.set(node, (at.get(node) ?? new Set()).add(edge));
  }
  const left = new Set(edges);
  const ends = [...at.keys()];
  while (ends.length > 0) {
    const here = at.get(ends.pop()!)!;
    if (here.size !== 1) continue;
    const [edge] = here;
    left.delete(edge!);
    for (const node of edge!.nodes) {
      at.get(node)!.delete(edge!);
      ends.push(node);
    }
  }
  return left;
}

/** Edges with an angle, and bounds of the surface, as far as they close. */
function creases(edges: Edge[], normals: Triple[], degrees: number): Set<Edge> {
  const least = Math.cos((degrees * Math.PI) / 180);
  const sharp = edges.filter(({ triangles }) => {
    if (triangles.length !== 2) return true;
    const [a, b] = [normals[triangles[0]!]!, normals[triangles[1]!]!];
    const without = Math.hypot(...a) === 0 || Math.hypot(...b) === 0; // an area
    return !without && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < least;
  });
  return closed(sharp);
}

/** For each node: which of its triangles share an edge there that is no crease. */
function smoothNeighbours(edges: Edge[], sharp: Set<Edge>): Map<number, [number, number][]> {
  const pairs = new Map<number, [number, number][]>();
  for (const edge of edges) {
    if (sharp.has(edge) || edge.triangles.length < 2) continue;
    for (const node of edge.nodes) {
      const list = pairs.get(node) ?? [];
      list.push([edge.triangles[0]!, edge.triangles[1]!]);
      pairs.set(node, list);
    }
  }
  return pairs;
}

/** Corners of a node in groups: within one, triangles are connected by pairs. */
function bundles(corners: number[], pairs: readonly [number, number][]): number[][] {
  const bundleOf = new Map(corners.map((corner) => [Math.floor(corner / 3), [corner]]));
  for (const [a, b] of pairs) {
    const [one, other] = [bundleOf.get(a)!, bundleOf.get(b)!];
    if (one === other) continue;
    one.push(...other);
    for (const corner of other) bundleOf.set(Math.floor(corner / 3), one);
  }
  return [...new Set(bundleOf.values())];
}

/**
 * Gives a node one vertex for each bundle of its triangles that are smooth among themselves: those that can be
 * reached from each other over edges that are no creases. An edge is a crease when the normals at rest beside it
 * differ by more than the crease angle and it belongs to a line of such edges that has no end. Triangles of
 * different kinds share no vertex, so that each kind can have a colour of its own.
 * @param kinds a number for each triangle; null: all are of one kind
 */
export function creaseMesh(
  rest: ArrayLike<number>,
  triangles: Uint32Array,
  creaseDegrees = 35,
  kinds: ArrayLike<number> | null = null,
): CreasedMesh {
  const normals = Array.from({ length: triangles.length / 3 }, (_, t) => {
    const n = normalOf(rest, triangles, t);
    const length = Math.hypot(...n) || 1;
    return n.map((part) => part / length) as Triple;
  });
  const edges = edgesOf(triangles);
  const pairs = smoothNeighbours(edges, creases(edges, normals, creaseDegrees));
  const around = new Map<number, number[]>();
  triangles.forEach((node, corner) => {
    const list = around.get(node) ?? [];
    list.push(corner);
    around.set(node, list);
  });
  const nodeOf: number[] = [];
  const firstOf: number[] = [];
  const index = new Uint32Array(triangles.length);
  for (const [node, corners] of around) {
    for (const bundle of bundles(corners, pairs.get(node) ?? [])) {
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

/** Without creases: the nodes are the vertices. */
export function smoothMesh(nodes: number, triangles: Uint32Array): CreasedMesh {
  const nodeOf = Uint32Array.from(Array(nodes).keys());
  return { nodeOf, index: triangles, firstOf: nodeOf };
}
