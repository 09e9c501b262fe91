import { roundBelow } from "./arrow_scale";

const LEAST_CM = 0.01;
const MOST_CM = 500;
const WIDEST_PX = 130;

/** The longest round length that fits. Pure. @returns its length [cm] and width [px] */
export function scaleBar(metresPerPixel: number): { centimetres: number; pixels: number } {
  const widest = WIDEST_PX * metresPerPixel * 100;
  const centimetres = Math.min(Math.max(roundBelow(widest), LEAST_CM), MOST_CM);
  return { centimetres, pixels: centimetres / 100 / metresPerPixel };
}

/** The greatest round force whose arrow fits. Pure. @returns it [N] and its arrow's length [px] */
export function forceBar(newtonsPerPixel: number): { newtons: number; pixels: number } {
  const newtons = roundBelow(WIDEST_PX * newtonsPerPixel);
  return { newtons, pixels: newtons / newtonsPerPixel };
}
