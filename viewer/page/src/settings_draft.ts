import type { ObjectSettings, Settings } from "./protocol";

const HELD_MS = 700; // in which a change has come back from the server

type Change = (settings: Settings) => void;

/**
 * The server's settings with the changes on top that are still on their way to it, so that a slider stays under
 * the hand. What has not come back in time was not taken, and is forgotten. Pure; times in ms.
 */
export class SettingsDraft {
  private readonly changes = new Map<string, { change: Change; at: number }>();

  constructor(public confirmed: Settings) {}

  /** @param name of what is changed: a later change of the same replaces this one */
  change(name: string, change: Change, now: number): void {
    this.changes.set(name, { change, at: now });
  }

  changeObject<Key extends keyof ObjectSettings>(object: number, key: Key, value: ObjectSettings[Key], now: number): void {
    this.change(`${object}.${key}`, (settings) => (settings.objects[object]![key] = value), now);
  }

  /** Has every change come back or been forgotten? */
  settled(now: number): boolean {
    this.forget(now);
    return this.changes.size === 0;
  }

  /** As the server should have them. */
  values(now: number): Settings {
    this.forget(now);
    const values = copyOf(this.confirmed);
    for (const { change } of this.changes.values()) change(values);
    for (const object of values.objects) object.kineticFriction = Math.min(object.kineticFriction, object.staticFriction);
    return values;
  }

  private forget(now: number): void {
    for (const [name, { at }] of this.changes) if (now - at > HELD_MS) this.changes.delete(name);
  }
}

function copyOf(settings: Settings): Settings {
  return { gravity: settings.gravity, objects: settings.objects.map((object) => ({ ...object })) };
}
