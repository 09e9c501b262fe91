import { make } from "./elements";
import { Contact, type BridgeHealth, type Frame, type Health, type Percentiles, type Scene } from "./protocol";

const CONTACTS: Record<Contact, string> = {
  [Contact.Free]: "free",
  [Contact.Touching]: "touching",
  [Contact.Held]: "held",
};

/** The styluses with state and force; the chosen one is the one that the curves show. */
export class StylusList {
  chosen = 0;
  private rows: { button: HTMLButtonElement; state: HTMLElement; force: HTMLElement }[] = [];

  constructor(private readonly host: HTMLElement) {}

  show(scene: Scene): void {
    this.chosen = Math.min(this.chosen, scene.styluses.length - 1);
    this.rows = scene.styluses.map((_, s) => {
      const button = document.createElement("button");
      button.type = "button";
      const [state, force] = [make("span", "absent", "state"), make("span", "", "force")];
      const isViewers = scene.viewersStylus && s === scene.styluses.length - 1;
      button.append(make("span", isViewers ? "Mouse stylus" : `Stylus ${s + 1}`), state, force);
      button.onclick = () => this.choose(s);
      return { button, state, force };
    });
    this.host.replaceChildren(...this.rows.map((row) => row.button));
    this.choose(this.chosen);
  }

  chooseLast(): void {
    this.choose(this.rows.length - 1);
  }

  private choose(stylus: number): void {
    this.chosen = stylus;
    this.rows.forEach((row, s) => row.button.setAttribute("aria-pressed", String(s === stylus)));
  }

  follow(frame: Frame): void {
    frame.styluses.forEach((stylus, s) => {
      const { state, force } = this.rows[s]!;
      const contact = stylus.contact === Contact.Touching && stylus.slips ? "slipping" : CONTACTS[stylus.contact];
      state.textContent = stylus.present ? contact : "absent";
      force.textContent = stylus.present ? Math.hypot(...stylus.force).toFixed(3) + " N" : "";
    });
  }
}

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
