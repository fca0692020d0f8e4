/** The open field: how far it reaches, and how it comes along with the avatar. Metres. */

/** Side of the field's pattern: squares of two tones. */
export const FIELD_TILE = 10;
/** From here on things dissolve in the haze, and from there on there is haze alone. */
export const HAZE: readonly [from: number, to: number] = [10, 42];
/** The field reaches so far from its middle: beyond the haze from wherever the avatar is. */
export const FIELD_REACH = 9 * FIELD_TILE;

/** Where the field's middle lies along an axis when the avatar is at `v`: whole tiles, so that its lines stay in place. */
export function fieldMiddle(v: number): number {
  return Math.round(v / FIELD_TILE) * FIELD_TILE;
}
