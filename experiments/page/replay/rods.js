// Rods between balls, many in one call: chains, contact points, normals, edges, arrows.

class Rods {
  constructor(stage) {
    this.stage = stage;
    const gl = stage.gl;
    const corners = new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]);
    ({ array: this.array } = stage.vertices(corners, 8, [[0, 2, gl.FLOAT, 0]]));
    this.buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const place of [1, 2, 3]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 4, gl.FLOAT, false, 48, 16 * (place - 1));
      gl.vertexAttribDivisor(place, 1);
    }
  }

  // `rods`: 12 numbers each: from and its radius, to and its radius, colour.
  set(rods) {
    const gl = this.stage.gl;
    this.count = rods.length / 12;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(rods), gl.DYNAMIC_DRAW);
  }

  draw(light, look, camera, encode, width, height) {
    if (!this.count) return;
    const { gl } = this.stage, at = this.stage.use("rod");
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform2f(at.pixels, width, height);
    gl.uniform1f(at.lens, 0.5 * height / Math.tan(look.camera.angle(width / height) / 2));
    gl.uniform1i(at.encode, encode ? 1 : 0);
    gl.bindVertexArray(this.array);
    gl.enable(gl.BLEND);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
  }
}

// Appends a rod to a list of numbers.
const addRod = (rods, from, fromRadius, to, toRadius, colour, alpha = 1) =>
  rods.push(...from, fromRadius, ...to, toRadius, ...colour, alpha);
