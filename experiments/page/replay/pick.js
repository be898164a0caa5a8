// Which grain a ray meets first: each grain is the space behind its faces.

// Where the ray eye + t d enters grain g, at least at `least`; Infinity where it doesn't.
function entryInto(data, mesh, g, eye, d, least) {
  const state = data.state.subarray(8 * g, 8 * g + 8), to = sub(eye, state);
  const along = dot(to, d);
  if (dot(to, to) - along * along > data.reach[g] ** 2) return Infinity;
  const turn = state.subarray(4, 8), o = turned(turn, to, -1), v = turned(turn, d, -1);
  const { planes } = mesh.shapes[data.head.shape_of[g]], scale = data.head.scale / 32767;
  let enter = least, leave = Infinity;
  for (let k = 0; k < planes.length; k += 4) {
    const speed = planes[k] * v[0] + planes[k + 1] * v[1] + planes[k + 2] * v[2];
    const room = planes[k + 3] * scale -
      (planes[k] * o[0] + planes[k + 1] * o[1] + planes[k + 2] * o[2]);
    if (speed < 0) enter = Math.max(enter, room / speed);
    else if (speed > 0) leave = Math.min(leave, room / speed);
    else if (room < 0) return Infinity;
    if (enter > leave) return Infinity;
  }
  return enter;
}

// x, y: place in the picture of unit size. -1: none.
function pickGrain(data, mesh, camera, aspect, cut, x, y) {
  const eye = camera.eye, d = camera.ray(x, y, aspect);
  let least = 0;
  if (cut) {
    // what is cut away begins or ends where the ray meets the plane
    const speed = dot(cut, d), room = cut[3] - dot(cut, eye);
    if (room < 0) {
      if (speed >= 0) return -1;
      least = room / speed;
    }
  }
  let nearest = Infinity, found = -1;
  for (let g = 0; g < data.grains; ++g) {
    const entry = entryInto(data, mesh, g, eye, d, least);
    if (entry >= nearest) continue;
    if (cut && dot(cut, add(eye, times(d, entry))) > cut[3] + 1e-9) continue;
    nearest = entry;
    found = g;
  }
  return found;
}
