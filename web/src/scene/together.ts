/// Composes the images: background, smoke behind the hands, hands, and smoke in front.

export const kTogether = /* glsl */ `
precision highp float;
in vec2 uv;
out vec4 colour;
uniform sampler2D back, backDepth, hand, handDepth, before, behind;
uniform vec3 middleColour, outerColour;
uniform float aspect, smoke;
vec3 encoded(vec3 x) { return mix(12.92 * x, 1.055 * pow(max(x, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, x)); }
float noise(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }
void main() {
  float r = length((uv - vec2(0.5, 0.54)) * vec2(aspect, 1.0));
  vec3 c = mix(middleColour, outerColour, smoothstep(0.0, 0.85, r));
  vec4 b = texture(back, uv), h = texture(hand, uv);
  // seen from below the array, the hand shows through it
  if (texture(backDepth, uv).r < texture(handDepth, uv).r) h *= 0.8;
  c = c * (1.0 - b.a) + b.rgb;
  if (smoke > 0.0) { vec4 s = texture(behind, uv); c = c * (1.0 - s.a) + s.rgb; }
  c = c * (1.0 - h.a) + h.rgb;
  // smoke in front of the hand veils it slightly, and never hides the field on it
  if (smoke > 0.0) { vec4 s = texture(before, uv) * mix(1.0, 0.45, clamp(h.a, 0.0, 1.0)); c = c * (1.0 - s.a) + s.rgb; }
  colour = vec4(encoded(c) + (noise(gl_FragCoord.xy) - 0.5) / 255.0, 1.0);
}`;
