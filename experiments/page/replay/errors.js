// The error in space: every contact of a captured problem is coloured by the error of an answer
// there. Each of two backends has a picture; they share the camera and the budget of iterations.

class ErrorView {
  constructor(data) {
    this.data = data;
    this.solves = data.head.errors;
    this.isOn = this.solves.length > 0;
    this.budget = this.isOn ? this.solves[0].iterations.length >> 1 : 0;
    this.shown = [0, Math.min(1, this.solves.length - 1)];  // which solve each picture shows
    this.worst = -1;
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

  // Takes over the choices in the page's address, #left=pgs&right=auto&budget=100, and the first
  // choice for each that it lacks.
  read() {
    const { iterations } = this.solves[0], last = this.solves.length - 1;
    this.shown = ["left", "right"].map((side, k) => {
      const asked = this.solves.findIndex((solve) => solve.backend === choice.get(side));
      return asked < 0 ? Math.min(k, last) : asked;
    });
    const budget = +choice.get("budget", iterations[iterations.length >> 1]);
    this.budget = Math.max(0, iterations.findLastIndex((one) => one <= budget));
    ["left", "right"].forEach((side, k) => {
      if (part(side)) part(side).value = this.shown[k];
    });
    part("budget").value = this.budget;
    this.say();
  }

  // The current choices as the address holds them.
  words() {
    if (!this.isOn) return {};
    const [left, right] = this.shown.map((k) => this.solves[k].backend);
    return { left, right, budget: String(this.solves[0].iterations[this.budget]) };
  }

  // Builds the controls: the backend of each picture, the budget, a button to the worst contact.
  build(replay) {
    if (!this.isOn) return;
    const place = part("errors"), { iterations } = this.solves[0];
    const names = this.solves.map((solve, k) => [String(k), solve.backend]);
    const two = this.solves.length > 1;
    const changed = () => {
      this.say();
      replay.touched();
    };
    const choose = (side, words, picture) =>
      selection(side, words, names, String(this.shown[picture]), (chosen) => {
        this.shown[picture] = +chosen;
        changed();
      });
    place.hidden = false;
    place.replaceChildren(choose("left", two ? "left" : "backend", 0),
      ...two ? [choose("right", "right", 1)] : [],
      slider("budget", "iterations", 0, iterations.length - 1, this.budget, 1, (budget) => {
        this.budget = budget;
        changed();
      }),
      element("output", { id: "replay-budgettext" }),
      control("worst", "worst contact", "Look at the most wrong contact of the left picture",
        () => {
          this.worst = this.findWorst(0);
          replay.camera.target = this.data.contactPlace(this.worst);
          replay.camera.distance = 14 * replay.marks.meanReach;
          changed();
        }));
    this.say();
  }

  // Writes the budget and the rms errors in words.
  say() {
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
    part("budgettext").textContent = iterations[this.budget] + " \u2014 " + words.join(", ");
  }

  drawLegend() {
    const legend = part("legend");
    const ticks = [[0, "1e\u22126"], [1 / 3, "1e\u22124"], [2 / 3, "1e\u22122"], [1, "1"]];
    legend.hidden = false;
    legend.replaceChildren(...rampLegend("error over g h", cssGradient(markRamps.heat), ticks));
  }
}
