import * as THREE from "three";
import { colourAt, linear, logarithmic, VIRIDIS } from "./colour_map";
import { DrawnSurface } from "./drawn_surface";
import type { Patch } from "./held_patch";
import { InsideFaces } from "./inside_faces";
import { SurfaceMarks } from "./surface_marks";
import { creaseMesh, vertexNormals, type CreasedMesh } from "./creases";
import type { ObjectState, SceneObject } from "./protocol";
import type { Span } from "./regions";
import type { Theme } from "./theme";

export type Colouring = "none" | "displacement" | "velocity" | "compliance" | "modulus";

/** Values at both ends of the colours' ramp: [m], [m/s], [m/N] or, logarithmic, [Pa]. */
export type ColourRange = Span;

const THROUGH_RIGID = 0.6; // opacity of the surface
const THROUGH_INSIDE = 0.4;
const UNKNOWN: readonly [number, number, number] = [0.5, 0.5, 0.5];

/** One deforming object: its surface, and the rigid body alone as a wireframe (the paper's Figure 4). */
export class SoftObject {
  readonly group = new THREE.Group();
  /** u of the last frame [m], B, three numbers a node; never exaggerated */
  readonly displacement: Float32Array;
  readonly drawn: DrawnSurface;
  /** of the coloured quantity in the last frame: [m] or [m/s] */
  largest = 0;
  readonly marks: SurfaceMarks;
  /** of its nodes [m/N]; null: not known */
  readonly complianceRange: ColourRange | null;
  /** of Young's moduli at its surface and inside [Pa]; null: it is rigid */
  readonly modulusRange: ColourRange | null;

  private readonly creased: CreasedMesh;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material = new THREE.MeshStandardMaterial({ roughness: 0.48, metalness: 0 });
  private readonly rigid: THREE.LineSegments<THREE.WireframeGeometry, THREE.LineBasicMaterial>;
  private readonly inside: InsideFaces | null;
  private readonly values: Float32Array;
  /** of each vertex that is drawn: Young's modulus [Pa]; NaN: not known */
  private readonly moduli: Float32Array;
  private readonly world: Float32Array;
  private worldTime = Number.NaN;

