import { rangeAsSet, type SetRange } from "./colour_range";
import type { Span } from "./regions";
import type { Colouring, SoftObject } from "./soft_object";

const NOTHING: Span = { low: 0, high: 0 };
const SLOWLY = 0.995; // a surface

/** Values at the ends of the colours of all objects. */
export class RampRange {
  ends: Span = NOTHING;
  private largest = 0;

  restart(): void {
    this.ends = NOTHING;
    this.largest = 0;
  }

  /** The ramp's end follows upwards at once and downwards slowly, so that colours can be compared. */
  follow(objects: readonly SoftObject[], colouring: Colouring, set: SetRange): void {
    if (colouring === "compliance") {
      this.ends = rangeAsSet(spanOfAll(objects.flatMap((object) => object.complianceRange ?? [])), set);
    } else if (colouring === "modulus") {
      this.ends = modulusSpan(objects);
    } else {
      this.largest = Math.max(...objects.map((object) => object.largest), SLOWLY * this.largest);
      this.ends = rangeAsSet({ low: 0, high: this.largest }, set);
    }
  }
}

/** Of all objects that are soft [Pa]. */
export function modulusSpan(objects: readonly SoftObject[]): Span {
  return spanOfAll(objects.flatMap((object) => object.modulusRange ?? []));
}

function spanOfAll(spans: Span[]): Span {
  return { low: Math.min(...spans.map(({ low }) => low)), high: Math.max(...spans.map(({ high }) => high)) };
}
