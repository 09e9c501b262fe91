import { cssPart, logarithmic, VIRIDIS } from "./colour_map";
import { make } from "./elements";
import type { Scene, SceneObject } from "./protocol";
import type { Region, Span } from "./regions";

const UNITS: readonly (readonly [number, string])[] = [
  [1e9, "GPa"],
  [1e6, "MPa"],
  [1e3, "kPa"],
  [1, "Pa"],
];

/** Three digits, without a unit. */
function short(value: number): string {
  return String(Number(value.toPrecision(3)));
}

function textOf({ low, high }: Span, factor = 1): string {
  const [from, to] = [short(low / factor), short(high / factor)];
  return from === to ? to : `${from} to ${to}`;
}

/** "3.25 to 42.5 kPa" */
export function stressText(span: Span): string {
  const [factor, unit] = UNITS.find(([size]) => span.high >= size) ?? UNITS.at(-1)!;
  return `${textOf(span, factor)}\u00a0${unit}`;
}

function nameOf(region: Region, { name }: SceneObject, alone: boolean): string {
  const own = region.number === 0 ? "outside the regions" : `region ${region.number}`;
  return alone ? own : `${name}, ${own}`;
}

function row(name: string, modulus: Span, others: string, range: Span): HTMLElement {
  const line = make("li", "");
  const swatch = make("i", "");
  swatch.setAttribute("aria-hidden", "true");
  swatch.style.background = cssPart(VIRIDIS, logarithmic(modulus.low, range), logarithmic(modulus.high, range));
  line.append(swatch, make("b", name), make("span", stressText(modulus) + others));
  return line;
}

/**
 * What each region of the objects is made of.
 * @param range of Young's moduli [Pa] at both ends of the ramp
 */
export function materialRows(scene: Scene, range: Span): HTMLElement[] {
  const alone = scene.objects.length === 1;
  return scene.objects.flatMap((object) => {
    if (object.regions === null) {
      const modulus = { low: object.stiffness, high: object.stiffness };
      return object.stiffness > 0 ? [row(object.name, modulus, "", range)] : [];
    }
    return object.regions.list.map((region) => {
      const others = `, ν\u00a0${textOf(region.poissonRatio)}, ${textOf(region.density)}\u00a0kg/m³`;
      return row(nameOf(region, object, alone), region.youngsModulus, others, range);
    });
  });
}

/** What a viewer has to know of what is drawn inside the objects. */
export function insideNotes(scene: Scene): string {
  const notes: string[] = [];
  const regions = scene.objects.flatMap((object) => object.regions ?? []);
  if (regions.some(({ faces }) => faces.length > 0)) notes.push("What is inside moves with the body, but is drawn undeformed.");
  for (const { name, regions } of scene.objects) {
    if (regions?.facesLeftOut) notes.push(`${name}: too many faces inside to be drawn.`);
    if (regions?.someUnlisted) notes.push(`${name}: further regions are not listed.`);
  }
  return notes.join(" ");
}
