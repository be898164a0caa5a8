// The page's elements around the picture: buttons, choices, legend, facts about a picked grain.

// The last argument of each is called when the reader uses the control, with the chosen value. The
// replay sets what they show.
const selection = (id, words, options, changed) => element("label", {}, words,
  element("select", { id: "replay-" + id, onchange: (event) => changed(event.target.value) },
    ...options.map(([value, text]) => element("option", { value }, text))));
const slider = (id, words, min, max, step, moved) => element("label", {}, words,
  element("input", { id: "replay-" + id, type: "range", min, max, step,
    "aria-label": words || id, oninput: (event) => moved(+event.target.value) }));
const control = (id, text, title, pressed) =>
  button(text, pressed, { id: "replay-" + id, title, "aria-label": title });
const tick = (id, words, turned) => element("label", {},
  element("input", { id: "replay-" + id, type: "checkbox",
    onchange: (event) => turned(event.target.checked) }), words);

// A selection of the replay's option of that name.
const optionOf = (replay, name, words, values) =>
  selection(name, words, values, (value) => replay.set({ [name]: value }));

// Builds all elements, which replace the still picture.
function buildPanel(replay) {
  const { data, camera } = replay, moves = data.times.length > 1;
  const hasContacts = data.contactFrames.length > 0;
  const titles = { force: "force carried", size: "size class" };
  const colours = Object.keys(replay.shades.choices).map((name) => [name, titles[name] ?? name]);
  // where chains or points are shown, grains are drawn as glass
  const marked = (name, other) => (on) => replay.set({ [name]: on,
    grains: on || replay.options[other] ? "ghost" : "solid" });
  part("stage").replaceChildren(
    element("div", { class: "views" },
      element("canvas", { id: "replay-canvas", tabindex: "0", role: "application",
        "aria-label": "The bodies in 3D. Arrows turn, + and - zoom, g picks a grain." }),
      ...data.head.errors.length > 1 ? [element("canvas", { id: "replay-second",
        "aria-label": "The same bodies with the second backend's errors" })] : [],
      ...data.head.errors.map((_, k) => element("div", { id: "replay-who" + k, class: "who" })),
      element("div", { id: "replay-legend" }),
      element("div", { id: "replay-facts", "aria-live": "polite", hidden: true }),
      element("div", { id: "replay-load" })),
    element("div", { class: "controls", hidden: !moves },
      control("back", "\u25c2\u25c2", "One stored frame back", () => replay.step(-1)),
      control("play", "\u25b6", "Play", () => replay.setPlaying(!replay.playing)),
      control("on", "\u25b8\u25b8", "One stored frame on", () => replay.step(1)),
      slider("time", "", data.begin, data.end, "any", (time) => {
        replay.setPlaying(false);
        replay.setTime(time);
      }),
      element("output", { id: "replay-clock" }),
      selection("rate", "speed", [["0.01", "1/100"], ["0.02", "1/50"], ["0.05", "1/20"],
        ["0.1", "1/10"], ["0.2", "1/5"], ["0.5", "1/2"], ["1", "1"], ["2", "2"]], (rate) => {
        replay.rate = +rate;
        replay.touched();
      })),
    element("div", { class: "controls" },
      optionOf(replay, "colour", "colour", colours),
      optionOf(replay, "grains", "grains",
        [["solid", "solid"], ["ghost", "as glass"], ["hidden", "hidden"]]),
      ...hasContacts ? [tick("chains", "force chains", marked("chains", "points")),
        slider("threshold", "above", 0, 5, "any", (threshold) => replay.set({ threshold })),
        element("output", { id: "replay-thresholdtext" }),
        tick("points", "contact points", marked("points", "chains"))] : [],
      optionOf(replay, "cut", "cut", [["", "off"], ["x", "x"], ["y", "y"], ["z", "z"]]),
      slider("cutat", "", 0, 1, "any", (cutAt) => replay.set({ cutAt })),
      element("span", { class: "views-along" }, "view ",
        ...[["home", "home"], ["x", "x"], ["-x", "\u2212x"], ["y", "y"], ["-y", "\u2212y"],
          ["z", "z"]].map(([name, text]) => control("view" + name, text,
          name === "home" ? "The first view" : "Look along " + name, () => {
            if (name === "home") camera.home(); else camera.along(name);
            replay.touched();
          })))),
    element("div", { class: "controls", hidden: !replay.errors.isOn },
      ...replay.errors.controls(replay)),
    element("div", { id: "replay-plots", role: "img",
      "aria-label": "Curves of the run: a click goes to that moment" }));
  part("sentence").hidden = true;
}

