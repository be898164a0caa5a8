// Mouse, fingers and keys.

// Dragging turns the view; with shift or two fingers it moves the picture. The wheel and a pinch
// zoom; a click picks a grain.
function listenToPointer(canvas, replay) {
  const { camera } = replay, fingers = new Map();
  let travel = 0;
  const spread = () => {
    const [a, b = a] = [...fingers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    travel = 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = fingers.get(event.pointerId);
    if (!from) return;
    const dx = event.clientX - from[0], dy = event.clientY - from[1], high = canvas.clientHeight;
    travel += Math.abs(dx) + Math.abs(dy);
    const before = spread();
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 2) {
      camera.zoom(clamp(before / Math.max(spread(), 8), 0.8, 1.25));
      camera.pan(dx / 2 / high, dy / 2 / high);
    } else if (event.shiftKey || event.buttons & 6) {
      camera.pan(dx / high, dy / high);
    } else {
      camera.turn(0.4 * dx, 0.4 * dy);
    }
    if (travel > 3) replay.touched();
  });
  const released = (event) => {
    fingers.delete(event.pointerId);
    if (event.type !== "pointerup" || travel > 4) return;
    const box = canvas.getBoundingClientRect();
    replay.pickAt((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
  };
  canvas.addEventListener("pointerup", released);
  canvas.addEventListener("pointercancel", released);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(clamp(event.deltaY, -120, 120) * 0.0012));
    replay.touched();
  }, { passive: false });
  canvas.addEventListener("dblclick", () => {
    camera.home();
    replay.touched();
  });
}

// Listens to keys while the picture has the focus.
function listenToKeys(canvas, replay) {
  const { camera } = replay;
  const turn = (dx, dy) => (event) =>
    event.shiftKey ? camera.pan(dx / 100, dy / 100) : camera.turn(-dx, dy);
  const actions = { " ": () => replay.setPlaying(!replay.playing), ",": () => replay.step(-1),
    ".": () => replay.step(1), ArrowLeft: turn(-5, 0), ArrowRight: turn(5, 0), ArrowUp: turn(0, 5),
    ArrowDown: turn(0, -5), "+": () => camera.zoom(0.9), "=": () => camera.zoom(0.9),
    "-": () => camera.zoom(1.1), x: () => camera.along("x"), y: () => camera.along("y"),
    z: () => camera.along("z"), X: () => camera.along("-x"), Y: () => camera.along("-y"),
    Z: () => camera.along("-z"), h: () => camera.home(), g: () => replay.pickAt(0.5, 0.5),
    n: () => replay.set({ picked: (replay.options.picked + 1) % replay.data.grains }),
    Escape: () => replay.set({ picked: -1 }), Home: () => replay.setTime(replay.data.begin),
    End: () => replay.setTime(replay.data.end) };
  canvas.addEventListener("keydown", (event) => {
    const action = actions[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action(event);
    replay.touched();
  });
}
