import { describe, expect, it } from "vitest";
import { entryOf, keyAmong, namesOf, type KeyPress } from "../../src/keyboard";

const press = (key: string, code: string, shiftKey = false): KeyPress => ({ key, code, shiftKey });

describe("a letter's key", () => {
  it.each([
    ["US", "m"], ["CapsLock", "M"], ["Russian", "ь"], ["Russian, CapsLock", "Ь"], ["Greek", "μ"], ["Greek, CapsLock", "Μ"],
    ["Hebrew", "צ"], ["Arabic", "ة"], ["Thai", "ท"], ["Korean", "ㅡ"], ["Georgian", "მ"], ["Armenian", "ք"],
    ["Hindi, a sign", "ं"], ["AltGr", "µ"], ["full width", "ｍ"], ["a dead key", "Dead"], ["an input method", "Process"],
    ["unknown", "Unidentified"],
  ])("is found on %s keyboards", (_, key) => {
    expect(keyAmong(press(key, "KeyM"), ["y", "m"])).toBe("m");
  });
  it("is at its letter on keyboards with another Latin layout", () => {
    expect(keyAmong(press("m", "Semicolon"), ["m"])).toBe("m"); // AZERTY
    expect(keyAmong(press("y", "KeyZ"), ["y", "z"])).toBe("y"); // QWERTZ
    expect(keyAmong(press("z", "KeyY"), ["y"])).toBeUndefined();
    expect(keyAmong(press("a", "KeyQ"), ["q"])).toBeUndefined(); // AZERTY
    expect(keyAmong(press("b", "KeyN"), ["n"])).toBeUndefined(); // Dvorak
    expect(keyAmong(press("ı", "KeyI"), ["i"])).toBeUndefined(); // Turkish
  });
  it("yields to a character that is itself a key", () => {
    expect(keyAmong(press("?", "KeyM", true), ["m", "?"])).toBe("?"); // AZERTY
    expect(keyAmong(press("/", "KeyQ"), ["q"])).toBe("q"); // Hebrew
    expect(keyAmong(press(";", "KeyQ"), ["q"])).toBe("q"); // Greek
  });
  it("needs no place", () => {
    expect(namesOf(press("m", ""))).toEqual(["m"]);
    expect(namesOf(press("ь", ""))).toEqual(["ь"]);
    expect(namesOf(press("", ""))).toEqual([]);
  });
});

describe("a digit's key", () => {
  it.each([
    ["US", "1", "Digit1"], ["AZERTY", "&", "Digit1"], ["Czech", "+", "Digit1"], ["Lithuanian", "ą", "Digit1"], ["Shift", "!", "Digit1"],
    ["Arabic", "١", "Digit1"], ["keypad", "1", "Numpad1"], ["keypad without Num Lock", "End", "Numpad1"], ["full width", "１", "Digit1"],
    ["Thai", "ๅ", "Digit1"], ["dead", "Dead", "Digit1"],
  ])("is found on %s keyboards", (_, key, code) => {
    expect(keyAmong(press(key, code), ["1", "2"])).toBe("1");
  });
  it("yields to the character that it types", () => {
    expect(keyAmong(press("+", "Digit1"), ["1", "+"])).toBe("+"); // Czech
    expect(keyAmong(press("ArrowLeft", "Numpad4"), ["4", "ArrowLeft"])).toBe("ArrowLeft");
  });
});

describe("other keys", () => {
  it("are known by their names", () => {
    expect(namesOf(press("ArrowLeft", "ArrowLeft"))).toEqual(["ArrowLeft"]);
    expect(namesOf(press("Enter", "NumpadEnter"))).toEqual(["Enter"]);
    expect(namesOf(press("Escape", "Escape"))).toEqual(["Escape"]);
  });
  it("are known by their places if they type another script", () => {
    expect(keyAmong(press("؟", "Slash", true), ["?"])).toBe("?");
    expect(keyAmong(press("ข", "Minus"), ["-"])).toBe("-");
    expect(keyAmong(press("\u00a0", "Space", true), [" "])).toBe(" ");
    expect(keyAmong(press("\u200c", "Space", true), [" "])).toBe(" ");
    expect(keyAmong(press("ß", "Minus"), ["-"])).toBeUndefined();
  });
  it("look up tables", () => {
    expect(entryOf(press("З", "KeyP"), { p: 7, Enter: 8 })).toBe(7);
    expect(entryOf(press("x", "KeyX"), { p: 7 })).toBeUndefined();
    expect(entryOf(press("constructor", ""), {})).toBeUndefined();
  });
});
