// The error in space: every contact of a captured problem is coloured by the error of an answer
// there. Each of two backends has a picture; they share the camera and the budget of iterations.

class ErrorView {
  constructor(data) {
    this.data = data;
    this.solves = data.head.errors;
    this.isOn = this.solves.length > 0;
    this.worst = -1;
  }

  // The first choices: the backend of each picture, the budget of iterations, grains as glass.
  get first() {
    if (!this.isOn) return {};
    const [left, right = left] = this.solves, { iterations } = left;
    return { left: left.backend, right: right.backend,
      budget: String(iterations[iterations.length >> 1]), colour: "none", grains: "ghost" };
  }

  // The decadic logarithm of the error over g h of contact c in a picture.
  errorOf(picture, c) {
    const budgets = this.solves[0].iterations.length, contacts = this.data.contact.count;
    const at = (this.shown[picture] * budgets + this.budget) * contacts + c;
    return this.data.errors[at] / 255 * 11 - 9;
  }

  // Adds balls at the contacts of a picture, the worst contact on a needle.
  addBalls(rods, picture, marks, cut) {
    const size = marks.meanReach;
    for (let c = 0; c < this.data.contact.count; ++c) {
      const place = this.data.contactPlace(c);
      if (cut && dot(cut, place) > cut[3]) continue;
      // the colours span errors over g h from 1e-6 to 1
      const share = clamp((this.errorOf(picture, c) + 6) / 6, 0, 1);
      const radius = size * (0.06 + 0.28 * share * share);
      addRod(rods, place, radius, place, radius, colourAt(markRamps.heat, share));
      if (c !== this.worst) continue;
      const n = [0, 0, 1.2 * size];
      addRod(rods, sub(place, n), 0.03 * size, add(place, n), 0.03 * size, [0.02, 0.45, 0.5]);
    }
  }

  findWorst(picture) {
    let worst = 0;
    for (let c = 1; c < this.data.contact.count; ++c)
      if (this.errorOf(picture, c) > this.errorOf(picture, worst)) worst = c;
    return worst;
  }

  // Takes over the reader's choices, which may be from an address: left=pgs&right=auto&budget=100.
  // The first choice stands for a backend that is not there, the next smaller budget for a budget.
  take(options) {
    const { iterations } = this.solves[0], names = this.solves.map(({ backend }) => backend);
    for (const side of ["left", "right"])
      if (!names.includes(options[side])) options[side] = this.first[side];
    // which solve each picture shows, and the place of the budget
    this.shown = [options.left, options.right].map((name) => names.indexOf(name));
    this.budget = Math.max(0, iterations.findLastIndex((one) => one <= +options.budget));
    options.budget = String(iterations[this.budget]);
  }

  // The controls: the backend of each picture, the budget, a button to the worst contact.
  controls(replay) {
    if (!this.isOn) return [];
    const { iterations } = this.solves[0], two = this.solves.length > 1;
    const names = this.solves.map(({ backend }) => [backend, backend]);
    return [optionOf(replay, "left", two ? "left" : "backend", names),
      ...two ? [optionOf(replay, "right", "right", names)] : [],
      slider("budget", "iterations", 0, iterations.length - 1, 1,
        (budget) => replay.set({ budget: String(iterations[budget]) })),
      element("output", { id: "replay-budgettext" }),
      control("worst", "worst contact", "Look at the most wrong contact of the left picture",
        () => {
          this.worst = this.findWorst(0);
          replay.camera.target = this.data.contactPlace(this.worst);
          replay.camera.distance = 14 * replay.marks.meanReach;
          replay.set({});
        })];
  }

  // Shows the budget, the rms errors in words, and the legend.
  show() {
    const { iterations } = this.solves[0];
    const number = (v) => v.toExponential(1).replace("-", "\u2212");
    const pictures = this.solves.length > 1 ? this.shown : this.shown.slice(0, 1);
    const words = pictures.map((k) =>
      this.solves[k].backend + ": rms " + number(this.solves[k].rms[this.budget]));
    if (this.worst >= 0)
      words.push("worst on the left: " + number(10 ** this.errorOf(0, this.findWorst(0))));
    pictures.forEach((k, picture) => {
      if (part("who" + picture)) part("who" + picture).textContent = this.solves[k].backend;
    });
    part("budget").value = this.budget;  // the slider goes from budget to budget
    part("budgettext").textContent = iterations[this.budget] + " \u2014 " + words.join(", ");
    const legend = part("legend");
    const ticks = [[0, "1e\u22126"], [1 / 3, "1e\u22124"], [2 / 3, "1e\u22122"], [1, "1"]];
    legend.hidden = false;
    legend.replaceChildren(...rampLegend("error over g h", cssGradient(markRamps.heat), ticks));
  }
}
