import { make } from "./elements";

const HINT_MS = 5000;

/** Short messages over the picture, each to be sent away; read out by screen readers. */
export class Notices {
  constructor(private readonly host: HTMLElement) {}

  /** Goes by itself. The same text is shown once at a time. */
  hint(text: string): void {
    const note = this.add(text);
    note.classList.add("passing");
    setTimeout(() => note.remove(), HINT_MS);
  }

  /** Stays until somebody has read it. */
  tell(text: string): void {
    this.add(text);
  }

  private add(text: string): HTMLElement {
    for (const old of [...this.host.children]) {
      if (old.firstChild?.textContent === text) old.remove();
    }
    const note = make("div", "", "note");
    const close = make("button", "×") as HTMLButtonElement;
    close.type = "button";
    close.setAttribute("aria-label", "Dismiss");
    close.onclick = () => note.remove();
    note.append(make("p", text), close);
    this.host.append(note);
    while (this.host.children.length > 3) this.host.firstElementChild!.remove();
    return note;
  }
}
