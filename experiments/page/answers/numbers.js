// Writes numbers as the pages do (experiments/page/text.cpp), and reads them back.

const narrow_space = "\u202f", dash = "\u2013";

/// `digits` significant digits; powers of ten below 1e-3 and from 1e6 on; a dash for NaN, infinity.
function number(value, digits = 3) {
  if (!Number.isFinite(value)) return dash;
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= 1e-3 && size < 1e6) {
    const text = value.toPrecision(digits);
    return minus(text.includes("e") ? String(Number(text)) : text);
  }
  const [head, power] = value.toExponential(digits - 1).split("e");
  return minus(head) + "×10" + raised(Number(power));
}
const minus = (text) => text.replace("-", "−");
const raised = (power) =>
  [...String(power)].map((c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)])).join("");

/// Five significant digits without zeros at the end, for values read off an axis.
function short_number(value) {
  const text = number(value, 5);
  return text.includes(".") ? text.replace(/\.?0+(?=×|$)/, "") : text;
}

/// A duration in seconds, milliseconds or microseconds (time_of of compare_page.cpp).
function time_words(seconds) {
  if (!Number.isFinite(seconds)) return dash;
  const [factor, unit] = seconds < 1e-4 ? [1e6, "µs"] : seconds < 1 ? [1e3, "ms"] : [1, "s"];
  return number(factor * seconds) + narrow_space + unit;
}

/// The value of a cell's text: "2.00×10−4 ms", "3 of 4"; NaN for words.
function value_of(text) {
  const plain = text.replaceAll("−", "-").trim();
  const found = /^([-+]?[\d.]+(?:e[-+]?\d+)?)(?:×10([-⁻]?[\d⁰¹²³⁴-⁹]+))?\s*(\S*)/.exec(plain);
  if (!found) return NaN;
  const power = (found[2] ?? "0").replace("⁻", "-")
    .replace(/[⁰¹²³⁴-⁹]/g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(c));
  const unit = { ms: 1e-3, "µs": 1e-6, min: 60, h: 3600 }[found[3]] ?? 1;
  return Number(found[1]) * 10 ** Number(power) * unit;
}

/// [least, largest] of any number of values. (Math.min(...) takes only about 1e5 arguments.)
function extent(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return [low, high];
}

const csv_line = (cells) =>
  cells.map((cell) => (/[",\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell)).join(",");
