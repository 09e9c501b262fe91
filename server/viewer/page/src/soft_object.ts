import * as THREE from "three";
import { colourAt, linear } from "./colour_map";
import { creaseMesh, vertexNormals, type CreasedMesh } from "./creases";
import type { ObjectState, SceneObject } from "./protocol";
import type { Theme } from "./theme";

export type Colouring = "none" | "displacement" | "velocity";

/** One deforming object: its surface, and the rigid body alone as a wireframe (the paper's Figure 4). */
export class SoftObject {
  readonly group = new THREE.Group();
  /** u of the last frame [m], B, three numbers a node; never exaggerated */
  readonly displacement: Float32Array;
  /** of the coloured quantity in the last frame: [m] or [m/s] */
  largest = 0;

  private readonly creased: CreasedMesh;
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material = new THREE.MeshStandardMaterial({ roughness: 0.48, metalness: 0 });
  private readonly rigid: THREE.LineSegments<THREE.WireframeGeometry, THREE.LineBasicMaterial>;
  private readonly values: Float32Array;
  private readonly world: Float32Array;
  private worldTime = Number.NaN;

  constructor(private readonly object: SceneObject) {
    const nodes = object.rest.length / 3;
    this.displacement = new Float32Array(3 * nodes);
    this.values = new Float32Array(nodes);
    this.world = new Float32Array(3 * nodes);
    this.creased = creaseMesh(object.rest, object.triangles);
    const vertices = this.creased.nodeOf.length;
    for (const name of ["position", "normal", "color"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
      this.geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    }
    this.geometry.setIndex(new THREE.BufferAttribute(this.creased.index, 1));
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
    this.draw(1, "none", 0);
  }

  get name(): string {
    return this.object.name;
  }

  set showsRigid(shows: boolean) {
    this.rigid.visible = shows;
    // The wires are looked at through the body.
    this.material.transparent = shows;
    this.material.opacity = shows ? 0.6 : 1;
    this.material.needsUpdate = true;
  }

  applyTheme(theme: Theme): void {
    this.rigid.material.color.set(theme.wire);
    if (!this.material.vertexColors) this.material.color.set(theme.object);
    this.plain = theme.object;
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

  /** @param scale value of the colour at the ramp's end [m or m/s] */
  draw(exaggeration: number, colouring: Colouring, scale: number): void {
    const positions = this.geometry.getAttribute("position") as THREE.BufferAttribute;
    const normals = this.geometry.getAttribute("normal") as THREE.BufferAttribute;
    const colours = this.geometry.getAttribute("color") as THREE.BufferAttribute;
    const at = positions.array as Float32Array;
    const colour = colours.array as Float32Array;
    const { nodeOf, index } = this.creased;
    const coloured = colouring !== "none";
    for (let v = 0; v < nodeOf.length; ++v) {
      const node = nodeOf[v]!;
      for (let c = 0; c < 3; ++c) {
        at[3 * v + c] = this.object.rest[3 * node + c]! + exaggeration * this.displacement[3 * node + c]!;
      }
      if (!coloured) continue;
      colourAt(scale > 0 ? this.values[node]! / scale : 0, colour, 3 * v);
      for (let c = 0; c < 3; ++c) colour[3 * v + c] = linear(colour[3 * v + c]!);
    }
    vertexNormals(at, index, normals.array as Float32Array);
    positions.needsUpdate = true;
    normals.needsUpdate = true;
    colours.needsUpdate = coloured;
    if (this.material.vertexColors !== coloured) {
      this.material.vertexColors = coloured;
      this.material.needsUpdate = true;
    }
    this.material.color.set(coloured ? "#ffffff" : this.plain);
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
    this.rigid.geometry.dispose();
    this.rigid.material.dispose();
  }
}
