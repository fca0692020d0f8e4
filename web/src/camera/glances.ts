/**
 * How far one sees past triangles in the directions from which a camera might look.
 *
 * A ray through a place of many triangles is dear. So but two are sent in a picture, and what each found holds until its
 * turn comes again.
 */

/** Rays that are sent in a picture. */
const AT_ONCE = 2;
/** Pictures for which a look holds; after so many it is forgotten, for the avatar has gone elsewhere. */
const HOLDS = 24;
const FORGOTTEN = 90;

interface Glance {
  readonly distance: number;
  readonly picture: number;
}

export class Glances {
  private readonly found = new Map<string, Glance>();
  private picture = 0;
  private left = AT_ONCE;

  /** The next picture. */
  next(): void {
    this.picture++;
    this.left = AT_ONCE;
  }

  /** Metres that one sees in a direction, told by a name, by the last look there; 0 where nobody has looked yet. */
  at(name: string, look: () => number): number {
    const known = this.found.get(name);
    const age = known ? this.picture - known.picture : Infinity;
    if (age < HOLDS || this.left === 0) return known && age < FORGOTTEN ? known.distance : 0;
    this.left--;
    const distance = look();
    this.found.set(name, { distance, picture: this.picture });
    return distance;
  }
}
