// SPDX-License-Identifier: Apache-2.0

/** Returns a number with this many decimals, and never a negative zero. */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

/** Returns a number as text for the user: with three decimals as long as these are significant. */
export function numberText(value: number | null | undefined): string {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size >= 1e6 || (size < 5e-4 && size >= 1e-9)) return value.toExponential(2);
  return fixed(value, 3);
}

/** Returns the text of a unit after a number; empty for numbers without a unit. */
export const unitAfter = (unit: string): string => (unit === "1" || unit === "" ? "" : ` ${unit}`);
