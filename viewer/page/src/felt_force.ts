import { Vector3 } from "three";
import { Contact, type Frame, type Scene } from "./protocol";
import type { Touch } from "./touch";
import type { World } from "./world";

const NEAR_THE_BOUND = 0.98;

/** What a hand feels, in words. Pure. @param bound largest force [N]; 0: none */
export function feltText(force: number, contact: Contact, slips: boolean, bound: number): [string, string] {
  const newtons = `${force.toFixed(2)} N`;
  if (bound > 0 && force >= NEAR_THE_BOUND * bound) return [newtons, "as hard as it may"];
  if (contact === Contact.Held) return [newtons, "held"];
  if (contact === Contact.Free) return [newtons, "in the air"];
  return [newtons, slips ? "slips" : "sticks"];
}

/** The force that this viewer's hand would feel, beside its tip. */
export class FeltForce {
  constructor(
    private readonly label: HTMLElement,
    private readonly world: World,
    private readonly touch: Touch,
  ) {}

  follow(frame: Frame, scene: Scene): void {
    const tip = this.touch.tip();
    this.label.hidden = tip === null;
    if (tip === null) return;
    const stylus = frame.styluses.at(-1)!;
    const bound = scene.styluses.at(-1)!.largestForce;
    const force = stylus.present ? new Vector3(...stylus.force).length() : 0;
    const contact = stylus.present ? stylus.contact : Contact.Free;
    const [newtons, how] = feltText(force, contact, stylus.slips, bound);
    this.label.children[0]!.textContent = newtons;
    this.label.children[1]!.textContent = how;
    const { x, y } = this.world.view.onCanvas(tip.add(this.world.shiftOfHand()));
    this.label.style.translate = `${x.toFixed(1)}px ${y.toFixed(1)}px`;
  }

  hide(): void {
    this.label.hidden = true;
  }
}
