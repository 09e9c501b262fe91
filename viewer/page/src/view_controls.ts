import { cssRamp, PLASMA, VIRIDIS } from "./colour_map";
import { element } from "./elements";
import { insideNotes, materialRows, stressText } from "./material_legend";
import type { Scene } from "./protocol";
import { scaleBar } from "./scale_bar";
import type { Colouring } from "./soft_object";
import type { World } from "./world";

const LEGENDS: Record<Exclude<Colouring, "none" | "modulus">, { title: string; factor: number; unit: string }> = {
  displacement: { title: "Displacement", factor: 1000, unit: "mm" },
  velocity: { title: "Speed of the surface", factor: 100, unit: "cm/s" },
  compliance: { title: "Compliance: give per push", factor: 1000, unit: "mm/N" },
};

const MODULUS = "Young’s modulus";

/** How the picture is drawn: exaggeration, colours with their legend, wireframe, camera; and the scale. */
export class ViewControls {
  private readonly exaggeration = element<HTMLInputElement>("exaggeration");
  private readonly colour = element<HTMLSelectElement>("colour");
  private readonly rigid = element<HTMLInputElement>("rigid");
  private readonly contacts = element<HTMLInputElement>("contacts");
  private readonly follow = element<HTMLInputElement>("follow");

  constructor(private readonly world: World | null) {
    for (const input of [this.exaggeration, this.colour, this.rigid, this.contacts, this.follow]) {
      input.oninput = () => this.apply();
    }
    element("fit").onclick = () => world?.fit();
    document.querySelector<HTMLElement>("#legend .ramp")!.style.background = cssRamp(VIRIDIS);
    document.querySelector<HTMLElement>("#pressure .ramp")!.style.background = cssRamp(PLASMA);
    world?.onDraw.push(() => this.showScale());
    this.apply();
  }

  show(scene: Scene): void {
    const known = scene.objects.some((object) => object.compliance.some((value) => !Number.isNaN(value)));
    this.allow("compliance", known);
    this.allow("modulus", scene.objects.some((object) => object.regions !== null));
    const option = this.optionOf("modulus");
    option.textContent = option.disabled ? `${MODULUS} (no body has regions)` : MODULUS;
    if (this.world !== null) element("materials").replaceChildren(...materialRows(scene, this.world.modulusRange));
    element("materials-note").textContent = insideNotes(scene);
    this.apply();
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
    const { largest } = this.world.contacts;
    element("pressure").hidden = !this.contacts.checked || largest === 0;
    element("pressure-max").textContent = `${(largest / 1000).toPrecision(3)} kPa`;
    const { colouring } = this.world.look;
    if (colouring === "none") return;
    const { low, high } = this.world.colours;
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
    const colouring = this.colour.value as Colouring;
    element("legend").hidden = colouring === "none" || this.world === null;
    element("materials").hidden = element("materials-note").hidden = colouring !== "modulus";
    if (colouring === "modulus") element("legend-title").textContent = `${MODULUS}, logarithmic`;
    else if (colouring !== "none") element("legend-title").textContent = LEGENDS[colouring].title;
    if (this.world === null) return;
    this.world.look = {
      exaggeration: factor,
      colouring,
      rigid: this.rigid.checked,
      contacts: this.contacts.checked,
      follow: this.follow.checked,
    };
    this.world.applyLook();
    this.showLegend();
  }

  private showScale(): void {
    const { centimetres, pixels } = scaleBar(this.world!.metresPerPixel());
    element("scale").querySelector("span")!.textContent = `${centimetres} cm`;
    element("scale").querySelector("i")!.style.width = `${pixels.toFixed(1)}px`;
  }
}
