import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Frame, Scene } from "./protocol";
import { SoftObject, type Colouring } from "./soft_object";
import { Stylus } from "./stylus";
import type { Theme } from "./theme";

const FIELD_OF_VIEW = 32;
const VIEW_FROM = new THREE.Vector3(0.55, 0.42, 1).normalize();

export interface Look {
  exaggeration: number;
  colouring: Colouring;
  rigid: boolean;
  /** the camera goes along with objects that leave the middle of the picture */
  follow: boolean;
}

/** The three-dimensional picture. It is drawn when something has changed, and not otherwise. */
export class World {
  readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.005, 50);
  objects: SoftObject[] = [];
  look: Look = { exaggeration: 1, colouring: "none", rigid: false, follow: true };
  /** value at the end of the colours' ramp [m or m/s] */
  colourScale = 0;
  onDraw: () => void = () => {};

  private readonly renderer: THREE.WebGLRenderer;
  private readonly three = new THREE.Scene();
  private readonly controls: OrbitControls;
  private readonly sun = new THREE.DirectionalLight(0xfff6ea, 2.3);
  private readonly sky = new THREE.HemisphereLight(0xffffff, 0xa9b6be, 1.3);
  /** Near by, so that flat faces get a gradient from it. */
  private readonly lamp = new THREE.PointLight(0xf4f8ff, 1);
  private readonly ground: THREE.Mesh<THREE.PlaneGeometry, THREE.ShadowMaterial>;
  private grid: THREE.GridHelper | null = null;
  private styluses: Stylus[] = [];
  private scene: Scene | null = null;
  private frame: Frame | null = null;
  private theme: Theme;
  private asked = false;

  /** Throws when there is no WebGL. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    theme: Theme,
  ) {
    this.theme = theme;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: "high-performance" });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(512, 512);
    this.sun.shadow.radius = 4;
    this.sun.shadow.normalBias = 0.002;
    this.sun.shadow.bias = -0.0005;
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial());
    this.ground.receiveShadow = true;
    this.three.add(this.sun, this.sun.target, this.sky, this.lamp, this.ground);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.invalidate());
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Replaces everything that is shown. The camera stays where it is when the scene is one of before. */
  show(scene: Scene): void {
    const first = this.scene === null;
    for (const thing of [...this.objects, ...this.styluses]) {
      this.three.remove(thing.group);
      thing.dispose();
    }
    this.scene = scene;
    this.frame = null;
    this.colourScale = 0;
    this.objects = scene.objects.map((object) => new SoftObject(object));
    this.styluses = scene.styluses.map((stylus) => new Stylus(stylus));
    for (const thing of [...this.objects, ...this.styluses]) this.three.add(thing.group);
    this.applyTheme(this.theme);
    this.applyLook();
    if (first) this.fitPending = true;
  }
  private fitPending = false;

  follow(frame: Frame): void {
    this.frame = frame;
    frame.objects.forEach((state, i) => this.objects[i]!.follow(state, frame.time, this.look.colouring));
    frame.styluses.forEach((state, s) => this.styluses[s]!.follow(state));
    // The ramp's end follows upwards at once and downwards slowly, so that colours can be compared.
    const largest = Math.max(...this.objects.map((object) => object.largest));
    this.colourScale = Math.max(largest, this.colourScale * 0.995);
    if (this.fitPending) this.fit();
    else if (this.look.follow) this.goAlong(frame);
    this.invalidate();
  }

  /** Moves camera, light and shadow, gently, when the objects' middle is further off than they are large. */
  private goAlong(frame: Frame): void {
    const middle = new THREE.Vector3();
    for (const object of frame.objects) middle.add(new THREE.Vector3(...object.position));
    middle.divideScalar(frame.objects.length);
    const way = middle.sub(this.controls.target);
    const excess = 1 - (0.6 * this.radius) / way.length();
    if (!(excess > 0)) return;
    way.multiplyScalar(Math.min(1, 0.12 * excess));
    this.controls.target.add(way);
    this.camera.position.add(way);
    this.sun.position.add(way);
    this.sun.target.position.add(way);
    this.lamp.position.add(way);
    this.sun.target.updateMatrixWorld();
    if (this.scene?.floor === null) this.ground.position.add(way);
    this.controls.update();
  }
  private radius = 0.1;

  applyLook(): void {
    for (const object of this.objects) object.showsRigid = this.look.rigid;
    this.colourScale = 0;
    if (this.frame !== null) this.follow(this.frame);
    this.invalidate();
  }

  applyTheme(theme: Theme): void {
    this.theme = theme;
    for (const object of this.objects) object.applyTheme(theme);
    for (const stylus of this.styluses) stylus.applyTheme(theme);
    this.ground.material.opacity = theme.dark ? 0.4 : 0.13;
    this.sky.groundColor.set(theme.dark ? 0x2f3a41 : 0xa9b6be);
    this.sky.intensity = theme.dark ? 0.75 : 1.3;
    this.placeGround();
    this.invalidate();
  }

  /** Everything in the picture with room to move, seen from the front, right and above. */
  fit(): void {
    if (this.scene === null) return;
    this.fitPending = false;
    const { center, radius } = this.bounds();
    this.radius = radius;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = (1.6 * radius) / Math.sin((FIELD_OF_VIEW * Math.PI) / 360) / narrow;
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(VIEW_FROM, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = radius * 0.3;
    this.controls.maxDistance = distance * 8;
    this.controls.update();
    this.placeLight(center, radius);
    this.placeGround();
    this.invalidate();
  }

  /** Turns the camera [rad], or brings it nearer (zoom > 1). */
  move(around: number, up: number, zoom: number): void {
    const arm = this.camera.position.clone().sub(this.controls.target);
    const way = new THREE.Spherical().setFromVector3(arm);
    way.theta += around;
    way.phi += up;
    way.radius = Math.min(Math.max(way.radius / zoom, this.controls.minDistance), this.controls.maxDistance);
    this.camera.position.copy(this.controls.target).add(arm.setFromSpherical(way.makeSafe()));
    this.controls.update();
    this.invalidate();
  }

  /** Length of a CSS pixel at the distance of what the camera looks at [m]. */
  metresPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
  }

  private bounds(): THREE.Sphere {
    const box = new THREE.Box3();
    this.objects.forEach((object, i) => {
      const rest = this.scene!.objects[i]!.rest;
      object.group.updateMatrix();
      const point = new THREE.Vector3();
      for (let n = 0; n < rest.length; n += 3) {
        box.expandByPoint(point.fromArray(rest, n).applyMatrix4(object.group.matrix));
      }
    });
    return box.getBoundingSphere(new THREE.Sphere());
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
  private placeGround(): void {
    if (this.scene === null || this.fitPending) return;
    if (this.grid !== null) {
      this.three.remove(this.grid);
      this.grid.dispose();
      this.grid = null;
    }
    const { center, radius } = this.bounds();
    const floor = this.scene.floor;
    const up = floor === null ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(...floor.normal);
    const height = floor === null ? center.y - 1.35 * radius : floor.height;
    const middle = center.clone().addScaledVector(up, height - center.dot(up));
    this.ground.position.copy(middle);
    this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), up);
    this.ground.scale.setScalar(40 * radius);
    if (floor === null) return;
    const size = Math.ceil((8 * radius) / 0.04) * 0.04;
    this.grid = new THREE.GridHelper(size, Math.round(size / 0.02), this.theme.line, this.theme.line);
    this.grid.position.copy(middle).addScaledVector(up, -1e-4);
    this.grid.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), up);
    this.three.add(this.grid);
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  private invalidate(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.drawNow();
    });
  }

  drawNow(): void {
    const { exaggeration, colouring } = this.look;
    for (const object of this.objects) object.draw(exaggeration, colouring, this.colourScale);
    this.renderer.render(this.three, this.camera);
    this.onDraw();
  }
}
