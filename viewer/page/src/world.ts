import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { ArrowScale } from "./arrow_scale";
import { PRESETS, type CameraView, type Preset } from "./camera_memory";
import { AUTOMATIC, rangeAsSet, type SetRange } from "./colour_range";
import { ContactMarks } from "./contact_marks";
import { looksTheSame } from "./frame_changes";
import { ALL_OVERLAYS, type Overlays } from "./overlays";
import { Contact, type BodyContact, type Frame, type Scene } from "./protocol";
import { SceneryBody } from "./scenery_body";
import { SoftObject, type ColourRange, type Colouring } from "./soft_object";
import { Stylus } from "./stylus";
import { Surroundings } from "./surroundings";
import type { Theme } from "./theme";

const FIELD_OF_VIEW = 32;

export interface Look {
  exaggeration: number;
  colouring: Colouring;
  /** of the colours, not of Young's modulus */
  range: SetRange;
  rigid: boolean;
  overlays: Overlays;
  /** the camera goes along with objects that leave the middle of the picture */
  follow: boolean;
}

/** The three-dimensional picture. It is drawn when something has changed, and not otherwise. */
export class World {
  readonly camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.005, 50);
  objects: SoftObject[] = [];
  look: Look = { exaggeration: 1, colouring: "none", range: AUTOMATIC, rigid: false, overlays: ALL_OVERLAYS, follow: true };
  colours: ColourRange = { low: 0, high: 0 };
  /** a hand is on the objects: the camera stays where it is */
  held = false;
  /** called after each drawing */
  readonly onDraw: (() => void)[] = [];
  /** called when a person has moved the camera */
  onCamera: (view: CameraView) => void = () => {};

  private readonly renderer: THREE.WebGLRenderer;
  private readonly three = new THREE.Scene();
  readonly controls: OrbitControls;
  private readonly surroundings = new Surroundings();
  readonly contacts = new ContactMarks();
  private scenery: SceneryBody[] = [];
  private arrows = new ArrowScale();
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
    this.three.add(this.surroundings.group, this.contacts.group);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("end", () => this.tellCamera());
    canvas.style.removeProperty("cursor"); // which OrbitControls sets over the style sheet's
    this.controls.addEventListener("change", () => this.invalidate());
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /**
   * Replaces everything that is shown. The camera stays where it is when the scene is one of before.
   * @param view to begin with; null: everything
   */
  show(scene: Scene, view: CameraView | null = null): void {
    const first = this.scene === null;
    for (const thing of [...this.objects, ...this.styluses, ...this.scenery]) {
      this.three.remove(thing.group);
      thing.dispose();
    }
    this.scene = scene;
    this.frame = null;
    this.colours = { low: 0, high: 0 };
    this.largestOfLate = 0;
    this.objects = scene.objects.map((object) => new SoftObject(object));
    this.styluses = scene.styluses.map((stylus) => new Stylus(stylus));
    this.scenery = scene.scenery.map((body) => new SceneryBody(body));
    this.contacts.clear();
    for (const thing of [...this.objects, ...this.styluses, ...this.scenery]) this.three.add(thing.group);
    this.applyTheme(this.theme);
    this.applyLook();
    this.arrows = new ArrowScale(this.bounds().radius);
    if (!first) return;
    this.fitPending = true;
    this.firstView = view;
  }
  private fitPending = false;
  private firstView: CameraView | null = null;

  follow(frame: Frame): void {
    // The same one once more is for colours to go on, as irdm-replay has it.
    const rests = this.frame !== null && this.frame !== frame && looksTheSame(this.frame, frame);
    this.frame = frame;
    this.showFrame(frame, rests);
    if (this.fitPending) this.begin();
    else if (this.look.follow && !this.held) this.goAlong(frame);
    // Once more when it comes to rest: speeds are then zero.
    if (!rests || !this.rested) this.invalidate();
    this.rested = rests;
  }
  private rested = false;

  /** @param rests it looks like the frame before: what changes by and by stays as it is */
  private showFrame(frame: Frame, rests: boolean): void {
    frame.objects.forEach((state, i) => this.objects[i]!.follow(state, frame.time, this.look.colouring));
    this.markStyluses(frame);
    if (!rests) this.arrows.follow(largestForce(frame), frame.time);
    const { overlays } = this.look;
    frame.styluses.forEach((state, s) => {
      const touched = state.contact === Contact.Free ? undefined : this.objects[state.object];
      const shift = touched?.shiftOfStylus(s, state.middle) ?? new THREE.Vector3();
      this.styluses[s]!.follow(state, overlays, this.metresPerNewton, shift);
    });
    if (rests) return;
    this.contacts.follow(frame.contacts.map((contact) => this.shifted(contact)), overlays, this.metresPerNewton);
    this.followColours();
  }

  /** Where the object that it acts on is drawn. */
  private shifted(contact: BodyContact): BodyContact {
    const shift = this.objects[contact.object]!.shiftAt(contact.position);
    return { ...contact, position: shift.add(new THREE.Vector3(...contact.position)).toArray() };
  }

  /** Of the arrows as they are drawn. */
  get metresPerNewton(): number {
    return this.arrows.metresPerNewton * this.look.overlays.arrowLength;
  }

  private markStyluses(frame: Frame): void {
    this.objects.forEach((object, i) => {
      const touching = frame.styluses.map((state, s) => ({ state, radius: this.scene!.styluses[s]!.radius }));
      const here = touching.filter(({ state }) => state.present && state.contact !== Contact.Free && state.object === i);
      const patches = here.map(({ state, radius }) => ({ middle: state.middle, radius }));
      object.marks.show(this.look.overlays.contacts ? patches : []);
      object.showHeld(patches.filter((_, p) => here[p]!.state.contact === Contact.Held && !Number.isNaN(patches[p]!.middle[0])));
    });
  }

  /** The ramp's end follows upwards at once and downwards slowly, so that colours can be compared. */
  private followColours(): void {
    if (this.look.colouring === "compliance") {
      const range = rangeOfAll(this.objects.flatMap((object) => object.complianceRange ?? []));
      this.colours = rangeAsSet(range, this.look.range);
      return;
    }
    if (this.look.colouring === "modulus") {
      this.colours = this.modulusRange;
      return;
    }
    const largest = Math.max(...this.objects.map((object) => object.largest));
    this.largestOfLate = Math.max(largest, this.largestOfLate * 0.995);
    this.colours = rangeAsSet({ low: 0, high: this.largestOfLate }, this.look.range);
  }

  private largestOfLate = 0;

  /** Of all objects that are soft [Pa]. */
  get modulusRange(): ColourRange {
    return rangeOfAll(this.objects.flatMap((object) => object.modulusRange ?? []));
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
    this.surroundings.moveBy(way);
    this.controls.update();
  }
  private radius = 0.1;

  applyLook(): void {
    const inside = this.look.colouring === "modulus" ? this.modulusRange : null;
    for (const object of this.objects) object.showThrough(this.look.rigid, inside);
    for (const object of this.objects) object.drawn.exaggeration = this.look.exaggeration;
    this.colours = { low: 0, high: 0 };
    this.largestOfLate = 0;
    if (this.frame !== null) this.showFrame(this.frame, false);
    this.invalidate();
  }

  applyTheme(theme: Theme): void {
    this.theme = theme;
    for (const thing of [...this.objects, ...this.styluses, ...this.scenery]) thing.applyTheme(theme);
    this.contacts.applyTheme(theme);
    this.surroundings.applyTheme(theme);
    this.setOpaque(this.opaque);
    if (!this.fitPending) this.placeSurroundings();
    this.invalidate();
  }

  private begin(): void {
    this.fitPending = false;
    this.place("fit");
    if (this.firstView === null) return;
    this.controls.target.set(...this.firstView.target);
    this.camera.position.set(...this.firstView.position);
    this.controls.update();
  }

  /** Everything in the picture with room to move; "fit": seen from the front, right and above. */
  fit(from: Preset = "fit"): void {
    if (this.scene === null || this.fitPending) return;
    this.place(from);
    this.tellCamera();
  }

  private tellCamera(): void {
    this.onCamera({ position: this.camera.position.toArray(), target: this.controls.target.toArray() });
  }

  private place(from: Preset): void {
    const { center, radius } = this.bounds();
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
    this.placeSurroundings();
    this.invalidate();
  }

  /** Light, shadow, floor and planes, round the objects. */
  private placeSurroundings(): void {
    if (this.scene === null) return;
    const objects = this.bounds();
    this.surroundings.place(objects, this.scene.floor, this.theme);
    for (const body of this.scenery) body.place(objects, this.theme);
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
    this.tellCamera();
    this.invalidate();
  }

  /** Length of a CSS pixel at the distance of what the camera looks at [m]. */
  metresPerPixel(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return (2 * distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / Math.max(1, this.canvas.clientHeight);
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

  /** What of the objects is seen on a ray first: its true place [m], W. */
  pick(ray: THREE.Ray): THREE.Vector3 | null {
    const hits = this.objects.flatMap((object) => object.pick(ray) ?? []);
    return hits.sort((a, b) => a.distance - b.distance)[0]?.point ?? null;
  }

  /** Where a point of the world is on the canvas [CSS px]. */
  onCanvas(point: THREE.Vector3): { x: number; y: number } {
    const { clientWidth, clientHeight } = this.canvas;
    this.camera.updateMatrixWorld();
    const { x, y } = point.clone().project(this.camera);
    return { x: ((x + 1) / 2) * clientWidth, y: ((1 - y) / 2) * clientHeight };
  }

  /** How far the viewers' stylus is drawn from its true place [m], W. */
  shiftOfHand(): THREE.Vector3 {
    return this.styluses.at(-1)?.group.position ?? new THREE.Vector3();
  }

  /** Where this viewer's hand wants the tip of the viewers' stylus; null: nowhere. [m], W */
  showHand(asked: THREE.Vector3 | null): void {
    const stylus = this.styluses.at(-1);
    if (stylus === undefined) return;
    if (asked === null || stylus.asked?.equals(asked) !== true) this.rested = false;
    stylus.asked = asked;
  }

  /** On a ground of its own, not on that of the page. */
  setOpaque(opaque: boolean): void {
    this.opaque = opaque;
    if (opaque) this.renderer.setClearColor(this.theme.ground, 1);
    else this.renderer.setClearColor(0x000000, 0);
    this.invalidate();
  }
  private opaque = false;

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

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  invalidate(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.drawNow();
    });
  }

  drawNow(): void {
    for (const object of this.objects) object.draw(this.look.colouring, this.colours);
    this.renderer.render(this.three, this.camera);
    for (const call of this.onDraw) call();
  }
}

/** Of what has an arrow [N]. */
function largestForce({ styluses, contacts }: Frame): number {
  const forces = [...styluses.filter(({ present }) => present), ...contacts].map(({ force }) => Math.hypot(...force));
  return Math.max(0, ...forces);
}

function rangeOfAll(ranges: ColourRange[]): ColourRange {
  return { low: Math.min(...ranges.map(({ low }) => low)), high: Math.max(...ranges.map(({ high }) => high)) };
}