  constructor(private readonly object: SceneObject) {
    const nodes = object.rest.length / 3;
    this.displacement = new Float32Array(3 * nodes);
    this.drawn = new DrawnSurface(object, this.displacement);
    this.values = new Float32Array(nodes);
    this.world = new Float32Array(3 * nodes);
    const { regions } = object;
    this.creased = creaseMesh(object.rest, object.triangles, undefined, regions?.surfaceModulus);
    const vertices = this.creased.nodeOf.length;
    this.moduli = new Float32Array(vertices).fill(object.stiffness > 0 ? object.stiffness : Number.NaN);
    if (regions !== null) {
      this.creased.index.forEach((v, corner) => (this.moduli[v] = regions.surfaceModulus[Math.floor(corner / 3)]!));
    }
    this.modulusRange = rangeOf(Float32Array.from([...this.moduli, ...listedModuli(object)]));
    this.inside = regions !== null && regions.faces.length > 0 ? new InsideFaces(regions) : null;
    for (const name of ["position", "normal", "color"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
      this.geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    }
    const restOfVertices = new Float32Array(3 * vertices);
    this.creased.nodeOf.forEach((node, v) => restOfVertices.set(object.rest.subarray(3 * node, 3 * node + 3), 3 * v));
    this.geometry.setAttribute("rest", new THREE.BufferAttribute(restOfVertices, 3));
    this.geometry.setIndex(new THREE.BufferAttribute(this.creased.index, 1));
    this.marks = new SurfaceMarks(this.material);
    this.complianceRange = rangeOf(object.compliance);
    const mesh = new THREE.Mesh(this.geometry, this.material);
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;

    const rest = new THREE.BufferGeometry();
    rest.setAttribute("position", new THREE.BufferAttribute(object.rest, 3));
    rest.setIndex(new THREE.BufferAttribute(object.triangles, 1));
    this.rigid = new THREE.LineSegments(
      new THREE.WireframeGeometry(rest),
      new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }),
    );
    this.rigid.visible = false;
    this.group.add(mesh, this.rigid);
    if (this.inside !== null) this.group.add(this.inside.mesh);
    this.draw("none", { low: 0, high: 0 });
  }

  get name(): string {
    return this.object.name;
  }

  /** The wires of the rigid body, and the faces inside in the colours of a range, are looked at through the surface. */
  showThrough(rigid: boolean, inside: ColourRange | null): void {
    this.rigid.visible = rigid;
    if (this.inside !== null) this.inside.mesh.visible = inside !== null;
    if (inside !== null) this.inside?.paint(inside);
    this.material.opacity = this.inside?.mesh.visible ? THROUGH_INSIDE : rigid ? THROUGH_RIGID : 1;
    this.material.transparent = this.material.opacity < 1;
    this.material.needsUpdate = true;
  }

  applyTheme(theme: Theme): void {
    this.rigid.material.color.set(theme.wire);
    if (!this.material.vertexColors) this.material.color.set(theme.object);
    this.plain = theme.object;
    this.marks.colour = theme.accent;
  }
  private plain = "#ffffff";

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
    const positions = this.geometry.getAttribute("position") as THREE.BufferAttribute;
    const normals = this.geometry.getAttribute("normal") as THREE.BufferAttribute;
    const colours = this.geometry.getAttribute("color") as THREE.BufferAttribute;
    const at = positions.array as Float32Array;
    const colour = colours.array as Float32Array;
    const { nodeOf } = this.creased;
    const { exaggeration, displacement } = this.drawn;
    const coloured = colouring !== "none";
    const ofMaterial = colouring === "modulus";
    const values = ofMaterial ? this.moduli : colouring === "compliance" ? this.object.compliance : this.values;
    const share = ofMaterial ? logarithmic : linearly;
    for (let v = 0; v < nodeOf.length; ++v) {
      const node = nodeOf[v]!;
      for (let c = 0; c < 3; ++c) {
        at[3 * v + c] = this.object.rest[3 * node + c]! + exaggeration * displacement[3 * node + c]!;
      }
      if (!coloured) continue;
      const value = values[ofMaterial ? v : node]!;
      if (Number.isNaN(value)) colour.set(UNKNOWN, 3 * v);
      else colourAt(VIRIDIS, share(value, range), colour, 3 * v);
      for (let c = 0; c < 3; ++c) colour[3 * v + c] = linear(colour[3 * v + c]!);
    }
    vertexNormals(at, this.creased, normals.array as Float32Array);
    positions.needsUpdate = true;
    normals.needsUpdate = true;
    colours.needsUpdate = coloured;
    this.marks.coloursAreValues = coloured;
    if (this.material.vertexColors !== coloured) {
      this.material.vertexColors = coloured;
      this.material.needsUpdate = true;
    }
    this.material.color.set(coloured ? "#ffffff" : this.plain);
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
    const at = this.geometry.getAttribute("position") as THREE.BufferAttribute;
    const { index, nodeOf } = this.creased;
    const [a, b, c, point] = Array.from({ length: 4 }, () => new THREE.Vector3()) as [Vector, Vector, Vector, Vector];
    let nearest = Number.POSITIVE_INFINITY;
    let corners: [number, number, number] | null = null;
    for (let t = 0; t < index.length; t += 3) {
      const [i, j, k] = [index[t]!, index[t + 1]!, index[t + 2]!];
      a.fromBufferAttribute(at, i);
      b.fromBufferAttribute(at, j);
      c.fromBufferAttribute(at, k);
      if (local.intersectTriangle(a, b, c, true, point) === null) continue;
      const distance = point.distanceTo(local.origin);
      if (distance >= nearest) continue;
      nearest = distance;
      corners = [i, j, k];
    }
    if (corners === null) return null;
    const triangle = new THREE.Triangle().setFromAttributeAndIndices(at, ...corners);
    const shares = triangle.getBarycoord(local.at(nearest, point), new THREE.Vector3());
    const place = new THREE.Vector3();
    corners.forEach((vertex, corner) => place.addScaledVector(this.trueNode(nodeOf[vertex]!), shares!.getComponent(corner)));
    return { point: place.applyMatrix4(this.group.matrixWorld), distance: nearest };
  }

  /** [m], B */
  private trueNode(node: number): THREE.Vector3 {
    const u = new THREE.Vector3().fromArray(this.displacement, 3 * node);
    return u.add(new THREE.Vector3().fromArray(this.object.rest, 3 * node));
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
    this.rigid.geometry.dispose();
    this.rigid.material.dispose();
    this.inside?.dispose();
  }
}

type Vector = THREE.Vector3;

function linearly(value: number, { low, high }: ColourRange): number {
  return high > low ? (value - low) / (high - low) : 0;
}

/** Those at the ends of what its regions have [Pa]. */
function listedModuli({ regions }: SceneObject): number[] {
  return (regions?.list ?? []).flatMap(({ youngsModulus }) => [youngsModulus.low, youngsModulus.high]);
}

function rangeOf(values: Float32Array): ColourRange | null {
  const known = values.filter((value) => !Number.isNaN(value));
  if (known.length === 0) return null;
  return { low: known.reduce((a, b) => Math.min(a, b)), high: known.reduce((a, b) => Math.max(a, b)) };
}
