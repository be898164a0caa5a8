// The replay itself: one time, one camera, and the reader's choices.

class Replay {
  constructor(data) {
    this.data = data;
    this.camera = new Camera(data);
    this.shades = new Shades(data);
    this.marks = new Marks(data);
    this.errors = new ErrorView(data);
    this.time = data.begin;
    this.rate = 0.2;
    this.playing = this.moving = false;
    this.options = { colour: data.times.length > 1 ? "speed" : "size", grains: "solid",
      chains: false, points: false, threshold: 1, cut: "", cutAt: 0.5, picked: -1,
      ...this.errors.first };
    this.quality = 1;
    buildPanel(this);
    this.mesh = new Mesh(data);
    this.stages = ["canvas", "second"].filter(part).map((id) =>
      new Stage(part(id), data, this.mesh));
    this.plots = new Plots(part("plots"), data, (time) => {
      this.setPlaying(false);
      this.setTime(time);
    });
    this.readStyle();
    this.defaults = { ...this.options };
    this.isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches || data.times.length < 2;
    this.first = { ...this.words(), play: this.isCalm ? "0" : "1" };
    this.readAddress();
    choice.changed(() => {
      this.readAddress();
      this.set({});
    });
    for (const { canvas } of this.stages) {
      listenToPointer(canvas, this);
      listenToKeys(canvas, this);
      // the context of the graphics card may be lost and restored: then the page is loaded again
      canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
      canvas.addEventListener("webglcontextrestored", () => location.reload());
    }
    this.set({});
    new ResizeObserver(() => {
      this.plots.layOut();
      this.set({});
    }).observe(part("stage"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      this.readStyle();
      this.set({});
    });
    // nothing is drawn while the replay is out of sight
    this.isSeen = true;
    new IntersectionObserver(([entry]) => { this.isSeen = entry.isIntersecting; }).observe(
      part("stage"));
  }

  readStyle() {
    const names = ["paper", "grey", "blue", "vermilion"];
    this.colours = Object.fromEntries(names.map((name) => [name, styleColour(name)]));
    suitMarks(this.colours.paper);
  }

  // Changes the reader's choices, and shows them in the panel.
  set(changes) {
    Object.assign(this.options, changes);
    const { options } = this;
    if (!(options.colour in this.shades.choices)) options.colour = "none";
    if (this.errors.isOn) this.errors.take(options);
    for (const [name, value] of Object.entries(options)) {
      const input = part(name.toLowerCase());
      if (input) input[typeof value === "boolean" ? "checked" : "value"] = value;
    }
    part("cutat").disabled = !options.cut;
    if (part("threshold")) {
      part("threshold").disabled = !options.chains;
      part("thresholdtext").textContent = (+options.threshold).toFixed(1) + " × mean";
    }
    if (this.errors.isOn) this.errors.show();
    else drawLegend(this.shades, options, this.marks);
    this.touched();
  }

  pickAt(x, y) {
    this.set({ picked: this.stages[0].pick(this.look(0), x, y) });
  }

  // The plane, as normal and offset, beyond which everything is cut away; null: no cut.
  cutPlane() {
    const axis = "xyz".indexOf(this.options.cut || "-");
    if (axis < 0) return null;
    // the half nearer to the eye is cut away
    const sign = this.camera.eye[axis] >= this.data.centre[axis] ? 1 : -1;
    const { low, high } = this.data, plane = [0, 0, 0, 0];
    plane[axis] = sign;
    plane[3] = sign * (low[axis] + (high[axis] - low[axis]) * this.options.cutAt);
    return plane;
  }

