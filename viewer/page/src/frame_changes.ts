// Whether two frames look the same, so that a scene at rest is not drawn again and again. Pure.
import type { BodyContact, Frame, ObjectState, StylusState } from "./protocol";

function sameNumbers(a: ArrayLike<number>, b: ArrayLike<number>): boolean {
  if (a.length !== b.length) return false;
  for (let i = 0; i < a.length; ++i) if (!Object.is(a[i], b[i])) return false;
  return true;
}

function sameObject(a: ObjectState, b: ObjectState): boolean {
  if (a.unit !== b.unit || !sameNumbers(a.position, b.position)) return false;
  return sameNumbers(a.orientation, b.orientation) && sameNumbers(a.displacement, b.displacement);
}

function sameStylus(a: StylusState, b: StylusState): boolean {
  if (!a.present && !b.present) return true;
  if (a.present !== b.present || a.contact !== b.contact || a.object !== b.object) return false;
  return (["tip", "proxy", "force", "middle"] as const).every((key) => sameNumbers(a[key], b[key]));
}

function sameContact(a: BodyContact, b: BodyContact): boolean {
  if (a.object !== b.object || a.other !== b.other || a.area !== b.area) return false;
  return (["normal", "position", "force"] as const).every((key) => sameNumbers(a[key], b[key]));
}

export function looksTheSame(a: Frame, b: Frame): boolean {
  return (
    a.contacts.length === b.contacts.length &&
    a.styluses.every((state, s) => sameStylus(state, b.styluses[s]!)) &&
    a.contacts.every((contact, i) => sameContact(contact, b.contacts[i]!)) &&
    a.objects.every((state, i) => sameObject(state, b.objects[i]!))
  );
}
