/** Returns a number with so many digits after the point, and never a negative zero. */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

/** Returns a number for people: with three digits after the point as long as these say something. */
export function numberText(value: number | null | undefined): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size >= 1e6 || (size < 5e-4 && size >= 1e-9)) return value.toExponential(2);
  return fixed(value, 3);
}

/** Returns a unit behind a number; nothing for numbers without unit. */
export const unitAfter = (unit: string): string => (unit === "1" || unit === "" ? "" : ` ${unit}`);
