// The camera: target, distance [m], yaw and pitch [degrees]. One camera may serve several stages.

const viewAngle = 28 * Math.PI / 180;

// The yaw and pitch [degrees] of the views along the axes.
const axisViews = { x: [0, 0], "-x": [180, 0], y: [90, 0], "-y": [-90, 0], z: [-90, 90],
  "-z": [-90, -90] };

class Camera {
  constructor(data) {
    this.data = data;
    this.home();
  }
  get homeDistance() { return 3.9 * this.data.radius; }
  home() {
    Object.assign(this, { target: [...this.data.centre], yaw: -52, pitch: 20,
      distance: this.homeDistance });
  }
  // Sets the view along an axis: "x", "-x", ...; other names change nothing.
  along(name) {
    if (!(name in axisViews)) return;
    const [yaw, pitch] = axisViews[name];
    Object.assign(this, { target: [...this.data.centre], yaw, pitch });
  }
  // The name of the axis along which the camera looks, from its first distance; empty: none.
  name() {
    return Object.keys(axisViews).find((name) =>
      axisViews[name][0] === this.yaw && axisViews[name][1] === this.pitch &&
      this.distance === this.homeDistance &&
      this.target.every((v, k) => v === this.data.centre[k])) || "";
  }
  get eye() {
    const yaw = this.yaw * Math.PI / 180, pitch = this.pitch * Math.PI / 180;
    const flat = Math.cos(pitch);
    return add(this.target, times([flat * Math.cos(yaw), flat * Math.sin(yaw), Math.sin(pitch)],
      this.distance));
  }
  // The unit vectors right, up and back.
  get axes() { return axesOf(this.eye, this.target); }
  turn(dx, dy) {
    this.yaw -= dx;
    this.pitch = clamp(this.pitch + dy, -89.9, 89.9);
  }
  zoom(factor) {
    this.distance = clamp(this.distance * factor, 0.15 * this.data.radius, 20 * this.data.radius);
  }
  // Moves the picture by shares of its height.
  pan(dx, dy) {
    const [right, up] = this.axes;
    const size = 2 * this.distance * Math.tan(viewAngle / 2);
    this.target = add(this.target, add(times(right, -dx * size), times(up, dy * size)));
  }
  // The projection into a picture of a given width / height. Narrow pictures show the same width.
  matrix(aspect) {
    const near = Math.max(0.02 * this.distance, this.distance - 3 * this.data.radius);
    const far = this.distance + 6 * this.data.radius;
    return product(perspective(this.angle(aspect), aspect, near, far),
      looking(this.eye, this.target));
  }
  angle(aspect) {
    return aspect >= 1.25 ? viewAngle : 2 * Math.atan(Math.tan(viewAngle / 2) * 1.25 / aspect);
  }
}