// One ramp of the legend, with words, background and ticks [share, text]. A tick whose text would
// run into the text before it is left out.
function rampLegend(words, background, ticks) {
  const wide = matchMedia("(max-width:40rem)").matches ? 160 : 216;  // the legend's width [pixels]
  const bar = element("div", { class: "bar" }), row = element("div", { class: "ticks" });
  bar.style.background = background;
  let end = -Infinity;
  for (const [at, text] of ticks) {
    // about 7 pixels a letter; the first text begins at its place, others are centred on theirs
    const half = 3.5 * text.length, middle = Math.max(at * wide, row.children.length ? 0 : half);
    if (middle - half < end + 6) continue;
    end = middle + half;
    const mark = element("span", {}, text);
    mark.style.left = 100 * at + "%";
    row.append(mark);
  }
  return [element("b", {}, words), bar, row];
}

// Draws the legend: the meaning of the colours of grains, force chains and contact points.
function drawLegend(shades, { colour, chains, points }, marks) {
  const legend = part("legend"), { words, unit, ramp } = shades.choices[colour];
  const parts = [];
  const classes = [0, 1, 2, 3, 4].map((k) =>
    `${cssColour(colourAt(ramps[ramp], (k + 0.5) / 5))} ${20 * k}% ${20 * k + 20}%`);
  const ticks = shades.ticks(colour), ground = colour !== "size" ? cssGradient(ramps[ramp]) :
    ticks.length > 1 ? "linear-gradient(90deg," + classes + ")" :
      cssColour(colourAt(ramps[ramp], 0.5));  // all grains have one size
  if (words)
    parts.push(...rampLegend(words + (unit ? " / " + unit : ""), ground, ticks));
  if (chains)
    parts.push(...rampLegend("chains: force of a pair / N", cssGradient(markRamps.heat, 0.25, 0.9),
      [0, 0.25, 0.5, 1].map((share) => [Math.sqrt(share), shown(share * marks.topChain, 2)])));
  if (points)
    parts.push(...rampLegend("points: share of friction used",
      cssGradient(markRamps.water, 0.15, 1), [[0, "0"], [0.5, "0.5"], [1, "1"]]));
  legend.hidden = !parts.length;
  legend.replaceChildren(...parts);
}

function drawFacts(data, picked, time) {
  const facts = part("facts");
  facts.hidden = picked < 0;
  if (picked < 0) return;
  const { frame, next, u } = data.frameAt(time), at = data.contactsAt(time);
  const v = [0, 1, 2].map((k) =>
    data.velocityOf(frame, picked, k) * (1 - u) + data.velocityOf(next, picked, k) * u);
  const rows = [["size", shown(1e3 * data.size[picked]) + " mm"],
    ["mass", data.mass[picked] < 1 ? shown(1e3 * data.mass[picked]) + " g" :
      shown(data.mass[picked]) + " kg"],
    ["place / mm", data.centreOf(picked).map((p) => shown(1e3 * p, 4)).join("  ")],
    ["velocity / m/s", v.map((p) => shown(p, 2)).join("  ")], ["speed", shown(norm(v)) + " m/s"]];
  if (at.frame >= 0) {
    const { a, b, force } = data.contact, partners = new Map();
    for (let c = at.begin; c < at.end; ++c)
      if (a[c] === picked || b[c] === picked) {
        const other = a[c] === picked ? b[c] : a[c];
        partners.set(other, (partners.get(other) || 0) + force[c]);
      }
    const name = (body) => body < data.grains ? "grain " + body :
      data.head.walls[body - data.grains].name;
    rows.push(["touches", partners.size + (partners.size === 1 ? " body" : " bodies")]);
    const strongest = [...partners].sort((p, q) => q[1] - p[1]).slice(0, 4);
    for (const [body, sum] of strongest) rows.push(["\u00a0 " + name(body), shown(sum) + " N"]);
  }
  facts.replaceChildren(element("b", {}, "grain " + picked), element("table", {},
    element("tbody", {}, ...rows.map(([what, value]) =>
      element("tr", {}, element("td", {}, what), element("td", {}, value))))));
}
