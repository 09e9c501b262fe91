import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { PRESETS, type CameraView, type Preset } from "./camera_memory";

const FIELD_OF_VIEW = 32;
const HALF = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);

/** The camera, what moves it, and where things are on the canvas. */
export class ViewCamera {
  readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.005, 50);
  readonly controls: OrbitControls;
  /** called when a person has moved it */
  onMoved: (view: CameraView) => void = () => {};
  private radius = 0.1; // of what is looked at [m]

  /** @param changed it looks from elsewhere now, whoever moved it */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    changed: () => void,
  ) {
    this.controls = new OrbitControls(this.camera, canvas);
    canvas.style.removeProperty("cursor"); // which OrbitControls sets over the style sheet's
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("end", () => this.tell());
  }

  tell(): void {
    this.onMoved({ position: this.camera.position.toArray(), target: this.controls.target.toArray() });
  }

  resize(width: number, height: number): void {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** All of a ball with room to move. */
  showAll({ center, radius }: THREE.Sphere, from: Preset): void {
    this.radius = radius;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (1.6 * radius) / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / narrow;
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(new THREE.Vector3(...PRESETS[from]).normalize(), distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = radius * 0.3;
    this.controls.maxDistance = distance * 8;
    this.controls.update();
  }

  restore({ position, target }: CameraView): void {
    this.controls.target.set(...target);
    this.camera.position.set(...position);
    this.controls.update();
  }

  /** Turns it [rad], or brings it nearer (zoom > 1). */
  move(around: number, up: number, zoom: number): void {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const way = new THREE.Spherical().setFromVector3(arm);
    way.theta += around;
    way.phi += up;
    way.radius = Math.min(Math.max(way.radius / zoom, this.controls.minDistance), this.controls.maxDistance);
    this.camera.position.copy(this.controls.target).add(arm.setFromSpherical(way.makeSafe()));
    this.controls.update();
    this.tell();
  }

  /**
   * Follows, gently, what is further from the middle of the picture than it is large.
   * @param middle [m], W @returns the way that it went; null: none
   */
  follow(middle: THREE.Vector3): THREE.Vector3 | null {
    const way = middle.clone().sub(this.controls.target);
    const excess = 1 - (0.6 * this.radius) / way.length();
    if (!(excess > 0)) return null;
    way.multiplyScalar(Math.min(1, 0.12 * excess));
    this.controls.target.add(way);
    this.camera.position.add(way);
    this.controls.update();
    return way;
  }

  /** Length of a CSS pixel at the distance of what the camera looks at [m]. */
  metresPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * HALF) / Math.max(1, this.canvas.clientHeight);
  }

  /** From the eye through a point of the canvas [CSS px]; unit direction. W */
  rayThrough(x: number, y: number): THREE.Ray {
    const { clientWidth, clientHeight } = this.canvas;
    const point = new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight);
    this.camera.updateMatrixWorld();
    const caster = new THREE.Raycaster();
    caster.setFromCamera(point, this.camera);
    return caster.ray;
  }

  /** Unit, W. */
  forward(): THREE.Vector3 {
    return this.camera.getWorldDirection(new THREE.Vector3());
  }

  /** Where a point of the world is on the canvas [CSS px]. */
  onCanvas(point: THREE.Vector3): { x: number; y: number } {
    const { clientWidth, clientHeight } = this.canvas;
    this.camera.updateMatrixWorld();
    const { x, y } = point.clone().project(this.camera);
    return { x: ((x + 1) / 2) * clientWidth, y: ((1 - y) / 2) * clientHeight };
  }
}
