import { element } from "./elements";

export type Tool = "push" | "grab";

/** What a press does: the tool that is chosen, or Grab for as long as something like Shift asks for it. */
export class ToolChoice {
  private readonly stage = element("stage");
  private asks = false;

  constructor() {
    for (const input of document.querySelectorAll<HTMLInputElement>("input[name=tool]")) {
      input.addEventListener("change", () => this.light());
    }
    this.light();
  }

  get grabs(): boolean {
    return document.querySelector<HTMLInputElement>("input[name=tool][value=grab]")!.checked;
  }

  /** The tool lit is the one that works. @param asks Shift, G or a second finger is down */
  grabMeanwhile(asks: boolean): void {
    this.asks = asks;
    this.light();
  }

  private light(): void {
    const tool: Tool = this.grabs || this.asks ? "grab" : "push";
    this.stage.dataset["tool"] = tool;
  }
}
