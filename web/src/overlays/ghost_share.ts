/** How strong a ghost of a planned key frame is drawn, by its distance from the avatar. */

const TOUCHES = 0.15;
const STANDS_APART = 0.7;
const FAR = 3.2;
const WEAKEST = 0.3;

/** 0 where the ghost would stand inside the avatar, 1 where it stands apart, weaker again far ahead. Metres. */
export function ghostShare(distance: number): number {
  return smooth(TOUCHES, STANDS_APART, distance) * (1 - (1 - WEAKEST) * smooth(STANDS_APART, FAR, distance));
}

function smooth(low: number, high: number, value: number): number {
  const share = Math.min(1, Math.max(0, (value - low) / (high - low)));
  return share * share * (3 - 2 * share);
}
