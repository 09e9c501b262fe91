// What this browser remembers of its visits. Storage may be switched off: then every visit is the first.

const PREFIX = "irdm.";

export function remembered(name: string): string | null {
  try {
    return localStorage.getItem(PREFIX + name);
  } catch {
    return null;
  }
}

export function remember(name: string, value: string): void {
  try {
    localStorage.setItem(PREFIX + name, value);
  } catch {
    // It is forgotten.
  }
}
