/// Values that the browser stores between visits.

export function remembered(key: string): string | null {
  try {
    return localStorage.getItem(`prostm-${key}`);
  } catch {
    return null; // storage may be forbidden; then nothing is stored
  }
}

export function remember(key: string, value: string): void {
  try {
    localStorage.setItem(`prostm-${key}`, value);
  } catch {
    // as above
  }
}
