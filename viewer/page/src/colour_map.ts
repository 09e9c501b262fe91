/** Colours at even steps, sRGB, 0 to 255. */
export type Ramp = readonly (readonly [number, number, number])[];

// Viridis and plasma, sampled: even steps look like even steps, also to the colour-blind and in grey.
export const VIRIDIS: Ramp = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

/** For what is drawn on surfaces that can have the other's colours. */
export const PLASMA: Ramp = [
  [13, 8, 135],
  [76, 2, 161],
  [126, 3, 168],
  [169, 35, 149],
  [204, 70, 120],
  [229, 107, 93],
  [248, 148, 65],
  [253, 195, 40],
  [240, 249, 33],
];

/** @param at 0 to 1, beyond it is cut; writes r, g, b (0 to 1, sRGB) */
export function colourAt(ramp: Ramp, at: number, into: Float32Array, offset: number): void {
  const x = Math.min(Math.max(at, 0), 1) * (ramp.length - 1);
  const i = Math.min(Math.floor(x), ramp.length - 2);
  const part = x - i;
  for (let c = 0; c < 3; ++c) into[offset + c] = (ramp[i]![c]! * (1 - part) + ramp[i + 1]![c]! * part) / 255;
}

/** Where a value is between the ends of a logarithmic ramp, 0 to 1. All are positive. */
export function logarithmic(value: number, { low, high }: { low: number; high: number }): number {
  return high > low ? Math.log(value / low) / Math.log(high / low) : 0;
}

/** A part of a ramp from left to right. @param from, to 0 to 1 */
export function cssPart(ramp: Ramp, from: number, to: number): string {
  const steps = 4;
  const colour = new Float32Array(3);
  const stops = Array.from({ length: steps + 1 }, (_, i) => {
    colourAt(ramp, from + ((to - from) * i) / steps, colour, 0);
    return `rgb(${[...colour].map((part) => Math.round(255 * part)).join(" ")})`;
  });
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

export function cssRamp(ramp: Ramp): string {
  return `linear-gradient(to right, ${ramp.map((stop) => `rgb(${stop.join(" ")})`).join(", ")})`;
}

/** sRGB to linear, as three.js wants vertex colours. */
export function linear(value: number): number {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

const UNKNOWN: readonly [number, number, number] = [0.5, 0.5, 0.5];

/** Writes what stands for a value on the ramp, linear. @param share of the ramp, 0 to 1; NaN: the value is not known */
export function paintShare(share: number, into: Float32Array, offset: number): void {
  if (Number.isNaN(share)) into.set(UNKNOWN, offset);
  else colourAt(VIRIDIS, share, into, offset);
  for (let c = offset; c < offset + 3; ++c) into[c] = linear(into[c]!);
}
