import * as THREE from "three";
import type { Theme } from "./theme";

/** Normal of a ground that is not turned. */
export const UP = new THREE.Vector3(0, 1, 0);
const CELL = 0.02; // between lines [m]

/** The part of a plane that is round the objects: the shadow on it, and lines where it can be touched. */
export class Ground {
  readonly group = new THREE.Group();
  private readonly shadow = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial());
  private grid: THREE.GridHelper | null = null;

  constructor() {
    this.shadow.receiveShadow = true;
    this.shadow.rotation.x = -Math.PI / 2;
    this.group.add(this.shadow);
  }

  /** @param normal unit, W; the plane is at normal . x = height [m] @param line of the lines; null: none */
  place({ center, radius }: THREE.Sphere, normal: THREE.Vector3, height: number, line: string | null): void {
    this.group.position.copy(center).addScaledVector(normal, height - center.dot(normal));
    this.group.quaternion.setFromUnitVectors(UP, normal);
    this.shadow.scale.setScalar(40 * radius);
    this.removeGrid();
    if (line === null) return;
    const cells = 2 * Math.ceil((4 * radius) / CELL);
    this.grid = new THREE.GridHelper(cells * CELL, cells, line, line);
    this.grid.position.y = -1e-4;
    this.group.add(this.grid);
  }

  applyTheme(theme: Theme): void {
    this.shadow.material.opacity = theme.dark ? 0.4 : 0.13;
  }

  private removeGrid(): void {
    if (this.grid === null) return;
    this.group.remove(this.grid);
    this.grid.dispose();
    this.grid = null;
  }

  dispose(): void {
    this.removeGrid();
    this.shadow.geometry.dispose();
    this.shadow.material.dispose();
  }
}
