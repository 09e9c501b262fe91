import * as THREE from "three";
import { Ground, UP } from "./ground";
import type { Scene } from "./protocol";
import type { Theme } from "./theme";

/** Light, shadow, and the floor where there is one. */
export class Surroundings {
  readonly group = new THREE.Group();
  private readonly sun = new THREE.DirectionalLight(0xfff6ea, 2.3);
  private readonly sky = new THREE.HemisphereLight(0xffffff, 0xa9b6be, 1.3);
  /** Near by, so that flat faces get a gradient from it. */
  private readonly lamp = new THREE.PointLight(0xf4f8ff, 1);
  private readonly ground = new Ground();
  private floor: Scene["floor"] = null;

  constructor() {
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(512, 512);
    this.sun.shadow.radius = 4;
    this.sun.shadow.normalBias = 0.002;
    this.sun.shadow.bias = -0.0005;
    this.group.add(this.sun, this.sun.target, this.sky, this.lamp, this.ground.group);
  }

  /** Round the objects that are within this ball [m]. */
  place(objects: THREE.Sphere, floor: Scene["floor"], theme: Theme): void {
    this.floor = floor;
    this.placeLight(objects);
    this.placeGround(objects, theme);
  }

  moveBy(way: THREE.Vector3): void {
    for (const thing of [this.sun, this.sun.target, this.lamp]) thing.position.add(way);
    this.sun.target.updateMatrixWorld();
    if (this.floor === null) this.ground.group.position.add(way);
  }

  applyTheme(theme: Theme): void {
    this.ground.applyTheme(theme);
    this.sky.groundColor.set(theme.dark ? 0x2f3a41 : 0xa9b6be);
    this.sky.intensity = theme.dark ? 0.75 : 1.3;
  }

  private placeLight({ center, radius }: THREE.Sphere): void {
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

  /** The floor where there is one; else only a shadow, far enough below to be none. */
  private placeGround(objects: THREE.Sphere, theme: Theme): void {
    const { floor } = this;
    if (floor === null) this.ground.place(objects, UP, objects.center.y - 1.35 * objects.radius, null);
    else this.ground.place(objects, new THREE.Vector3(...floor.normal), floor.height, theme.line);
  }
}
