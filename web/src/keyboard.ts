/// Maps the keys of every keyboard layout, by what they type and by their place.

export type KeyPress = Pick<KeyboardEvent, "key" | "code" | "shiftKey">;

/// Characters of other places on a US keyboard.
const kPlaces: Record<string, string> = {
  Minus: "-", Equal: "=", Slash: "/", Space: " ", NumpadAdd: "+", NumpadSubtract: "-",
};
/// Names that browsers give to a key that types no character: a dead key, or one taken by an input method.
const kUnnamed = ["", "Dead", "Process", "Unidentified"];

/// The character at a place of a US keyboard.
function atPlace({ code, shiftKey }: KeyPress): string | null {
  const found = /^(?:Key([A-Z])|(?:Digit|Numpad)(\d))$/.exec(code);
  if (found !== null) return found[1]?.toLowerCase() ?? found[2]!;
  return code === "Slash" && shiftKey ? "?" : kPlaces[code] ?? null;
}

/// Whether a key is also known by its place, in addition to what it types.
function placeCounts(typed: string, place: string): boolean {
  if (/\d/.test(place)) return true; // digits need Shift on some layouts, and Num Lock on the keypad
  if ([...typed].length > 1) return false; // "Enter", "ArrowLeft"
  if (/\p{Script=Latin}/u.test(typed)) return false; // a Latin letter counts wherever its key is
  if (/[!-~]/.test(typed)) return /[a-z]/.test(place); // punctuation where a US keyboard has a letter
  return true; // Cyrillic, Greek, Hebrew, Arabic, …
}

/// The names of a key, most likely first: the character that it types, in lower case, or a name such as "Enter"; then
/// the character at its place on a US keyboard. The place counts for letters if the key types no Latin letter, and for
/// digits always.
export function namesOf(press: KeyPress): string[] {
  const place = atPlace(press);
  if (kUnnamed.includes(press.key)) return place === null ? [] : [place];
  // full-width letters count as Latin letters
  const typed = [...press.key].length === 1 ? press.key.normalize("NFKC").toLowerCase() : press.key;
  return place !== null && place !== typed && placeCounts(typed, place) ? [typed, place] : [typed];
}

/// The first name of a key that is in `keys`.
export function keyAmong<K extends string>(press: KeyPress, keys: readonly K[]): K | undefined {
  return namesOf(press).find((name): name is K => (keys as readonly string[]).includes(name));
}

/// The table's entry for a key.
export function entryOf<T>(press: KeyPress, table: Record<string, T>): T | undefined {
  const key = keyAmong(press, Object.keys(table));
  return key === undefined ? undefined : table[key];
}

/// Whether the key is a command of the browser or the system. AltGr, which only chooses a character, is Ctrl with Alt
/// on some systems.
export function isCommand(event: KeyboardEvent): boolean {
  return (event.ctrlKey || event.altKey || event.metaKey) && !event.getModifierState("AltGraph");
}

const kWithoutText = ["button", "checkbox", "color", "file", "image", "number", "radio", "range", "reset", "submit"];

/// Whether letters are entered as text there.
export function takesText(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return !kWithoutText.includes(target.type);
  return target instanceof HTMLTextAreaElement || (target instanceof HTMLElement && target.isContentEditable);
}
