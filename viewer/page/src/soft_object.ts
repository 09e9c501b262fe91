import * as THREE from "three";
import { DrawnSurface } from "./drawn_surface";
import type { Patch } from "./held_patch";
import { InsideFaces } from "./inside_faces";
import type { ObjectState, SceneObject } from "./protocol";
import type { Span } from "./regions";
import { ShownSurface } from "./shown_surface";
import { firstOnRay, mixed } from "./surface_point";
import type { Theme } from "./theme";

export type Colouring = "none" | "displacement" | "velocity" | "compliance" | "modulus";

/** Values at both ends of the colours' ramp: [m], [m/s], [m/N] or, logarithmic, [Pa]. */
export type ColourRange = Span;

const THROUGH_RIGID = 0.6; // opacity of the surface
const THROUGH_INSIDE = 0.4;

/** One deforming object: its surface, and the rigid body alone as a wireframe (the paper's Figure 4). */
export class SoftObject {
  readonly group = new THREE.Group();
  /** u of the last frame [m], B, three numbers a node; never exaggerated */
  readonly displacement: Float32Array;
  readonly drawn: DrawnSurface;
  /** of the coloured quantity in the last frame: [m] or [m/s] */
  largest = 0;
  readonly surface: ShownSurface;
  /** of its nodes [m/N]; null: not known */
  readonly complianceRange: ColourRange | null;
  /** of Young's moduli at its surface and inside [Pa]; null: it is rigid */
  readonly modulusRange: ColourRange | null;

  private readonly rigid: THREE.LineSegments<THREE.WireframeGeometry, THREE.LineBasicMaterial>;
  private readonly inside: InsideFaces | null;
  private readonly values: Float32Array;
  private readonly world: Float32Array;
  private worldTime = Number.NaN;

