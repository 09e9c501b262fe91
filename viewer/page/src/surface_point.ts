// A point of a surface as a mixture of nodes. Pure.
import { Triangle, Vector3, type Ray } from "three";

export interface SurfacePoint {
  nodes: [number, number, number];
  shares: [number, number, number];
}

/** The nearest one to a point [m], B. */
export function nearestOnSurface(point: Vector3, rest: Float32Array, triangles: Uint32Array): SurfacePoint {
  const triangle = new Triangle();
  const place = new Vector3();
  let nearest = Number.POSITIVE_INFINITY;
  let found: SurfacePoint = { nodes: [0, 0, 0], shares: [1, 0, 0] };
  for (let t = 0; t < triangles.length; t += 3) {
    const nodes: SurfacePoint["nodes"] = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
    triangle.a.fromArray(rest, 3 * nodes[0]);
    triangle.b.fromArray(rest, 3 * nodes[1]);
    triangle.c.fromArray(rest, 3 * nodes[2]);
    const away = triangle.closestPointToPoint(point, place).distanceToSquared(point);
    if (away >= nearest) continue;
    const shares = triangle.getBarycoord(place, new Vector3());
    if (shares === null) continue; // it has no area
    nearest = away;
    found = { nodes, shares: shares.toArray() };
  }
  return found;
}

/** The first one on a ray that triangles have on their outer side; null: there is none. [m], B */
export function firstOnRay(ray: Ray, positions: Float32Array, triangles: Uint32Array): { point: SurfacePoint; distance: number } | null {
  const { a, b, c } = new Triangle();
  const place = new Vector3();
  let distance = Number.POSITIVE_INFINITY;
  let nodes: SurfacePoint["nodes"] | null = null;
  for (let t = 0; t < triangles.length; t += 3) {
    a.fromArray(positions, 3 * triangles[t]!);
    b.fromArray(positions, 3 * triangles[t + 1]!);
    c.fromArray(positions, 3 * triangles[t + 2]!);
    if (ray.intersectTriangle(a, b, c, true, place) === null) continue;
    const away = place.distanceTo(ray.origin);
    if (away >= distance) continue;
    distance = away;
    nodes = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
  }
  if (nodes === null) return null;
  const [p, q, r] = nodes.map((node) => new Vector3().fromArray(positions, 3 * node)) as [Vector3, Vector3, Vector3];
  const shares = Triangle.getBarycoord(ray.at(distance, place), p, q, r, new Vector3())!;
  return { point: { nodes, shares: shares.toArray() }, distance };
}

/** The mixture of vectors that nodes have. */
export function mixed({ nodes, shares }: SurfacePoint, vectors: Float32Array): Vector3 {
  const sum = new Vector3();
  nodes.forEach((node, i) => sum.addScaledVector(new Vector3().fromArray(vectors, 3 * node), shares[i]!));
  return sum;
}
