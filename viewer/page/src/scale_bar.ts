const STEPS_CM = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500];
const WIDEST_PX = 130;

/** The longest round length that fits. Pure. @returns its length [cm] and width [px] */
export function scaleBar(metresPerPixel: number): { centimetres: number; pixels: number } {
  const widest = WIDEST_PX * metresPerPixel * 100;
  const centimetres = STEPS_CM.filter((step) => step <= widest).at(-1) ?? STEPS_CM[0]!;
  return { centimetres, pixels: centimetres / 100 / metresPerPixel };
}