  constructor(private readonly object: SceneObject) {
    const nodes = object.rest.length / 3;
    this.displacement = new Float32Array(3 * nodes);
    this.drawn = new DrawnSurface(object, this.displacement);
    this.values = new Float32Array(nodes);
    this.world = new Float32Array(3 * nodes);
    this.surface = new ShownSurface(object);
    const { regions } = object;
    this.complianceRange = rangeOf(object.compliance);
    this.modulusRange = rangeOf(Float32Array.from(moduliOf(object)));
    this.inside = regions !== null && regions.faces.length > 0 ? new InsideFaces(regions) : null;

    const rest = new THREE.BufferGeometry();
    rest.setAttribute("position", new THREE.BufferAttribute(object.rest, 3));
    rest.setIndex(new THREE.BufferAttribute(object.triangles, 1));
    this.rigid = new THREE.LineSegments(
      new THREE.WireframeGeometry(rest),
      new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }),
    );
    this.rigid.visible = false;
    this.group.add(...this.surface.meshes, this.rigid);
    if (this.inside !== null) this.group.add(this.inside.mesh);
    this.draw("none", { low: 0, high: 0 });
  }

  /** By all that is drawn of it at rest. [m], W */
  widen(box: THREE.Box3): void {
    this.group.updateMatrix();
    const point = new THREE.Vector3();
    for (const places of [this.object.rest, this.object.display?.positions ?? []]) {
      for (let i = 0; i < places.length; i += 3) box.expandByPoint(point.fromArray(places, i).applyMatrix4(this.group.matrix));
    }
  }

  get name(): string {
    return this.object.name;
  }

  /** The wires of the rigid body, and the faces inside in the colours of a range, are looked at through the surface. */
  showThrough(rigid: boolean, inside: ColourRange | null): void {
    this.rigid.visible = rigid;
    if (this.inside !== null) this.inside.mesh.visible = inside !== null;
    if (inside !== null) this.inside?.paint(inside);
    this.surface.opacity = this.inside?.mesh.visible ? THROUGH_INSIDE : rigid ? THROUGH_RIGID : 1;
  }

  applyTheme(theme: Theme): void {
    this.rigid.material.color.set(theme.wire);
    this.surface.applyTheme(theme);
  }

  /** Takes in a frame; draw() shows it. */
  follow(state: ObjectState, time: number, colouring: Colouring): void {
    const [w, x, y, z] = state.orientation;
    this.group.position.set(...state.position);
    this.group.quaternion.set(x, y, z, w);
    for (let i = 0; i < this.displacement.length; ++i) this.displacement[i] = state.displacement[i]! * state.unit;
    this.follow_world(time);
    if (colouring === "displacement") this.measure(this.displacement);
  }

  /** Speeds, from where the nodes were one frame ago. [m/s], W */
  private follow_world(time: number): void {
    const elapsed = time - this.worldTime;
    this.group.updateMatrix();
    const point = new THREE.Vector3();
    let largest = 0;
    for (let i = 0; i < this.values.length; ++i) {
      point.fromArray(this.object.rest, 3 * i);
      point.x += this.displacement[3 * i]!;
      point.y += this.displacement[3 * i + 1]!;
      point.z += this.displacement[3 * i + 2]!;
      point.applyMatrix4(this.group.matrix);
      const distance = Math.hypot(
        point.x - this.world[3 * i]!,
        point.y - this.world[3 * i + 1]!,
        point.z - this.world[3 * i + 2]!,
      );
      this.values[i] = elapsed > 0 ? distance / elapsed : 0;
      largest = Math.max(largest, this.values[i]!);
      point.toArray(this.world, 3 * i);
    }
    this.worldTime = time;
    this.largest = largest;
  }

  private measure(vectors: Float32Array): void {
    this.largest = 0;
    for (let i = 0; i < this.values.length; ++i) {
      this.values[i] = Math.hypot(vectors[3 * i]!, vectors[3 * i + 1]!, vectors[3 * i + 2]!);
      this.largest = Math.max(this.largest, this.values[i]!);
    }
  }

  draw(colouring: Colouring, range: ColourRange): void {
    this.drawn.place();
    const values = colouring === "compliance" ? this.object.compliance : this.values;
    this.surface.draw(this.drawn, colouring === "none" || colouring === "modulus" ? colouring : values, range);
  }

  /** @param held what styluses hold of it */
  showHeld(held: readonly Patch[]): void {
    this.drawn.follow(held);
  }

  /** How far the surface is drawn from its true place where a stylus touches it at rest. [m], W */
  shiftOfStylus(stylus: number, middle: readonly [number, number, number]): THREE.Vector3 {
    return this.drawn.shiftOfStylus(stylus, middle).applyQuaternion(this.group.quaternion);
  }

  /** The same at a place [m], W. */
  shiftAt(place: readonly [number, number, number]): THREE.Vector3 {
    this.group.updateMatrixWorld();
    const local = this.group.worldToLocal(new THREE.Vector3(...place));
    return this.drawn.shiftAt(local).applyQuaternion(this.group.quaternion);
  }

  /**
   * Where a ray from the world meets the surface as it is drawn.
   * @returns the true place of what is seen there [m], W; null: nowhere
   */
  pick(ray: THREE.Ray): { point: THREE.Vector3; distance: number } | null {
    this.group.updateMatrixWorld();
    const local = ray.clone().applyMatrix4(this.group.matrixWorld.clone().invert());
    const hit = firstOnRay(local, this.drawn.positions, this.object.triangles);
    if (hit === null) return null;
    const place = mixed(hit.point, this.object.rest).add(mixed(hit.point, this.displacement));
    return { point: place.applyMatrix4(this.group.matrixWorld), distance: hit.distance };
  }

  dispose(): void {
    this.surface.dispose();
    this.rigid.geometry.dispose();
    this.rigid.material.dispose();
    this.inside?.dispose();
  }
}

/** Of its surface, and those at the ends of what its regions have [Pa]; NaN: not known. */
function moduliOf({ stiffness, regions }: SceneObject): number[] {
  if (regions === null) return stiffness > 0 ? [stiffness] : [];
  return [...regions.surfaceModulus, ...regions.list.flatMap(({ youngsModulus }) => [youngsModulus.low, youngsModulus.high])];
}

function rangeOf(values: Float32Array): ColourRange | null {
  const known = values.filter((value) => !Number.isNaN(value));
  if (known.length === 0) return null;
  return { low: known.reduce((a, b) => Math.min(a, b)), high: known.reduce((a, b) => Math.max(a, b)) };
}
