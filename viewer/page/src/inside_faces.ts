import * as THREE from "three";
import { colourAt, linear, logarithmic, VIRIDIS } from "./colour_map";
import { giveOwnLight } from "./own_light";
import type { Regions, Span } from "./regions";

/** The faces between regions of an object, at rest; they are seen through its surface. B */
export class InsideFaces {
  readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;

  constructor(private readonly regions: Regions) {
    const indexed = new THREE.BufferGeometry();
    indexed.setAttribute("position", new THREE.BufferAttribute(regions.nodes, 3));
    indexed.setIndex(new THREE.BufferAttribute(regions.faces, 1));
    const geometry = indexed.toNonIndexed();
    indexed.dispose();
    geometry.computeVertexNormals();
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * regions.faces.length), 3));
    const material = new THREE.MeshStandardMaterial({ roughness: 0.6, vertexColors: true, side: THREE.DoubleSide });
    giveOwnLight(material);
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.visible = false;
  }

  /** @param range of Young's moduli [Pa] at both ends of the ramp */
  paint(range: Span): void {
    const colours = this.mesh.geometry.getAttribute("color") as THREE.BufferAttribute;
    const into = colours.array as Float32Array;
    this.regions.faceModulus.forEach((modulus, face) => {
      for (let at = 9 * face; at < 9 * face + 9; at += 3) colourAt(VIRIDIS, logarithmic(modulus, range), into, at);
    });
    for (let i = 0; i < into.length; ++i) into[i] = linear(into[i]!);
    colours.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
