import { Vector3 } from "three";
import { meanEdge, withPatches, type Patch } from "./held_patch";
import type { SceneObject } from "./protocol";
import { mixed, nearestOnSurface, type SurfacePoint } from "./surface_point";

// Radius of the patch of a point that is held: in edges of triangles, but of a coarse mesh no more than a part of it.
const PATCH_EDGES = 1.5;
const PATCH_SHARE = 0.2; // of the object's radius

/**
 * Displacements as they are drawn: those of held patches evened out, all exaggerated; and by how much what touches
 * the surface is moved to stay on it. B
 */
export class DrawnSurface {
  /** before exaggeration [m] */
  readonly displacement: Float32Array;
  /** of the nodes, as place() found them [m] */
  readonly positions: Float32Array;
  exaggeration = 1;
  private readonly leastPatch: number;
  private readonly points = new Map<number, { middle: Vector3; point: SurfacePoint }>();

  /** @param truly displacements of the last frame, which their owner changes [m] */
  constructor(
    private readonly object: SceneObject,
    private readonly truly: Float32Array,
  ) {
    this.displacement = Float32Array.from(truly);
    const { rest, triangles } = object;
    this.positions = Float32Array.from(rest);
    this.leastPatch = Math.min(PATCH_EDGES * meanEdge(rest, triangles), PATCH_SHARE * radiusOf(rest));
  }

  follow(held: readonly Patch[]): void {
    const patches = held.map(({ middle, radius }) => ({ middle, radius: Math.max(radius, this.leastPatch) }));
    this.even = patches.length === 0;
    withPatches(this.object.rest, this.truly, patches, this.displacement);
  }
  private even = true;

  place(): void {
    const { rest } = this.object;
    for (let i = 0; i < rest.length; ++i) this.positions[i] = rest[i]! + this.exaggeration * this.displacement[i]!;
  }

  /** Of a stylus that touches at a point of the surface at rest. [m] */
  shiftOfStylus(stylus: number, middle: readonly [number, number, number]): Vector3 {
    if ((this.exaggeration === 1 && this.even) || Number.isNaN(middle[0])) return new Vector3();
    const at = new Vector3(...middle);
    let known = this.points.get(stylus);
    if (known === undefined || !known.middle.equals(at)) {
      known = { middle: at, point: nearestOnSurface(at, this.object.rest, this.object.triangles) };
      this.points.set(stylus, known);
    }
    return mixed(known.point, this.displacement).multiplyScalar(this.exaggeration).sub(mixed(known.point, this.truly));
  }

  /** Of what touches the deformed surface at a place. [m] */
  shiftAt(place: Vector3): Vector3 {
    if (this.exaggeration === 1 && this.even) return new Vector3();
    const node = this.nearestNode(place);
    const drawn = new Vector3().fromArray(this.displacement, 3 * node).multiplyScalar(this.exaggeration);
    return drawn.sub(new Vector3().fromArray(this.truly, 3 * node));
  }

  private nearestNode({ x, y, z }: Vector3): number {
    const { rest } = this.object;
    let nearest = Number.POSITIVE_INFINITY;
    let found = 0;
    for (let i = 0; i < rest.length; i += 3) {
      const [dx, dy, dz] = [rest[i]! + this.truly[i]! - x, rest[i + 1]! + this.truly[i + 1]! - y, rest[i + 2]! + this.truly[i + 2]! - z];
      const away = dx * dx + dy * dy + dz * dz;
      if (away >= nearest) continue;
      nearest = away;
      found = i / 3;
    }
    return found;
  }
}

/** About the centre of mass [m]. */
function radiusOf(rest: Float32Array): number {
  let most = 0;
  for (let i = 0; i < rest.length; i += 3) most = Math.max(most, Math.hypot(rest[i]!, rest[i + 1]!, rest[i + 2]!));
  return most;
}
