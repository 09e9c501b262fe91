// A point of a surface at rest as a mixture of nodes. Pure.
import { Triangle, Vector3 } from "three";

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

/** The mixture of vectors that nodes have. */
export function mixed({ nodes, shares }: SurfacePoint, vectors: Float32Array): Vector3 {
  const sum = new Vector3();
  nodes.forEach((node, i) => sum.addScaledVector(new Vector3().fromArray(vectors, 3 * node), shares[i]!));
  return sum;
}
