import { make } from "./elements";
import type { BridgeHealth, Health, Percentiles } from "./protocol";

function microseconds(value: number): string {
  if (Number.isNaN(value)) return "–";
  if (value < 1000) return value.toFixed(value < 100 ? 1 : 0) + " µs";
  return (value / 1000).toFixed(1) + " ms";
}

const UNKNOWN: Percentiles = { p50: Number.NaN, p99: Number.NaN, max: Number.NaN };

/** What the bridges told. With several, their styluses are named. */
function bridgeRows(bridges: BridgeHealth[]): HTMLElement[] {
  return bridges.flatMap(({ reports, roundTrip, forceAge }, s) => {
    const whose = bridges.length > 1 ? ` ${s + 1}` : "";
    return [
      percentileRow(`Round trip${whose}`, reports ? roundTrip : UNKNOWN),
      percentileRow(`Age of force${whose}`, reports ? forceAge : UNKNOWN),
    ];
  });
}

function percentileRow(name: string, value: Percentiles): HTMLElement {
  const row = document.createElement("tr");
  const title = make("th", name);
  title.setAttribute("scope", "row");
  row.append(title, ...[value.p50, value.p99, value.max].map((part) => make("td", microseconds(part))));
  return row;
}

/** How the run goes. What ought to be zero and is not, stands out. */
export class HealthPanel {
  private before: { health: Health; at: number } | null = null;

  constructor(
    private readonly table: HTMLElement,
    private readonly counts: HTMLElement,
  ) {}

  show(health: Health, now: number): void {
    this.table.querySelector("tbody")!.replaceChildren(
      percentileRow("Force step", health.stepTime),
      percentileRow("Wake-up", health.wakeupDelay),
      ...bridgeRows(health.bridges),
    );
    const seconds = this.before === null ? Number.NaN : (now - this.before.at) / 1000;
    const rate = (key: "samples" | "forces"): string => {
      const value = (health[key] - (this.before?.health[key] ?? 0)) / seconds;
      return Number.isFinite(value) ? `${Math.max(0, Math.round(value))} /s` : "–";
    };
    const fault = (count: number): [string, boolean] => [count.toLocaleString("en"), count > 0];
    const rows: [string, string, boolean][] = [
      ["Missed deadlines", ...fault(health.missed)],
      ["Steps without solution", ...fault(health.unsolved)],
      ["Surfaces", `${health.surfaceRate.toFixed(0)} /s`, false],
      ["Steps not in the surface", ...fault(health.lostSteps)],
      ["Samples from bridges", rate("samples"), false],
      ["Forces to bridges", rate("forces"), false],
      ["Resets", `${health.resets} ×`, false],
      ["Viewers", String(health.viewers), false],
    ];
    this.counts.replaceChildren(
      ...rows.map(([name, value, bad]) => {
        const row = make("div", "", bad ? "bad" : "");
        row.append(make("dt", name), make("dd", value));
        return row;
      }),
    );
    this.before = { health, at: now };
  }
}
