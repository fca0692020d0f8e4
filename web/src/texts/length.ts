/** How far something is, as one says it: centimetres, from one metre on metres. */
export function lengthWords(metres: number, digits = 1): string {
  return metres < 1 ? `${(100 * metres).toFixed(digits)} cm` : `${metres.toFixed(1)} m`;
}
