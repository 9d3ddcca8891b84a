// How colours made for white paper look on dark paper, PAPER, as the window shows them: neutral ones
// have their lightness turned over, vivid ones are as light as can be read. In OKLab, B. Ottosson
// (2020).

const LMS = [
  [0.4122214708, 0.5363325363, 0.0514459929],
  [0.2119034982, 0.6806995451, 0.1073969566],
  [0.0883024619, 0.2817188376, 0.6299787005],
];
const LAB = [
  [0.2104542553, 0.793617785, -0.0040720468],
  [1.9779984951, -2.428592205, 0.4505937099],
  [0.0259040371, 0.7827717662, -0.8086757660],
];
const FROM_LAB = inverse(LAB), FROM_LMS = inverse(LMS);

function times(matrix, vector) {
  return matrix.map((row) => row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2]);
}

function inverse([[a, b, c], [d, e, f], [g, h, i]]) {
  const A = e * i - f * h, B = f * g - d * i, C = d * h - e * g;
  const all = a * A + b * B + c * C;
  return [
    [A, c * h - b * i, b * f - c * e],
    [B, a * i - c * g, c * d - a * f],
    [C, b * g - a * h, a * e - b * d],
  ].map((row) => row.map((value) => value / all));
}

function labOf(rgb) {
  const light = rgb.map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
  return times(LAB, times(LMS, light).map(Math.cbrt));
}

// What red, green and blue, from 0 to 1, become on dark paper.
function onDark(rgb) {
  const clip = (value) => Math.min(Math.max(value, 0), 1);
  const [light, a, b] = labOf(rgb), ground = labOf(numbersOf(PAPER));
  const vivid = clip((Math.hypot(a, b) - 0.07) / 0.05);
  const over = ground[0] + clip(1 - light) ** 0.75 * (0.96 - ground[0]);
  const lifted = Math.max(light, 0.8 - 0.45 * (0.8 - light));
  const tint = (1 - vivid) * light;
  const lab = [over + vivid * (lifted - over), a + tint * ground[1], b + tint * ground[2]];
  const linear = times(FROM_LMS, times(FROM_LAB, lab).map((v) => v ** 3)).map(clip);
  return linear.map((v) => clip(v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
}

function numbersOf(color) {
  return [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16) / 255);
}

function colorOf(rgb) {
  return "#" + rgb.map((value) => Math.round(255 * value).toString(16).padStart(2, "0")).join("");
}

const darkened = new Map();

// What a colour of a scene, #rrggbb or #rrggbbaa, becomes.
function shade(color, dark) {
  if (!dark || !color) return color;
  let found = darkened.get(color);
  if (!found) {
    found = colorOf(onDark(numbersOf(color))) + color.slice(7);
    darkened.set(color, found);
  }
  return found;
}

// What the pixels of an image become: colours with 6 bits a channel, as there may be many.
function shadePixels(pixels) {
  const result = new Uint8ClampedArray(pixels.length), known = new Map();
  for (let k = 0; k < pixels.length; k += 4) {
    const bits = [0, 1, 2].map((c) => pixels[k + c] >> 2), key = bits[0] << 12 | bits[1] << 6 | bits[2];
    let turned = known.get(key);
    if (!turned) known.set(key, (turned = onDark(bits.map((v) => v / 63)).map((v) => 255 * v)));
    result[k] = turned[0];
    result[k + 1] = turned[1];
    result[k + 2] = turned[2];
    result[k + 3] = pixels[k + 3];
  }
  return result;
}
