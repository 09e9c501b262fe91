import uPlot from "uplot";
import type { ForceLog } from "./force_log";
import type { Theme } from "./theme";

const WINDOW_SECONDS = 5;
const NAMES = ["x", "y", "z", "|F|"];

/** Curves of some seconds, which can be zoomed by dragging. */
export class ForcePlot {
  private plot: uPlot | null = null;
  private data: uPlot.AlignedData = [[], [], [], [], []];

  constructor(
    private readonly host: HTMLElement,
    private theme: Theme,
  ) {
    this.build();
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(host);
  }

  /** The forces of the last seconds; they are seen when they are drawn. */
  take(log: ForceLog, stylus: number, now: number): void {
    this.data = log.since(now - WINDOW_SECONDS, stylus) as uPlot.AlignedData;
  }

  /** Least and greatest value of the curves. */
  extent(): Range {
    const curves = this.data.slice(1) as (number | null)[][];
    return union(curves.map((curve) => curve.reduce<Range>(([low, high], value) => [Math.min(low, value ?? low), Math.max(high, value ?? high)], [0, 0])));
  }

  /** @param range of the axis of forces; null: that of the curves */
  draw(now: number, range: Range | null): void {
    this.range = range;
    this.plot?.setData(this.data, false);
    // The legend says the newest, unless it is asked for another time.
    if ((this.plot?.cursor.left ?? 0) < 0 && this.data[0].length > 0) this.plot?.setLegend({ idx: this.data[0].length - 1 }, false);
    this.plot?.setScale("x", { min: Math.max(now, WINDOW_SECONDS) - WINDOW_SECONDS, max: Math.max(now, WINDOW_SECONDS) });
  }
  private range: Range | null = null;

  applyTheme(theme: Theme): void {
    this.theme = theme;
    this.build();
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(160, this.host.clientWidth), height: 190 };
  }

  private build(): void {
    this.plot?.destroy();
    const { axes, ink, inkSoft, line } = this.theme;
    const font = "12px system-ui, sans-serif"; // whole pixels: uPlot enlarges no others on fine screens
    const axis = { stroke: inkSoft, font, grid: { stroke: line, width: 1 }, ticks: { show: false } };
    const curve = (label: string, stroke: string, width: number): uPlot.Series => ({
      label,
      stroke,
      width,
      points: { show: false },
      value: (_, value) => (value === null ? "–" : value.toFixed(3)),
    });
    this.plot = new uPlot(
      {
        ...this.size(),
        cursor: { drag: { x: true, y: false }, points: { size: 6 } },
        legend: { live: true, markers: { width: 0, fill: (_, i) => [...axes, ink][i - 1] ?? "" } },
        scales: {
          x: { time: false },
          y: { range: (_, low, high) => (this.range === null ? padded(low, high) : padded(...this.range)) },
        },
        axes: [
          { ...axis, size: 30, gap: 6, values: (_, ticks) => ticks.map((tick) => tick + " s") },
          { ...axis, size: 46, gap: 4, values: (_, ticks) => ticks.map((tick) => tick + " N") },
        ],
        series: [
          { label: "t", value: (_, value) => (value === null ? "–" : value.toFixed(3) + " s") },
          ...axes.map((colour, i) => curve(NAMES[i]!, colour, 1.25)),
          // Dashed, so that a component that it equals is seen below it.
          { ...curve(NAMES[3]!, ink, 1.5), dash: [6, 4] },
        ],
      },
      this.data,
      this.host,
    );
  }

  get canvas(): HTMLCanvasElement {
    return this.plot!.ctx.canvas;
  }
}

export type Range = [number, number];

export function union(ranges: Range[]): Range {
  return [Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))];
}

/** With room above and below; a force of nothing is a straight line, not noise drawn large. */
function padded(low: number | null, high: number | null): [number, number] {
  const least = 0.1;
  const top = Math.max(high ?? 0, 0);
  const bottom = Math.min(low ?? 0, 0);
  const room = Math.max(0.08 * (top - bottom), least / 2);
  return [bottom === 0 ? -0.2 * room : bottom - room, top + room];
}
