// What the reader has chosen stands in the page's address behind #, so that a link or a reload
// shows the same (`choice` of answers/choice.js keeps it):
// #t=0.3&colour=displacement&cut=y:0.5&chains=1&view=x&play=0. What is as it was at first is left
// out.

const addressRest = 300;  // nothing changes for so long [ms]: then the address is written

class Address {
  // While the replay is as it begins.
  constructor(replay) {
    this.replay = replay;
    this.options = { ...replay.options };
    this.isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches ||
      replay.data.times.length < 2;
    this.first = { ...this.words(), play: this.isCalm ? "0" : "1" };
    choice.changed(() => {
      this.read();
      replay.set({});
    });
  }

  // All that an address can say, as it is now: name -> text.
  words() {
    const { options, camera, data, errors, time, playing, rate } = this.replay;
    const rounded = (value) => String(+value.toPrecision(5));
    const view = camera.name();
    return { ...errors.words(), colour: options.colour, grains: options.grains,
      chains: options.chains ? "1" : "0", points: options.points ? "1" : "0",
      threshold: rounded(+options.threshold), pick: String(options.picked),
      cut: options.cut && options.cut + ":" + rounded(+options.cutAt), view,
      yaw: view ? "" : rounded(camera.yaw), pitch: view ? "" : rounded(camera.pitch),
      zoom: rounded(camera.homeDistance / camera.distance),
      at: camera.isCentred() ? "" : camera.target.map(rounded).join(","), rate: String(rate),
      play: playing ? "1" : "0", t: rounded(playing ? data.begin : time) };
  }

  // Makes the replay what the address says.
  read() {
    const { replay, options } = this, { camera, data } = replay;
    const said = (name, use) => { if (choice.get(name)) use(choice.get(name)); };
    Object.assign(replay.options, options);
    camera.home();
    for (const name of ["chains", "points"])
      if (choice.get(name) === "1")
        Object.assign(replay.options, { [name]: true, grains: "ghost" });
    for (const name of ["colour", "grains"])
      said(name, (value) => { replay.options[name] = value; });
    said("threshold", (value) => { replay.options.threshold = +value; });
    said("pick", (value) => { replay.options.picked = +value; });
    said("cut", (value) => {
      const [axis, at] = value.split(":");
      Object.assign(replay.options, { cut: axis, cutAt: at ? +at : 0.5 });
    });
    said("view", (value) => camera.along(value));
    for (const name of ["yaw", "pitch"]) said(name, (value) => { camera[name] = +value; });
    said("zoom", (value) => camera.zoom(1 / +value));
    said("at", (value) => { camera.target = value.split(",").map(Number); });
    said("rate", (value) => { replay.rate = +value; });
    element("rate").value = replay.rate;
    // for tests: the quick picture alone
    if (choice.get("rest") === "0") for (const stage of replay.stages) stage.canRest = false;
    if (replay.errors.isOn) replay.errors.read();
    replay.time = clamp(+choice.get("t", data.begin), data.begin, data.end);
    replay.setPlaying(!this.isCalm && choice.get("play") !== "0");
  }

  // Something has changed.
  touched() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      const now = this.words(), { first } = this;
      const changes = Object.fromEntries(Object.entries(now).map(([name, text]) =>
        [name, text && text !== first[name] ? text : null]));
      // chains and points make glass of grains unless it is said otherwise
      if (changes.chains || changes.points) changes.grains = now.grains;
      choice.keep(changes);
    }, addressRest);
  }
}
