/** The colours of the style sheet, for what is drawn on a canvas. */
export interface Theme {
  dark: boolean;
  ink: string;
  inkSoft: string;
  line: string;
  surface: string;
  /** behind the picture */
  ground: string;
  accent: string;
  object: string;
  scenery: string;
  wire: string;
  force: string;
  axes: [string, string, string];
}

const dark = matchMedia("(prefers-color-scheme: dark)");

export function currentTheme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string): string => style.getPropertyValue("--" + name).trim();
  return {
    dark: dark.matches,
    ink: colour("ink"),
    inkSoft: colour("ink-soft"),
    line: colour("line"),
    surface: colour("surface"),
    ground: colour("ground"),
    accent: colour("accent"),
    object: colour("object"),
    scenery: colour("scenery"),
    wire: colour("wire"),
    force: colour("force"),
    axes: [colour("x"), colour("y"), colour("z")],
  };
}

export function onThemeChange(call: () => void): void {
  dark.addEventListener("change", call);
}
