import * as THREE from "three";
import type { Scene } from "./protocol";
import type { Theme } from "./theme";

/** Light, shadow, and the floor where there is one. */
export class Surroundings {
  readonly group = new THREE.Group();
  private readonly sun = new THREE.DirectionalLight(0xfff6ea, 2.3);
  private readonly sky = new THREE.HemisphereLight(0xffffff, 0xa9b6be, 1.3);
  /** Near by, so that flat faces get a gradient from it. */
  private readonly lamp = new THREE.PointLight(0xf4f8ff, 1);
  private readonly ground = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial());
  private grid: THREE.GridHelper | null = null;
  private floor: Scene["floor"] = null;

  constructor() {
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(512, 512);
    this.sun.shadow.radius = 4;
    this.sun.shadow.normalBias = 0.002;
    this.sun.shadow.bias = -0.0005;
    this.ground.receiveShadow = true;
    this.group.add(this.sun, this.sun.target, this.sky, this.lamp, this.ground);
  }

  /** Round the objects that are within this ball [m]. */
  place({ center, radius }: THREE.Sphere, floor: Scene["floor"], theme: Theme): void {
    this.floor = floor;
    this.placeLight(center, radius);
    this.placeGround(center, radius, theme);
  }

  moveBy(way: THREE.Vector3): void {
    for (const thing of [this.sun, this.sun.target, this.lamp]) thing.position.add(way);
    this.sun.target.updateMatrixWorld();
    if (this.floor === null) this.ground.position.add(way);
  }

  applyTheme(theme: Theme): void {
    this.ground.material.opacity = theme.dark ? 0.4 : 0.13;
    this.sky.groundColor.set(theme.dark ? 0x2f3a41 : 0xa9b6be);
    this.sky.intensity = theme.dark ? 0.75 : 1.3;
  }

  private placeLight(center: THREE.Vector3, radius: number): void {
    const reach = 2.4 * radius;
    this.sun.target.position.copy(center);
    this.sun.position.copy(center).add(new THREE.Vector3(0.5, 1.5, 0.65).normalize().multiplyScalar(4 * radius));
    this.lamp.position.copy(center).add(new THREE.Vector3(-1.1, 0.5, 1.6).multiplyScalar(radius));
    this.lamp.intensity = 1.1 * (2 * radius) ** 2; // candela; it falls with the distance squared
    const shadow = this.sun.shadow.camera;
    shadow.left = shadow.bottom = -reach;
    shadow.right = shadow.top = reach;
    shadow.near = 0.5 * radius;
    shadow.far = 9 * radius;
    shadow.updateProjectionMatrix();
  }

  /** The floor where there is one, with lines every 2 cm; else only a shadow, far enough below to be none. */
  private placeGround(center: THREE.Vector3, radius: number, theme: Theme): void {
    if (this.grid !== null) {
      this.group.remove(this.grid);
      this.grid.dispose();
      this.grid = null;
    }
    const { floor } = this;
    const up = floor === null ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(...floor.normal);
    const height = floor === null ? center.y - 1.35 * radius : floor.height;
    const middle = center.clone().addScaledVector(up, height - center.dot(up));
    this.ground.position.copy(middle);
    this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
    this.ground.scale.setScalar(40 * radius);
    if (floor === null) return;
    const size = Math.ceil((8 * radius) / 0.04) * 0.04;
    this.grid = new THREE.GridHelper(size, Math.round(size / 0.02), theme.line, theme.line);
    this.grid.position.copy(middle).addScaledVector(up, -1e-4);
    this.grid.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
    this.group.add(this.grid);
  }
}
