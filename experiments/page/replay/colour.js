// Ramps of 256 colours, in linear light. They are made in OKLab (Ottosson 2020) with equal steps,
// light at rest and dark at the top, so that neither end vanishes in shade.

const toSrgb = (c) => c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
const toLinear = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;

function fromOklab([light, a, b]) {
  const l = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (light - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s].map((c) => clamp(c, 0, 1));
}

// `knots`: lightness, chroma and hue [degrees]; between them straight lines in these three, walked
// with equal steps of colour.
function rampOf(knots) {
  const lab = [], length = [0];
  const fine = 64 * (knots.length - 1);
  for (let i = 0; i <= fine; ++i) {
    const k = Math.min(Math.floor(i / 64), knots.length - 2), u = i / 64 - k;
    const [light, chroma, hue] = knots[k].map((v, j) => v + (knots[k + 1][j] - v) * u);
    const angle = hue * Math.PI / 180;
    lab.push([light, chroma * Math.cos(angle), chroma * Math.sin(angle)]);
    if (i) length.push(length[i - 1] + norm(sub(lab[i], lab[i - 1])));
  }
  const ramp = new Float32Array(256 * 4);
  for (let j = 0, i = 0; j < 256; ++j) {
    while (i < fine && length[i] < length[fine] * j / 255) ++i;
    ramp.set([...fromOklab(lab[i]), 1], 4 * j);
  }
  return ramp;
}

const ramps = {
  heat: rampOf([[0.91, 0.03, 95], [0.82, 0.105, 72], [0.69, 0.16, 45], [0.56, 0.18, 15],
    [0.44, 0.165, -25], [0.34, 0.13, -62]]),
  water: rampOf([[0.92, 0.07, 115], [0.81, 0.11, 155], [0.67, 0.105, 195], [0.54, 0.11, 235],
    [0.43, 0.12, 268], [0.33, 0.1, 292]]),
  stone: rampOf([[0.72, 0.008, 70], [0.80, 0.02, 78], [0.87, 0.024, 88]]),
};

// Marks (force chains, points, errors) begin near the ground's lightness and end far from it: on a
// dark ground their ramps run backwards.
const markRamps = {};
const isDark = (paper) => paper[1] < 0.2;
function suitMarks(paper) {
  for (const name of ["heat", "water"]) {
    const texels = Array.from({ length: 256 }, (_, k) => ramps[name].subarray(4 * k, 4 * k + 4));
    if (isDark(paper)) texels.reverse();
    markRamps[name] = Float32Array.from(texels.flatMap((texel) => [...texel]));
  }
}

const colourAt = (ramp, share) => {
  const k = 4 * Math.round(255 * clamp(share, 0, 1));
  return [ramp[k], ramp[k + 1], ramp[k + 2]];
};
const cssColour = (linear) =>
  "rgb(" + linear.map((c) => Math.round(255 * toSrgb(c))).join(",") + ")";
// A ramp, or its part between two shares.
const cssGradient = (ramp, from = 0, to = 1) => "linear-gradient(90deg," +
  Array.from({ length: 17 }, (_, k) =>
    cssColour(colourAt(ramp, from + (to - from) * k / 16))).join(",") + ")";

// A colour of the page's style sheet: as it stands there, and in linear light.
function styleColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  const hex = text.length === 4 ? text.replace(/[0-9a-f]/gi, "$&$&") : text;
  const linear = [1, 3, 5].map((k) => toLinear(parseInt(hex.slice(k, k + 2), 16) / 255));
  return { text, linear };
}
