// How long the arrows of forces are drawn. Pure.

const FIRST_GUESS = 1; // largest force before one was seen [N]
const LEAST = 0.1; // largest force that is told from noise [N]
const HALF_LIFE = 3; // of a largest force that has not come again [s]

/** The greatest of 1, 2, 5 times a power of ten that is not above a positive value. */
export function roundBelow(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value * (1 + 1e-9)));
  const share = value / decade;
  return Number(((share >= 5 - 1e-9 ? 5 : share >= 2 - 1e-9 ? 2 : 1) * decade).toPrecision(1));
}

/**
 * Metres per newton so that the largest force of late has an arrow of at most the objects' radius. It is a round
 * number, which falls at once and rises after a while, so that arrows can be compared.
 */
export class ArrowScale {
  private largest = FIRST_GUESS;
  private time = Number.NaN;

  constructor(private readonly room = 0.1) {}

  get metresPerNewton(): number {
    return roundBelow(this.room / Math.max(this.largest, LEAST));
  }

  /** @param force largest one now [N] @param time of the run [s] */
  follow(force: number, time: number): void {
    const elapsed = Math.max(0, time - this.time) || 0;
    this.time = time;
    this.largest = Math.max(force, this.largest * 0.5 ** (elapsed / HALF_LIFE));
  }
}
