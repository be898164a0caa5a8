// From the page's text to numbers: the way back of experiments/view/quantised.cpp.

const element = (id) => document.getElementById("replay-" + id);

// The bytes of a part: base64, then deflate.
async function partBytes(name) {
  const holder = element(name);
  if (!holder) return new Uint8Array(0);
  const packed = Uint8Array.from(atob(holder.textContent), (c) => c.charCodeAt(0));
  holder.textContent = "";
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Zigzag differences, column after column, as values[frame * columns + column]. `planes`: bytes of
// a number; `order`: how often differences were taken.
function historyOf(bytes, columns, planes, order) {
  const count = bytes.length / planes, frames = columns ? count / columns : 0;
  const values = planes === 2 ? new Uint16Array(count) : new Uint8Array(count);
  for (let c = 0, at = 0; c < columns; ++c) {
    let value = 0, slope = 0;
    for (let f = 0; f < frames; ++f, ++at) {
      const code = planes === 2 ? bytes[at] | bytes[count + at] << 8 : bytes[at];
      const difference = (code >> 1) ^ -(code & 1);
      slope = order === 2 ? slope + difference : difference;
      value += slope;
      values[f * columns + c] = value;  // modulo 2^16 or 2^8
    }
  }
  return values;
}

function wordsOf(bytes) {
  const count = bytes.length / 2, values = new Uint16Array(count);
  for (let k = 0; k < count; ++k) values[k] = bytes[k] | bytes[count + k] << 8;
  return values;
}

function floatsOf(bytes) {
  const count = bytes.length / 4, whole = new Uint8Array(bytes.length);
  for (let b = 0; b < 4; ++b)
    for (let k = 0; k < count; ++k) whole[4 * k + b] = bytes[b * count + k];
  return new Float32Array(whole.buffer);
}

// -1 .. 1 from 8 bits with a root's steps.
const fromSignedRoot = (byte) => {
  const root = (byte - 128) / 127;
  return root * Math.abs(root);
};

// A unit vector from two bytes.
function fromOctahedron(a, b) {
  let x = a / 127.5 - 1, y = b / 127.5 - 1;
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0)
    [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
  return unit([x, y, z]);
}
