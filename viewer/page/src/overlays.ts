/** What is drawn over the objects of their contacts, and how large. */
export interface Overlays {
  /** marks where styluses and bodies touch, springs between tip and surface */
  contacts: boolean;
  /** arrows of forces */
  forces: boolean;
  /** colours of the patches of bodies that touch */
  pressure: boolean;
  /** factor of the arrows' length */
  arrowLength: number;
  /** pressure at the ramp's end [Pa]; null: the largest of late */
  pressureEnd: number | null;
}

export const ALL_OVERLAYS: Overlays = { contacts: true, forces: true, pressure: true, arrowLength: 1, pressureEnd: null };
