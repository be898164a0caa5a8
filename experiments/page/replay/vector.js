// Small vectors [x, y, z], quaternions [w, x, y, z] and matrices (16 numbers, column by column).

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => times(a, 1 / (norm(a) || 1));
const perpendicular = (a) => unit(cross(a, Math.abs(a[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));

function product(a, b) {
  const result = new Float32Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row)
      for (let k = 0; k < 4; ++k)
        result[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
  return result;
}

// The axes of a camera at `eye` that looks at `target`: right, up, back.
function axesOf(eye, target) {
  const back = unit(sub(eye, target));
  const right = unit(cross(Math.abs(back[2]) > 0.9999 ? [0, 1, 0] : [0, 0, 1], back));
  return [right, cross(back, right), back];
}

function looking(eye, target) {
  const [x, y, z] = axesOf(eye, target);
  return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
    -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

function perspective(angle, aspect, near, far) {
  const t = 1 / Math.tan(angle / 2);
  return new Float32Array([t / aspect, 0, 0, 0, 0, t, 0, 0, 0, 0, (far + near) / (near - far), -1,
    0, 0, 2 * far * near / (near - far), 0]);
}

function orthographic(radius, near, far) {
  return new Float32Array([1 / radius, 0, 0, 0, 0, 1 / radius, 0, 0, 0, 0, 2 / (near - far), 0,
    0, 0, (far + near) / (near - far), 1]);
}

// The place of a point on a screen of unit size, y downward, and its depth.
function projected(matrix, p) {
  const at = (row) =>
    matrix[row] * p[0] + matrix[4 + row] * p[1] + matrix[8 + row] * p[2] + matrix[12 + row];
  const w = at(3);
  return [0.5 + 0.5 * at(0) / w, 0.5 - 0.5 * at(1) / w, w];
}

// The least step of 1, 2 or 5 times a power of ten that divides `span` into at most `most` parts.
function niceStep(span, most) {
  const power = 10 ** Math.floor(Math.log10(span / most || 1));
  return [1, 2, 5, 10].map((s) => s * power).find((s) => span / s <= most) || 10 * power;
}

// A number for the reader, with a true minus sign.
const shown = (value, digits = 3) =>
  Number.isFinite(value) ? String(+value.toPrecision(digits)).replace("-", "\u2212") : "\u2013";

// A value of a curve, always with the decimal places that give the curve's largest three digits.
const steady = (value, values) => {
  const most = values.reduce((top, v) => Math.max(top, Math.abs(v)), 0);
  const places = clamp(2 - Math.floor(Math.log10(most || 1)), 0, 6);
  const text = value.toFixed(places);
  return +text === 0 ? text.replace("-", "") : text.replace("-", "\u2212");
};
