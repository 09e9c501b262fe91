import { make } from "./elements";

const HINT_MS = 5000;
const TOLD_MS = 12_000;

/** Short messages over the picture, which go by themselves; read out by screen readers. */
export class Notices {
  constructor(private readonly host: HTMLElement) {}

  /** The same text is shown once at a time. */
  hint(text: string): void {
    const note = this.add(text);
    note.classList.add("passing");
    setTimeout(() => note.remove(), HINT_MS);
  }

  /** Stays longer, and while the pointer or the focus is on it. */
  tell(text: string): void {
    const note = this.add(text);
    let timer = 0;
    const leave = (): void => {
      clearTimeout(timer);
      timer = window.setTimeout(() => note.remove(), TOLD_MS);
    };
    const stay = (): void => clearTimeout(timer);
    for (const begin of ["pointerenter", "focusin"]) note.addEventListener(begin, stay);
    for (const end of ["pointerleave", "focusout"]) note.addEventListener(end, leave);
    leave();
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
