// Colours and dashes of curves. The colours are variables of the page's style sheet, which follow
// the reader's light or dark ground.

const inks = ["blue", "vermilion", "green", "orange", "purple", "sky", "ink", "grey"];
const dashes = [[], [8, 5], [4, 3], [1.5, 3]];

const variable = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

/// The k-th backend's style: eight colours, then the same, dashed (backend_curve of live_page.cpp).
const curve_style = (k) => ({ ink: inks[k % inks.length],
                              dash: Math.floor(k / inks.length) % dashes.length });
