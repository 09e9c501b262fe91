import { cssRamp, PLASMA, VIRIDIS } from "./colour_map";
import type { Preset } from "./camera_memory";
import { numberIn, RangeFields } from "./colour_range";
import { element } from "./elements";
import { insideNotes, materialRows, stressText } from "./material_legend";
import type { Overlays } from "./overlays";
import type { Scene, State } from "./protocol";
import { modulusSpan } from "./ramp_range";
import { forceBar, scaleBar } from "./scale_bar";
import type { Colouring } from "./soft_object";
import type { World } from "./world";

// `factor`: from SI to the unit.
const LEGENDS: Record<Exclude<Colouring, "none" | "modulus">, { title: string; factor: number; unit: string }> = {
  displacement: { title: "Displacement", factor: 1000, unit: "mm" },
  velocity: { title: "Speed of the surface", factor: 100, unit: "cm/s" },
  compliance: { title: "Compliance under a fingertip", factor: 1000, unit: "mm/N" },
};

const MODULUS = "Young’s modulus";

/** How the picture is drawn: exaggeration, colours with their legend, wireframe, camera; and the scale. */
export class ViewControls {
  private readonly exaggeration = element<HTMLInputElement>("exaggeration");
  private readonly colour = element<HTMLSelectElement>("colour");
  private readonly rigid = element<HTMLInputElement>("rigid");
  private readonly computed = element<HTMLInputElement>("computed");
  private readonly contacts = element<HTMLInputElement>("contacts");
  private readonly forces = element<HTMLInputElement>("forces");
  private readonly pressures = element<HTMLInputElement>("pressures");
  private readonly arrowLength = element<HTMLInputElement>("arrow-length");
  private readonly pressureEnd = element<HTMLInputElement>("pressure-end");
  private readonly follow = element<HTMLInputElement>("follow");
  private readonly range = new RangeFields(() => this.apply());

  constructor(private readonly world: World | null) {
    const overlays = [this.contacts, this.forces, this.pressures, this.arrowLength, this.pressureEnd];
    for (const input of [this.exaggeration, this.colour, this.rigid, this.computed, this.follow, ...overlays]) {
      input.oninput = () => this.apply();
    }
    for (const preset of ["fit", "front", "side", "top"] as Preset[]) element(preset).onclick = () => world?.fit(preset);
    document.querySelector<HTMLElement>("#legend .ramp")!.style.background = cssRamp(VIRIDIS);
    document.querySelector<HTMLElement>("#pressure .ramp")!.style.background = cssRamp(PLASMA);
    world?.onDraw.push(() => this.showScale());
    this.apply();
  }

  show(scene: Scene): void {
    const known = scene.objects.some((object) => object.compliance.some((value) => !Number.isNaN(value)));
    this.allow("compliance", known);
    this.allow("modulus", scene.objects.some((object) => object.regions !== null));
    element("computed-choice").hidden = scene.objects.every((object) => object.display === null);
    const option = this.optionOf("modulus");
    option.textContent = option.disabled ? `${MODULUS} (no body has regions)` : MODULUS;
    if (this.world !== null) element("materials").replaceChildren(...materialRows(scene, modulusSpan(this.world.objects)));
    element("materials-note").textContent = insideNotes(scene);
    this.apply();
  }

  /** The camera can follow only what moves. */
  showState({ changeable }: State): void {
    const still = changeable.every(({ motion }) => !motion);
    this.follow.disabled = still;
    element("follow-reason").hidden = !still;
  }

  private optionOf(colouring: Colouring): HTMLOptionElement {
    return this.colour.querySelector<HTMLOptionElement>(`option[value=${colouring}]`)!;
  }

  private allow(colouring: Colouring, allowed: boolean): void {
    this.optionOf(colouring).disabled = !allowed;
    if (!allowed && this.colour.value === colouring) this.colour.value = "none";
  }

  nextColour(): void {
    const { options } = this.colour;
    do this.colour.selectedIndex = (this.colour.selectedIndex + 1) % options.length;
    while (options[this.colour.selectedIndex]!.disabled);
    this.apply();
  }

  toggleRigid(): void {
    this.rigid.checked = !this.rigid.checked;
    this.apply();
  }

  exaggerate(up: boolean): void {
    if (up) this.exaggeration.stepUp();
    else this.exaggeration.stepDown();
    this.apply();
  }

  /** Now and then: the ramps' ends move. */
  showLegend(): void {
    if (this.world === null) return;
    const { end } = this.world.contacts;
    element("pressure").hidden = !this.pressures.checked || end === 0;
    element("pressure-max").textContent = `${(end / 1000).toPrecision(3)} kPa`;
    const { colouring } = this.world.look;
    if (colouring === "none") return;
    const { low, high } = this.world.ramp.ends;
    if (colouring === "modulus") {
      element("legend-min").textContent = stressText({ low, high: low });
      element("legend-max").textContent = stressText({ low: high, high });
      return;
    }
    const { factor, unit } = LEGENDS[colouring];
    element("legend-min").textContent = low === 0 ? "0" : (low * factor).toPrecision(3);
    element("legend-max").textContent = `${(high * factor).toPrecision(3)} ${unit}`;
  }

  private apply(): void {
    const factor = Number(this.exaggeration.value);
    element("exaggeration-value").textContent = `× ${factor}`;
    this.exaggeration.setAttribute("aria-valuetext", `times ${factor}`);
    const overlays = this.overlays();
    element("force-scale").hidden = !overlays.forces || this.world === null;
    element("arrow-length-value").textContent = `× ${Number(overlays.arrowLength.toPrecision(2))}`;
    this.arrowLength.setAttribute("aria-valuetext", `times ${Number(overlays.arrowLength.toPrecision(2))}`);
    const colouring = this.colour.value as Colouring;
    element("legend").hidden = colouring === "none" || this.world === null;
    element("materials").hidden = element("materials-note").hidden = colouring !== "modulus";
    if (colouring === "modulus") element("legend-title").textContent = `${MODULUS}, logarithmic`;
    else if (colouring !== "none") element("legend-title").textContent = LEGENDS[colouring].title;
    const kind = colouring === "none" || colouring === "modulus" ? null : LEGENDS[colouring];
    this.range.show(colouring, kind?.factor ?? null, kind?.unit ?? "");
    if (this.world === null) return;
    this.world.look = {
      exaggeration: factor,
      colouring,
      range: this.range.of(colouring),
      rigid: this.rigid.checked,
      computed: this.computed.checked,
      overlays,
      follow: this.follow.checked,
    };
    this.world.applyLook();
    this.showLegend();
  }

  private overlays(): Overlays {
    const pressureEnd = numberIn(this.pressureEnd);
    return {
      contacts: this.contacts.checked,
      forces: this.forces.checked,
      pressure: this.pressures.checked,
      arrowLength: 2 ** Number(this.arrowLength.value),
      pressureEnd: pressureEnd !== null && pressureEnd > 0 ? 1000 * pressureEnd : null,
    };
  }

  private showScale(): void {
    const force = forceBar(this.world!.view.metresPerPixel() / this.world!.metresPerNewton);
    element("force-scale").querySelector("span")!.textContent = `${force.newtons} N`;
    element("force-scale").querySelector("i")!.style.width = `${force.pixels.toFixed(1)}px`;
    const { centimetres, pixels } = scaleBar(this.world!.view.metresPerPixel());
    element("scale").querySelector("span")!.textContent = `${centimetres} cm`;
    element("scale").querySelector("i")!.style.width = `${pixels.toFixed(1)}px`;
  }
}