  setTime(time) {
    this.time = clamp(time, this.data.begin, this.data.end);
    this.touched();
  }
  step(direction) {
    this.setPlaying(false);
    const { times: stored } = this.data, { frame, u } = this.data.frameAt(this.time);
    // between two frames a step goes to one of them
    const isPast = direction < 0 ? u > 1e-9 : u > 1 - 1e-9, from = isPast ? frame + 1 : frame;
    this.setTime(stored[clamp(from + direction, 0, stored.length - 1)]);
  }
  setPlaying(on) {
    this.playing = on;
    part("play").textContent = on ? "\u275a\u275a" : "\u25b6";
    part("play").setAttribute("aria-label", on ? "Pause" : "Play");
    if (on && this.time >= this.data.end) this.time = this.data.begin;
    this.last = this.drawnAt = 0;
    this.touched();
  }
  // Called after every change. The address is brought up to date 300 ms after the last one.
  touched() {
    this.isStale = true;
    this.movesUntil = performance.now() + 180;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      const { first } = this, now = this.words();
      choice.keep(Object.fromEntries(Object.entries(now).map(([name, text]) =>
        [name, text === first[name] ? null : text])));
    }, 300);
  }

  // The reader's choices, all that an address can hold: name -> text. The page's address keeps them
  // behind #, so that a link or a reload shows the same, without those that are as at first:
  // #t=0.3&colour=displacement&cut=y&cutAt=0.5&chains=1&view=x&play=0.
  words() {
    const { options, camera, data, time, playing, rate } = this;
    const rounded = (value) => String(+(+value).toPrecision(5));
    const words = { rate: String(rate), play: playing ? "1" : "0",
      view: camera.name() || [camera.yaw, camera.pitch, camera.distance, ...camera.target]
        .map(rounded).join(","), t: rounded(playing ? data.begin : time) };
    for (const [name, value] of Object.entries(options))
      words[name] = typeof value === "string" ? value : rounded(value);
    return words;
  }

  readAddress() {
    const { camera, data, defaults } = this;
    for (const [name, value] of Object.entries(defaults)) {
      const said = choice.get(name, String(+value));
      const number = Number.isFinite(+said) ? +said : value;
      this.options[name] = typeof value === "string" ? choice.get(name, value) :
        typeof value === "boolean" ? said === "1" : number;
    }
    camera.home();
    const view = choice.get("view"), numbers = view.split(",").map(Number);
    if (numbers.length === 6 && numbers.every(Number.isFinite))
      [camera.yaw, camera.pitch, camera.distance, ...camera.target] = numbers;
    else camera.along(view);
    part("rate").value = this.rate = +choice.get("rate") || +this.first.rate;
    this.time = clamp(+choice.get("t", data.begin) || data.begin, data.begin, data.end);
    this.setPlaying(!this.isCalm && choice.get("play") !== "0");
  }

  // All that a stage draws at the current time.
  look(picture) {
    const look = { camera: this.camera, grains: this.options.grains, picked: this.options.picked,
      cut: this.cutPlane(), paper: this.colours.paper, balls: this.isDraft };
    look.rods = this.marks.build(this.time, look, this.options, this.colours, this.errors,
      picture);
    return look;
  }

  draw() {
    // a draft has balls in place of grains: the first picture of more than 1e6 corners, and moving
    // pictures where a whole one takes more than 300 ms
    this.isDraft = this.wholeTook ? this.moving && this.wholeTook > 300 :
      this.isDraft === undefined && this.mesh.corners > 1e6;
    const ramp = this.shades.apply(this.options.colour, this.time);
    this.stages.forEach((stage, picture) => {
      stage.resize(this.moving ? this.quality : 1);
      stage.draw(this.look(picture), ramp);
    });
    part("time").value = this.time;
    part("clock").textContent = this.time.toFixed(3) + " s";
    drawFacts(this.data, this.options.picked, this.time);
    this.placeLoad();
    this.plots.draw(this.time);
    this.isStale = this.isDraft && !this.moving;
    this.wholeBegan = this.isDraft ? 0 : performance.now();
  }

  // Writes the load and the wall's displacement beside the load's arrow.
  placeLoad() {
    const label = part("load"), { load } = this.marks, { f, x } = this.data.series;
    label.hidden = !load;
    if (!load) return;
    const line = (one, name) => element("span", { class: one.ink },
      one.symbol + " = " + steady(this.data.seriesAt(name, this.time), one.values) + " " +
      one.unit);
    label.replaceChildren(line(f, "f"), line(x, "x"));
    // beyond the arrow's tail, so that the label does not cover the arrow, and within the picture
    const matrix = this.camera.matrix(this.stages[0].aspect), { clientWidth, clientHeight } =
      this.stages[0].canvas;
    const [left, top] = projected(matrix, load.tail), [head] = projected(matrix, load.middle);
    const { offsetWidth: wide, offsetHeight: high } = label, isRight = left >= head;
    const x0 = left * clientWidth + (isRight ? 6 : -6 - wide), y0 = top * clientHeight;
    label.style.left = clamp(x0, 4, Math.max(4, clientWidth - wide - 4)) + "px";
    // a label that is pushed back over the arrow stands above the arrow
    const isOver = x0 + wide > clientWidth - 4 || x0 < 4;
    const top0 = y0 - (isOver ? high + 14 : high / 2);
    label.style.top = clamp(top0, 4, clientHeight - high - 4) + "px";
  }

  // Called in every frame of the browser. A picture is begun when the last one is finished: without
  // a graphics card it takes longer than a frame.
  loop(now) {
    const passed = this.last ? Math.min(now - this.last, 120) : 0;
    this.last = now;
    if (this.playing) {
      const time = this.time + passed / 1000 * this.rate;
      this.time = time > this.data.end ? this.data.begin : time;
    }
    const wasMoving = this.moving;
    this.moving = this.playing || now < this.movesUntil;
    if (wasMoving && !this.moving && (this.quality < 1 || this.isDraft)) this.isStale = true;
    if (!this.stages.some((stage) => stage.isBusy())) this.drawNext(now);
    requestAnimationFrame((next) => this.loop(next));
  }
  // Called when the last picture is finished; draws the next one if it is needed.
  drawNext(now) {
    if (this.wholeBegan) [this.wholeTook, this.wholeBegan] = [now - this.wholeBegan, 0];
    if (!(this.playing || this.isStale) || !this.isSeen) return;
    this.keepPace(now);
    this.draw();
  }
  // Draws fewer pixels where pictures come slowly.
  keepPace(now) {
    if (!this.playing) return;
    const since = this.drawnAt ? Math.min(now - this.drawnAt, 500) : 60;
    this.drawnAt = now;
    this.pace = this.pace ? 0.85 * this.pace + 0.15 * since : 60;
    if (this.pace > 75 && this.quality > 0.45)
      [this.quality, this.pace] = [this.quality - 0.2, 0];
  }
}

(async () => {
  try {
    if (!document.createElement("canvas").getContext("webgl2"))
      throw new Error("this browser gives no WebGL 2");
    const replay = new Replay(await Data.load());
    replay.draw();
    window.ballastReplay = replay;
    window.ballastReplay.projected = projected;
    requestAnimationFrame((now) => replay.loop(now));
  } catch (error) {
    part("sentence").hidden = false;
    part("sentence").textContent = "Only a still picture: " + error.message + ".";
    window.ballastReplayError = String(error.stack || error);
  }
})();
