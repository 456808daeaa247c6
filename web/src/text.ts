/// Numbers as text.

export function fixed(value: number, digits: number): string {
  return Number.isFinite(value) ? value.toFixed(digits) : "–";
}

/// A length in whole millimetres.
export function millimetres(metres: number): string {
  const mm = Math.round(1000 * metres);
  return `${mm < 0 ? "−" : ""}${Math.abs(mm)}`;
}

/// With as many digits as are significant.
export function short(value: number): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  return value.toFixed(size >= 100 || Number.isInteger(value) ? 0 : size >= 10 ? 1 : 2);
}
