// How the places of a slider, 0 to 1, stand for values. Pure.

export interface SliderScale {
  valueAt(place: number): number;
  placeOf(value: number): number;
}

/** Power 1: even; 2: finer near zero. */
export function fromZero(most: number, power: number): SliderScale {
  return {
    valueAt: (place) => rounded(most * place ** power),
    placeOf: (value) => cut(value / most) ** (1 / power),
  };
}

/** Each stretch of the slider is a factor. */
export function byFactor(least: number, most: number): SliderScale {
  const span = Math.log(most / least);
  return {
    valueAt: (place) => Math.min(Math.max(rounded(least * Math.exp(span * place)), least), most),
    placeOf: (value) => cut(Math.log(value / least) / span),
  };
}

function cut(place: number): number {
  return Math.min(Math.max(place, 0), 1);
}

/** To three digits: nobody means more by a slider. */
function rounded(value: number): number {
  return Number(value.toPrecision(3));
}
