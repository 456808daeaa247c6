/// The colours of all fields and paths, computed as those of the figures are (src/figure/colours.cpp).

export type Rgb = [number, number, number]; // sRGB, 0 to 1

const clamp01 = (x: number): number => Math.min(1, Math.max(0, x));
const gammaEncoded = (x: number): number => (clamp01(x) <= 0.0031308 ? 12.92 * clamp01(x) : 1.055 * clamp01(x) ** (1 / 2.4) - 0.055);

/// Linear sRGB of an Oklab colour (B. Ottosson, "A perceptual color space for image processing", 2020); may lie outside 0 to 1.
function linearSrgb(lightness: number, a: number, b: number): Rgb {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
  ];
}

/// The colour with this lightness and hue, and the largest chroma, at most `chroma`, that a screen can show.
function screenColour(lightness: number, hueDegrees: number, chroma: number): Rgb {
  const hue = (hueDegrees * Math.PI) / 180;
  for (let c = chroma; ; c -= 0.002) {
    const rgb = linearSrgb(lightness, c * Math.cos(hue), c * Math.sin(hue));
    if ((Math.min(...rgb) >= -0.001 && Math.max(...rgb) <= 1.001) || c < 0.002) return [gammaEncoded(rgb[0]), gammaEncoded(rgb[1]), gammaEncoded(rgb[2])];
  }
}

/// Pressures: lightness increases evenly from dark violet to yellow, so that equal steps look equal, in grey as well.
export function fieldColour(t: number): Rgb {
  const x = clamp01(t);
  return screenColour(0.24 + 0.7 * x, 305 - 203 * x, 0.16);
}

/// Differences, t from −1 (too little, blue) to 1 (too much, orange), symmetric in lightness and chroma.
export function differenceColour(t: number, dark: boolean): Rgb {
  const x = Math.min(1, Math.abs(t));
  const lightness = dark ? 0.3 + 0.48 * x : 0.95 - 0.4 * x;
  return screenColour(lightness, t < 0 ? 250 : 50, 0.18 * x ** 0.8);
}

/// The colour of path i, distinguishable with any colour vision (M. Okabe and K. Ito, "Color universal design", 2008).
const kPathColours: Rgb[] = [
  [0.835, 0.369, 0.0], [0.0, 0.447, 0.698], [0.0, 0.62, 0.451], [0.8, 0.475, 0.655],
  [0.902, 0.624, 0.0], [0.337, 0.706, 0.914], [0.35, 0.25, 0.2], [0.75, 0.7, 0.1],
];
export function pathColour(i: number): Rgb {
  return kPathColours[i % kPathColours.length] ?? [0, 0, 0];
}

export function css([r, g, b]: Rgb, alpha = 1): string {
  const byte = (x: number) => Math.round(255 * clamp01(x));
  return `rgb(${byte(r)} ${byte(g)} ${byte(b)} / ${alpha})`;
}

/// 256 colours in a row, RGBA bytes.
export function table(colour: (t: number) => Rgb, low: number, high: number): Uint8ClampedArray {
  const bytes = new Uint8ClampedArray(4 * 256);
  for (let i = 0; i < 256; ++i) {
    const [r, g, b] = colour(low + ((high - low) * i) / 255);
    bytes.set([Math.round(255 * r), Math.round(255 * g), Math.round(255 * b), 255], 4 * i);
  }
  return bytes;
}

export const kFieldTable = table(fieldColour, 0, 1);
export const kDifferenceTables = {
  light: table((t) => differenceColour(t, false), -1, 1),
  dark: table((t) => differenceColour(t, true), -1, 1),
};
