const NOT_WHILE_TYPING = "input[type=text], textarea, select";
const PRESSES_BY_SPACE = "button, summary, input, select, a";

/**
 * Single keys for the whole page, and some more while the picture has the focus.
 * @param anywhere by name in small letters
 */
export function listenForShortcuts(anywhere: Record<string, () => void>, onPicture: Record<string, () => void>): void {
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const target = event.target as HTMLElement;
    if (target.matches(NOT_WHILE_TYPING)) return;
    if (event.key === " " && target.matches(PRESSES_BY_SPACE)) return;
    const free = target === document.body || target.id === "scene";
    const action = anywhere[event.key.toLowerCase()] ?? (free ? onPicture[event.key] : undefined);
    if (action === undefined) return;
    event.preventDefault();
    action();
  });
}
