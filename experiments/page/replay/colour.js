// Ramps of 256 colours in linear light. They are light at the low end and dark at the top, so that
// neither end vanishes in shade. Their stops have equal steps in OKLab (Ottosson 2020).

const toSrgb = (c) => c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
const toLinear = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
const linearOf = (hex) => [1, 3, 5].map((k) => toLinear(parseInt(hex.slice(k, k + 2), 16) / 255));

function rampOf(...hexes) {
  const stops = hexes.map(linearOf), ramp = new Float32Array(256 * 4);
  for (let j = 0; j < 256; ++j) {
    const at = j / 255 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    ramp.set([...stops[k].map((v, c) => v + (stops[k + 1][c] - v) * (at - k)), 1], 4 * j);
  }
  return ramp;
}

const ramps = {
  heat: rampOf("#e7e2cb", "#ebc387", "#ed9c56", "#e9733d", "#d64e48", "#bc305b", "#982470",
    "#6d2178", "#422171"),
  water: rampOf("#e2ebb6", "#aadda2", "#6ccca5", "#3bb4a9", "#0799aa", "#097da6", "#275f9c",
    "#374187", "#382863"),
  stone: rampOf("#a8a49f", "#c4bbaf", "#dbd4c3"),
};

// Marks (force chains, points, errors) begin near the ground's lightness and end far from it: on a
// dark ground their ramps run backwards.
const markRamps = {};
const isDark = (paper) => paper[1] < 0.2;
function suitMarks(paper) {
  for (const name of ["heat", "water"]) {
    const texels = Array.from({ length: 256 },
      (_, k) => [...ramps[name].subarray(4 * k, 4 * k + 4)]);
    markRamps[name] = Float32Array.from((isDark(paper) ? texels.reverse() : texels).flat());
  }
}

const colourAt = (ramp, share) => {
  const k = 4 * Math.round(255 * clamp(share, 0, 1));
  return [ramp[k], ramp[k + 1], ramp[k + 2]];
};
const cssColour = (linear) =>
  "rgb(" + linear.map((c) => Math.round(255 * toSrgb(c))).join(",") + ")";
// The CSS gradient of a ramp, or of its part between two shares.
const cssGradient = (ramp, from = 0, to = 1) => "linear-gradient(90deg," +
  Array.from({ length: 17 }, (_, k) =>
    cssColour(colourAt(ramp, from + (to - from) * k / 16))).join(",") + ")";

// A colour of the page's style sheet in linear light.
function styleColour(name) {
  const text = getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  return linearOf(text.length === 4 ? text.replace(/[0-9a-f]/gi, "$&$&") : text);
}
