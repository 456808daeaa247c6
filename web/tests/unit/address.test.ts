import { describe, expect, it } from "vitest";
import { askedSettings, changedSettings, readAddress, writeAddress, type PageState } from "../../src/address";
import { paths, prediction, scene, speed } from "../support/frames";

describe("an address", () => {
  const whole: PageState = {
    settings: { scene: "still-air", paths: "2" }, eye: [-32, 38.5, 700, 0, 0, 125], theme: "dark", large: true, folded: ["Plan", "Hand"],
    skin: "target", picture: "off", scale: 0.6, span: 120, still: true,
  };
  it("round-trips the state", () => expect(readAddress(writeAddress(whole))).toEqual(whole));
  it("is empty for the defaults", () => {
    expect(writeAddress({ settings: {} })).toBe("");
    expect(readAddress("")).toEqual({ settings: {} });
  });
  it("distinguishes open groups from unspecified ones", () => {
    expect(readAddress(writeAddress({ settings: {}, folded: [] })).folded).toEqual([]);
    expect(readAddress("#theme=dark").folded).toBeUndefined();
  });
  it.each(["#eye=1,2,3", "#eye=a,b,c,d,e,f", "#theme=pink", "#picture=maybe", "#scale=-1", "#scale=x", "#span=31", "#other=1"])(
    "leaves out what is no value of its key: %s", (hash) => expect(readAddress(hash)).toEqual({ settings: {} }),
  );
});

describe("settings in an address", () => {
  it("are those that differ from the run's start", () => {
    expect(changedSettings([speed, { ...paths, value: 2 }, { ...scene, value: "still-air" } as typeof scene])).toEqual({ paths: "2", scene: "still-air" });
    expect(changedSettings([{ ...speed, value: 7.000000000000001 }])).toEqual({});
  });
  it("are requested if they differ from the present ones and exist", () => {
    const asked = askedSettings([speed, paths, scene, prediction], { speed: "7", paths: "2", scene: "no such", prediction: "false", other: "1" });
    expect(asked.map(({ control, value }) => [control.id, value])).toEqual([["paths", 2], ["prediction", false]]);
    expect(askedSettings([paths], { paths: "many" })).toEqual([]);
  });
});
