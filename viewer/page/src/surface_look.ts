import * as THREE from "three";

/** The material of a surface: plain or with a texture, or in colours of its vertices that stand for values. */
export class SurfaceLook {
  readonly material = new THREE.MeshStandardMaterial({ roughness: 0.48, metalness: 0 });
  /** on a surface without other colours */
  plain = "#ffffff";
  texture: THREE.Texture | null = null;

  /** Below 1 it is looked through. */
  set opacity(opacity: number) {
    this.material.opacity = opacity;
    this.material.transparent = opacity < 1;
    this.material.needsUpdate = true;
  }

  /** @param coloured its vertices have colours that stand for values */
  show(coloured: boolean): void {
    const map = coloured ? null : this.texture;
    if (this.material.vertexColors !== coloured || this.material.map !== map) {
      this.material.vertexColors = coloured;
      this.material.map = map;
      this.material.needsUpdate = true;
    }
    this.material.color.set(coloured || map !== null ? "#ffffff" : this.plain);
  }

  dispose(): void {
    this.texture?.dispose();
    this.material.dispose();
  }
}
