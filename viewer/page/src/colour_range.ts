import { element } from "./elements";
import type { Span } from "./regions";
import type { Colouring } from "./soft_object";

/** Ends of the colours' range that are set by hand; an empty one follows what is shown. */
export interface SetRange {
  low: number | null;
  high: number | null;
}

export const AUTOMATIC: SetRange = { low: null, high: null };

/** Pure. */
export function rangeAsSet({ low, high }: Span, set: SetRange): Span {
  return { low: set.low ?? low, high: set.high ?? high };
}

/** A field for a number. @returns null when it is empty or no number */
export function numberIn(field: HTMLInputElement): number | null {
  return field.value === "" || !Number.isFinite(field.valueAsNumber) ? null : field.valueAsNumber;
}

/** Two fields for the ends of the range; each colouring has its own. */
export class RangeFields {
  private readonly row = element("range");
  private readonly low = element<HTMLInputElement>("range-low");
  private readonly high = element<HTMLInputElement>("range-high");
  private readonly set = new Map<Colouring, SetRange>();
  private colouring: Colouring = "none";
  private factor = 1;

  constructor(changed: () => void) {
    for (const field of [this.low, this.high]) {
      field.oninput = () => {
        this.take();
        changed();
      };
    }
  }

  /** @param factor from SI to the unit; null: its range cannot be set */
  show(colouring: Colouring, factor: number | null, unit: string): void {
    this.row.hidden = factor === null;
    if (factor === null || colouring === this.colouring) return;
    this.colouring = colouring;
    this.factor = factor;
    const { low, high } = this.of(colouring);
    this.low.value = low === null ? "" : String(low * factor);
    this.high.value = high === null ? "" : String(high * factor);
    element("range-unit").textContent = unit;
  }

  of(colouring: Colouring): SetRange {
    return this.set.get(colouring) ?? AUTOMATIC;
  }

  private take(): void {
    const inSi = (value: number | null): number | null => (value === null ? null : value / this.factor);
    const set = { low: inSi(numberIn(this.low)), high: inSi(numberIn(this.high)) };
    const wrong = set.low !== null && set.high !== null && set.low >= set.high;
    for (const field of [this.low, this.high]) field.setAttribute("aria-invalid", String(wrong));
    this.set.set(this.colouring, wrong ? AUTOMATIC : set);
  }
}
