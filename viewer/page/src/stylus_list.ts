import { make } from "./elements";
import { Contact, type Frame, type Scene } from "./protocol";

const CONTACTS: Record<Contact, string> = {
  [Contact.Free]: "free",
  [Contact.Touching]: "touching",
  [Contact.Held]: "held",
};

interface Row {
  name: string;
  button: HTMLButtonElement;
  beside: HTMLButtonElement;
  state: HTMLElement;
  force: HTMLElement;
}

/** The styluses with state and force; the chosen one is in the plot, and another one beside it where it is asked for. */
export class StylusList {
  chosen = 0;
  /** shown beside the chosen one; null: none */
  beside: number | null = null;
  private rows: Row[] = [];

  /** @param changed another one is chosen, or shown beside */
  constructor(
    private readonly host: HTMLElement,
    private readonly changed: () => void,
  ) {}

  show(scene: Scene): void {
    this.chosen = Math.min(this.chosen, scene.styluses.length - 1);
    this.beside = null;
    this.rows = scene.styluses.map((_, s) => this.row(s, scene.viewersStylus && s === scene.styluses.length - 1));
    this.host.replaceChildren(
      ...this.rows.map(({ button, beside }) => {
        const line = make("div", "", "line");
        line.append(button, beside);
        return line;
      }),
    );
    this.render();
  }

  nameOf(stylus: number): string {
    return this.rows[stylus]?.name ?? "";
  }

  chooseLast(): void {
    this.choose(this.rows.length - 1);
  }

  follow(frame: Frame): void {
    frame.styluses.forEach((stylus, s) => {
      const { state, force } = this.rows[s]!;
      const contact = stylus.contact === Contact.Touching && stylus.slips ? "slipping" : CONTACTS[stylus.contact];
      state.textContent = stylus.present ? contact : "absent";
      force.textContent = stylus.present ? Math.hypot(...stylus.force).toFixed(3) + " N" : "";
    });
  }

  private row(s: number, isViewers: boolean): Row {
    const name = isViewers ? "Mouse stylus" : `Stylus ${s + 1}`;
    const [button, beside] = [make("button", ""), make("button", "Beside")] as [HTMLButtonElement, HTMLButtonElement];
    button.type = beside.type = "button";
    const [state, force] = [make("span", "absent", "state"), make("span", "", "force")];
    button.append(make("span", name), state, force);
    button.onclick = () => this.choose(s);
    beside.className = "beside";
    beside.setAttribute("aria-label", `Beside: plot ${name} beside the chosen one`);
    beside.onclick = () => this.toggleBeside(s);
    return { name, button, beside, state, force };
  }

  /** The one beside it stays there, unless it is the one that is chosen now. */
  private choose(stylus: number): void {
    if (this.beside === stylus) this.beside = this.chosen;
    this.chosen = stylus;
    this.render();
    this.changed();
  }

  private toggleBeside(stylus: number): void {
    this.beside = this.beside === stylus ? null : stylus;
    this.render();
    this.changed();
  }

  private render(): void {
    this.rows.forEach(({ button, beside }, s) => {
      button.setAttribute("aria-pressed", String(s === this.chosen));
      beside.setAttribute("aria-pressed", String(s === this.beside));
      beside.hidden = this.rows.length < 2;
      beside.disabled = s === this.chosen;
    });
  }
}
