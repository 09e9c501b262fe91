import * as THREE from "three";
import { logarithmic, paintShare } from "./colour_map";
import { creaseMesh, vertexNormals, type CreasedMesh } from "./creases";
import type { DrawnSurface } from "./drawn_surface";
import type { SceneObject } from "./protocol";
import type { Span } from "./regions";
import { SurfaceLook } from "./surface_look";
import type { SurfaceMarks } from "./surface_marks";

/** The triangles that compute: edges stay edges, and each material can have a colour of its own. B */
export class ComputedMesh {
  readonly mesh: THREE.Mesh;
  readonly look = new SurfaceLook();
  private readonly creased: CreasedMesh;
  private readonly geometry = new THREE.BufferGeometry();
  /** of each vertex: Young's modulus [Pa]; NaN: not known */
  private readonly moduli: Float32Array;

  constructor({ rest, triangles, regions, stiffness }: SceneObject, marks: SurfaceMarks) {
    this.creased = creaseMesh(rest, triangles, undefined, regions?.surfaceModulus);
    const { nodeOf, index } = this.creased;
    this.moduli = new Float32Array(nodeOf.length).fill(stiffness > 0 ? stiffness : Number.NaN);
    if (regions !== null) index.forEach((v, corner) => (this.moduli[v] = regions.surfaceModulus[Math.floor(corner / 3)]!));
    for (const name of ["position", "normal", "color"]) {
      const attribute = new THREE.BufferAttribute(new Float32Array(3 * nodeOf.length), 3);
      this.geometry.setAttribute(name, attribute.setUsage(THREE.DynamicDrawUsage));
    }
    const restOfVertices = new Float32Array(3 * nodeOf.length);
    this.spread(rest, restOfVertices);
    this.geometry.setAttribute("rest", new THREE.BufferAttribute(restOfVertices, 3));
    this.geometry.setIndex(new THREE.BufferAttribute(index, 1));
    this.look.material.onBeforeCompile = (shader) => marks.drawBy(shader);
    this.mesh = new THREE.Mesh(this.geometry, this.look.material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  draw({ positions }: DrawnSurface): void {
    const at = this.changed("position");
    this.spread(positions, at);
    vertexNormals(at, this.creased, this.changed("normal"));
  }

  /** @param shares of the ramp, 0 to 1, of the nodes; NaN: not known */
  paint(shares: Float32Array): void {
    const colours = this.changed("color");
    this.creased.nodeOf.forEach((node, v) => paintShare(shares[node]!, colours, 3 * v));
  }

  /** @param range of Young's moduli [Pa] at both ends of the ramp */
  paintModuli(range: Span): void {
    const colours = this.changed("color");
    this.moduli.forEach((value, v) => paintShare(Number.isNaN(value) ? value : logarithmic(value, range), colours, 3 * v));
  }

  /** Three numbers a node to its vertices. */
  private spread(ofNodes: Float32Array, into: Float32Array): void {
    const { nodeOf } = this.creased;
    for (let v = 0; v < nodeOf.length; ++v) {
      const node = 3 * nodeOf[v]!;
      for (let c = 0; c < 3; ++c) into[3 * v + c] = ofNodes[node + c]!;
    }
  }

  private changed(name: string): Float32Array {
    const attribute = this.geometry.getAttribute(name) as THREE.BufferAttribute;
    attribute.needsUpdate = true;
    return attribute.array as Float32Array;
  }

  dispose(): void {
    this.geometry.dispose();
    this.look.dispose();
  }
}
