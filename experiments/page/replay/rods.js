// Rods between balls, many in one call: chains, contact points, normals, edges, arrows.

class Rods {
  constructor(stage) {
    this.stage = stage;
    this.rows = this.count = 0;
  }

  // `rods`: 12 numbers each: from and its radius, to and its radius, colour.
  set(rods) {
    const gl = this.stage.gl;
    this.count = rods.length / 12;
    const rows = Math.ceil(this.count / rodsInRow);
    if (rows > this.rows) {
      this.rows = 2 * rows;
      gl.deleteTexture(this.texture ?? null);
      this.texture = this.stage.texture("rods", gl.RGBA32F, 3 * rodsInRow, this.rows);
      this.numbers = new Float32Array(12 * rodsInRow * this.rows);
    }
    if (!rows) return;
    this.numbers.set(rods);
    gl.activeTexture(gl.TEXTURE0 + slots.rods);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 3 * rodsInRow, rows, gl.RGBA, gl.FLOAT, this.numbers);
  }

  // Two triangles each. Not by instances: software draws every instance as if by a call of its own.
  draw(light, look, camera, encode, width, height) {
    if (!this.count) return;
    const { gl } = this.stage, at = this.stage.use("rod");
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform2f(at.pixels, width, height);
    gl.uniform1f(at.lens, 0.5 * height / Math.tan(look.camera.angle(width / height) / 2));
    gl.uniform1i(at.encode, encode ? 1 : 0);
    gl.bindVertexArray(this.stage.nothing);
    gl.enable(gl.BLEND);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.count);
  }
}

// Appends a rod to a list of numbers.
const addRod = (rods, from, fromRadius, to, toRadius, colour, alpha = 1) =>
  rods.push(...from, fromRadius, ...to, toRadius, ...colour, alpha);
