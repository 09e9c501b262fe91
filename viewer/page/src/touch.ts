import { Vector3, type Ray } from "three";
import { Hand } from "./hand";
import { Contact, type Frame, type HandMessage, type Scene, type State } from "./protocol";
import type { World } from "./world";

const LEAST_PAUSE_MS = 12; // between two messages: about 60 a second, also where the screen is quicker
const MISSES_MS = 300; // inside the object without touching it, before it comes from outside again
const BEHIND = 0.001; // [m]
const KEEP_ALIVE_MS = 80; // the server lets go after 250 ms of silence

export interface TouchListener {
  send(hand: HandMessage): void;
  /** something that a person ought to know */
  say(text: string): void;
  /** a press has begun or ended */
  changed(active: boolean): void;
}

/** Why this viewer cannot touch now, for a person; null: it can. Pure. */
export function refusal(scene: Scene | null, state: State | null): string | null {
  if (scene === null || state === null) return "There is no connection to the server.";
  if (state.onlyLooksOn) return "This link is view only: it does not let you touch.";
  if (state.playback !== null) return "A recorded run is shown: it can be seen, not touched.";
  if (!scene.viewersStylus) return "This run has no stylus for viewers: it can be seen, not touched.";
  if (!state.stylusFree && !state.stylusMine) return "Another viewer has the stylus. Wait until it is free.";
  if (state.paused && !scene.lockstep) return "The run is paused: resume to touch.";
  return null;
}

/** The viewers' stylus in the hand of this viewer: one press from beginning to end, by pointer or by keys. */
export class Touch {
  /** takes hold as long as it is set */
  grabs = false;
  private scene: Scene | null = null;
  private state: State | null = null;
  private hand: Hand | null = null;
  private ray: Ray | null = null;
  private holds = false;
  private missesSince = 0;
  private lastSent = 0;
  private timer = 0;

  constructor(
    private readonly world: World,
    private readonly listener: TouchListener,
  ) {}

  get active(): boolean {
    return this.hand !== null;
  }

  show(scene: Scene): void {
    this.scene = scene;
    this.state = null;
    this.release();
  }

  showState(state: State): void {
    // The server has not heard of it for too long, and has forgotten where it touches.
    if (this.state?.stylusMine && state.stylusFree) this.hand?.again();
    this.state = state;
    if (this.active && refusal(this.scene, state) !== null) {
      this.release();
      this.listener.say(refusal(this.scene, state)!);
    }
  }

  follow(frame: Frame): void {
    const { present, contact, tip } = frame.styluses.at(-1)!;
    this.holds = contact === Contact.Held;
    const misses = this.active && present && this.state?.stylusMine === true && contact === Contact.Free;
    const now = performance.now();
    if (!misses) this.missesSince = now;
    else if (now - this.missesSince > MISSES_MS) {
      this.missesSince = now;
      this.comeAgain(new Vector3(...tip));
    }
  }

  /** A tip that is inside, after everything was reset say, touches nothing until it has been outside. */
  private comeAgain(tip: Vector3): void {
    const place = this.world.pick(this.ray!);
    if (place === null || tip.distanceTo(this.ray!.origin) < place.distanceTo(this.ray!.origin) + BEHIND) return;
    this.hand = this.handAt(place, this.ray!);
  }

  private handAt(place: Vector3, ray: Ray): Hand {
    const { ball, radius, reach } = this.scene!.styluses.at(-1)!;
    return new Hand(place, ray, this.world.view.forward(), ball ? 0 : reach, this.grabs, ball ? radius : 0);
  }

  lost(): void {
    this.state = null;
    this.release();
  }

  /** @returns whether there is something that can be touched at this point of the canvas [CSS px] */
  isOver(x: number, y: number): boolean {
    return refusal(this.scene, this.state) === null && this.world.pick(this.world.view.rayThrough(x, y)) !== null;
  }

  /** @returns whether a press has begun at this point of the canvas [CSS px] */
  press(x: number, y: number): boolean {
    if (this.active) return false;
    const ray = this.world.view.rayThrough(x, y);
    const place = this.world.pick(ray);
    if (place === null) return false;
    const reason = refusal(this.scene, this.state);
    if (reason !== null) {
      this.listener.say(reason);
      return false;
    }
    this.ray = ray;
    this.hand = this.handAt(place, ray);
    this.missesSince = performance.now();
    this.world.held = true;
    this.timer = window.setInterval(() => this.send(KEEP_ALIVE_MS), KEEP_ALIVE_MS);
    this.listener.changed(true);
    this.beat();
    return true;
  }

  aim(x: number, y: number): void {
    this.ray = this.world.view.rayThrough(x, y);
    this.hand?.aim(this.ray);
  }

  /** Further from the eye. [m] */
  deepen(way: number): void {
    if (this.holds) this.hand?.carry(way);
    else this.hand?.deepen(way);
  }

  release(): void {
    if (this.hand === null) return;
    const tip = this.hand.tip(performance.now());
    clearInterval(this.timer);
    this.hand = null;
    this.world.held = false;
    this.world.showHand(null);
    this.listener.send({ present: false, grab: false, tip: tip.toArray() });
    this.listener.changed(false);
  }

  /** Where the hand is [m], W. */
  tip(): Vector3 | null {
    return this.hand?.tip(performance.now()) ?? null;
  }

  private beat(): void {
    if (this.hand === null) return;
    this.send(LEAST_PAUSE_MS);
    requestAnimationFrame(() => this.beat());
  }

  private send(leastPause: number): void {
    const now = performance.now();
    if (this.hand === null || now - this.lastSent < leastPause) return;
    this.lastSent = now;
    const tip = this.hand.tip(now);
    this.world.showHand(tip);
    this.listener.send({ present: true, grab: this.grabs && this.hand.mayTakeHold(now), tip: tip.toArray() });
  }
}
