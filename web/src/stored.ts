/// The values that this browser keeps from one visit to the next.

export function remembered(key: string): string | null {
  try {
    return localStorage.getItem(`prostm-${key}`);
  } catch {
    return null; // storage may be forbidden; then nothing is kept
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`prostm-${key}`, value);
  } catch {
    // as above
  }
}
