import * as THREE from "three";
import { ArrowScale } from "./arrow_scale";
import { hasSameBodies, type CameraView, type Preset } from "./camera_memory";
import { AUTOMATIC, type SetRange } from "./colour_range";
import { ContactMarks } from "./contact_marks";
import { looksTheSame } from "./frame_changes";
import { ALL_OVERLAYS, type Overlays } from "./overlays";
import { Contact, type BodyContact, type Frame, type Scene } from "./protocol";
import { modulusSpan, RampRange } from "./ramp_range";
import { SceneryBody } from "./scenery_body";
import { SoftObject, type Colouring } from "./soft_object";
import { Stylus } from "./stylus";
import { Surroundings } from "./surroundings";
import type { Theme } from "./theme";
import { ViewCamera } from "./view_camera";

export interface Look {
  exaggeration: number;
  colouring: Colouring;
  /** of the colours, not of Young's modulus */
  range: SetRange;
  rigid: boolean;
  /** the surfaces that compute, not their display meshes */
  computed: boolean;
  overlays: Overlays;
  /** the camera goes along with objects that leave the middle of the picture */
  follow: boolean;
}

/** The three-dimensional picture. It is drawn when something has changed, and not otherwise. */
export class World {
  readonly view: ViewCamera;
  objects: SoftObject[] = [];
  look: Look = { exaggeration: 1, colouring: "none", range: AUTOMATIC, rigid: false, computed: false, overlays: ALL_OVERLAYS, follow: true };
  readonly ramp = new RampRange();
  /** a hand is on the objects: the camera stays where it is */
  held = false;
  /** called after each drawing */
  readonly onDraw: (() => void)[] = [];
  /** called with what cannot be drawn */
  onFault: (text: string) => void = () => {};

  private readonly renderer: THREE.WebGLRenderer;
  private readonly three = new THREE.Scene();
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
    this.view = new ViewCamera(canvas, () => this.invalidate());
    canvas.addEventListener("webglcontextrestored", () => this.invalidate());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  get camera(): THREE.PerspectiveCamera {
    return this.view.camera;
  }

  get controls(): ViewCamera["controls"] {
    return this.view.controls;
  }

  /**
   * Replaces everything that is shown. The camera stays where it is when the bodies are those of before.
   * @param view to begin with; null: everything
   */
  show(scene: Scene, view: CameraView | null = null): void {
    const first = this.scene === null || !hasSameBodies(this.scene, scene);
    for (const thing of [...this.objects, ...this.styluses, ...this.scenery]) {
      this.three.remove(thing.group);
      thing.dispose();
    }
    this.scene = scene;
    this.frame = null;
    this.ramp.restart();
    this.objects = scene.objects.map((object) => new SoftObject(object));
    for (const object of this.objects) void this.dress(object);
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

  /** Its texture is read meanwhile. */
  private async dress(object: SoftObject): Promise<void> {
    try {
      await object.surface.loadTexture();
    } catch {
      this.onFault(`The texture of ${object.name} cannot be read: it is drawn plain.`);
    }
    this.invalidate();
  }

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
      const ball = this.scene!.styluses[s]!.ball;
      const shift = (ball ? touched?.shiftAt(state.proxy) : touched?.shiftOfStylus(s, state.middle)) ?? new THREE.Vector3();
      this.styluses[s]!.follow(state, overlays, this.metresPerNewton, shift);
    });
    if (rests) return;
    this.contacts.follow(frame.contacts.map((contact) => this.shifted(contact)), overlays, this.metresPerNewton);
    this.ramp.follow(this.objects, this.look.colouring, this.look.range);
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
      // A ball holds with a patch of half its radius; its other contacts are marked as those of bodies.
      const touching = frame.styluses.map((state, s) => {
        const { ball, radius } = this.scene!.styluses[s]!;
        return { state, radius: ball ? radius / 2 : radius };
      });
      const here = touching.filter(
        ({ state }) => state.present && state.contact !== Contact.Free && state.object === i && !Number.isNaN(state.middle[0]),
      );
      const patches = here.map(({ state, radius }) => ({ middle: state.middle, radius }));
      object.surface.marks.show(this.look.overlays.contacts ? patches : []);
      object.showHeld(patches.filter((_, p) => here[p]!.state.contact === Contact.Held));
    });
  }

  /** Moves camera, light and shadow, gently, when the objects' middle is further off than they are large. */
  private goAlong(frame: Frame): void {
    const middle = new THREE.Vector3();
    for (const object of frame.objects) middle.add(new THREE.Vector3(...object.position));
    middle.divideScalar(frame.objects.length);
    const way = this.view.follow(middle);
    if (way !== null) this.surroundings.moveBy(way);
  }

  applyLook(): void {
    const inside = this.look.colouring === "modulus" ? modulusSpan(this.objects) : null;
    for (const object of this.objects) object.showThrough(this.look.rigid, inside);
    for (const object of this.objects) {
      object.drawn.exaggeration = this.look.exaggeration;
      object.surface.computedOnly = this.look.computed;
    }
    this.ramp.restart();
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
    if (this.firstView !== null) this.view.restore(this.firstView);
  }

  /** Everything in the picture with room to move; "fit": seen from the front, right and above. */
  fit(from: Preset = "fit"): void {
    if (this.scene === null || this.fitPending) return;
    this.place(from);
    this.view.tell();
  }

  private place(from: Preset): void {
    this.view.showAll(this.bounds(), from);
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
    this.view.move(around, up, zoom);
    this.invalidate();
  }

  /** What of the objects is seen on a ray first: its true place [m], W. */
  pick(ray: THREE.Ray): THREE.Vector3 | null {
    const hits = this.objects.flatMap((object) => object.pick(ray) ?? []);
    return hits.sort((a, b) => a.distance - b.distance)[0]?.point ?? null;
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
    for (const object of this.objects) object.widen(box);
    return box.getBoundingSphere(new THREE.Sphere());
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.view.resize(width, height);
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
    for (const object of this.objects) object.draw(this.look.colouring, this.ramp.ends);
    this.renderer.render(this.three, this.camera);
    for (const call of this.onDraw) call();
  }
}

/** Of what has an arrow [N]. */
function largestForce({ styluses, contacts }: Frame): number {
  const forces = [...styluses.filter(({ present }) => present), ...contacts].map(({ force }) => Math.hypot(...force));
  return Math.max(0, ...forces);
}
