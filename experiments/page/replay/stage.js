// One canvas and all that is drawn into it with WebGL 2.

const slots = { states: 0, ramp: 1, shadow: 2, rods: 3 };  // texture units
const shadowSize = 2048, numberSize = 512;

// The light: the sun, which casts shadows, and the sky from all sides.
const light = { sun: unit([0.42, -0.5, 0.76]), sunColour: [0.80, 0.77, 0.71],
  around: [0.404, 0.426, 0.456] };

class Stage {
  constructor(canvas, data, mesh) {
    this.canvas = canvas;
    this.data = data;
    this.mesh = mesh;
    const gl = this.gl = canvas.getContext("webgl2",
      { antialias: true, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("this browser gives no WebGL 2");
    this.programs = new Map();
    this.end = null;  // marks the end of the last picture's commands
    this.upload();
  }

  // Uses a program with its switches ("CUT", "GHOST", "BALL"), made on first use. Returns uniforms.
  use(name, ...switches) {
    const gl = this.gl, key = [name, ...switches].join(" ");
    if (!this.programs.has(key)) {
      const program = gl.createProgram(), head = "#version 300 es\nprecision highp float;\n" +
        "precision highp int;\nprecision highp sampler2DShadow;\n" +
        switches.map((s) => "#define " + s + "\n").join("");
      [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((type, k) => {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, head + programTexts[name][k]);
        gl.compileShader(shader);
        const log = gl.getShaderInfoLog(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(key + ": " + log);
        gl.attachShader(program, shader);
      });
      gl.linkProgram(program);
      if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        throw new Error(key + ": " + gl.getProgramInfoLog(program));
      const at = {};
      for (let k = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k-- > 0;) {
        const { name: uniform } = gl.getActiveUniform(program, k);
        at[uniform] = gl.getUniformLocation(program, uniform);
      }
      gl.useProgram(program);
      for (const [slot, place] of Object.entries(slots))
        if (at[slot]) gl.uniform1i(at[slot], place);
      this.programs.set(key, { program, at });
    }
    const found = this.programs.get(key);
    gl.useProgram(found.program);
    return found.at;
  }

  texture(slot, format, width, height) {
    const gl = this.gl, texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + slots[slot]);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    return texture;
  }
  fill(slot, width, height, numbers) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + slots[slot]);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, numbers);
  }

  // A buffer of corners with its layout: [location, numbers, type, offset, are they integers].
  vertices(bytes, stride, layout) {
    const gl = this.gl, array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    if (bytes) gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
    for (const [place, numbers, type, offset, whole] of layout) {
      gl.enableVertexAttribArray(place);
      if (whole) gl.vertexAttribIPointer(place, numbers, type, stride, offset);
      else gl.vertexAttribPointer(place, numbers, type, type !== gl.FLOAT, stride, offset);
    }
    return { array, buffer };
  }

  upload() {
    const gl = this.gl;
    this.balls = this.vertices(this.data.size, 4, [[0, 1, gl.FLOAT, 0]]);
    this.planes = this.vertices(null, 20, [[0, 3, gl.FLOAT, 0], [1, 2, gl.FLOAT, 12]]);
    this.nothing = gl.createVertexArray();
    this.texture("states", gl.RGBA32F, 1024, this.data.state.length / 4096);
    this.texture("ramp", gl.RGBA32F, 256, 1);
    // the shadow map: the distance of the first surface seen from the sun
    const depth = this.texture("shadow", gl.DEPTH_COMPONENT24, shadowSize, shadowSize);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    this.shadowTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    gl.drawBuffers([gl.NONE]);
    gl.readBuffer(gl.NONE);
    const reach = 1.02 * this.data.radius, { centre } = this.data;
    this.shadowLens = 0.5 * shadowSize / reach;
    this.shadowMatrix = product(orthographic(reach, 0, 4 * reach),
      looking(add(centre, times(light.sun, 2 * reach)), centre));
    this.rodRows = this.rods = 0;
    // for picking: the numbers of grains, without smoothing, which would mix them
    this.numberTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.numberTarget);
    for (const [place, format] of [[gl.COLOR_ATTACHMENT0, gl.RGBA8],
      [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]]) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, numberSize, numberSize);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
  }

  resize(quality) {
    const { canvas } = this, ratio = Math.min(window.devicePixelRatio || 1, 2) * quality;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
  }
  get aspect() { return this.canvas.width / this.canvas.height; }

  // `rods` has 12 numbers for each rod: start and its radius, end and its radius, colour.
  setRods(rods) {
    const gl = this.gl, rows = Math.ceil(rods.length / 12 / rodsInRow);
    this.rods = rods.length / 12;
    if (rows > this.rodRows) {
      this.rodRows = 2 * rows;
      gl.deleteTexture(this.rodTexture ?? null);
      this.rodTexture = this.texture("rods", gl.RGBA32F, 3 * rodsInRow, this.rodRows);
      this.rodNumbers = new Float32Array(12 * rodsInRow * this.rodRows);
    }
    if (!rows) return;
    this.rodNumbers.set(rods);
    this.fill("rods", 3 * rodsInRow, rows, this.rodNumbers);
  }

  // Uses a program for lit surfaces, seen by a look's camera; returns its uniforms.
  lit(name, look, switches) {
    const gl = this.gl, at = this.use(name, ...look.cut ? ["CUT"] : [], ...switches);
    for (const [name, value] of Object.entries({ ...light, eye: look.camera.eye }))
      gl.uniform3fv(at[name], value);
    gl.uniformMatrix4fv(at.shadowMatrix, false, this.shadowMatrix);
    gl.uniformMatrix4fv(at.camera, false, look.camera.matrix(this.aspect));
    if (at.cut) gl.uniform4fv(at.cut, look.cut);
    return at;
  }
  lens(camera) {
    return 0.5 * this.canvas.height / Math.tan(camera.angle(this.aspect) / 2);
  }

  // Draws all grains by a program: their corners, or each grain as one ball (look.balls). A metre
  // of a ball has `lens` pixels at distance 1.
  drawBodies(at, look, lens) {
    const { gl } = this;
    gl.uniform1f(at.scale, this.data.head.scale);
    if (look.balls) {
      gl.uniform1f(at.lens, lens);
      gl.bindVertexArray(this.balls.array);
      gl.drawArrays(gl.POINTS, 0, this.data.grains);
      return;
    }
    this.grains ??= this.vertices(this.mesh.bytes, 12, [[0, 3, gl.SHORT, 0],
      [1, 1, gl.UNSIGNED_SHORT, 6, true], [2, 3, gl.BYTE, 8], [3, 1, gl.UNSIGNED_BYTE, 11, true]]);
    gl.bindVertexArray(this.grains.array);
    gl.drawArrays(gl.TRIANGLES, 0, this.mesh.corners);
  }

  // Draws the grains' numbers as colours, and their depths.
  drawNumbers(camera, look, lens) {
    const gl = this.gl, at = this.use("number", ...look.cut ? ["CUT"] : [],
      ...look.balls ? ["BALL"] : []);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(at.camera, false, camera);
    if (at.cut) gl.uniform4fv(at.cut, look.cut);
    if (look.grains !== "hidden") this.drawBodies(at, look, lens);
  }

  // The grain seen at a place of the picture, which has unit size, y downward; -1: none.
  pick(look, x, y) {
    const { gl } = this, pixel = new Uint8Array(4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.numberTarget);
    gl.viewport(0, 0, numberSize, numberSize);
    this.drawNumbers(look.camera.matrix(this.aspect), { ...look, balls: false });
    gl.readPixels(Math.floor(x * numberSize), Math.floor((1 - y) * numberSize), 1, 1, gl.RGBA,
      gl.UNSIGNED_BYTE, pixel);
    return (pixel[0] | pixel[1] << 8 | pixel[2] << 16) - 1;
  }

  drawGrains(look) {
    if (look.grains === "hidden") return;
    const gl = this.gl, ghost = look.grains === "ghost";
    const at = this.lit("grain", look, [...ghost ? ["GHOST"] : [], ...look.balls ? ["BALL"] : []]);
    gl.uniform1i(at.picked, look.picked);
    if (look.balls) gl.uniformMatrix3fv(at.axes, false, look.camera.axes.flat());
    gl.depthMask(!ghost);
    if (ghost) gl.enable(gl.BLEND); else gl.disable(gl.BLEND);
    if (!look.cut) gl.enable(gl.CULL_FACE);  // with a cut the back of a grain is its cut face
    this.drawBodies(at, look, this.lens(look.camera));
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
  }

  // Draws the ground or the walls: polygons of look.planes.
  drawPlanes(look, isGround) {
    const gl = this.gl, at = this.lit("plane", look, []);
    gl.bindVertexArray(this.planes.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.planes.buffer);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.uniform1f(at.cell, look.cell);
    for (const plane of look.planes) {
      if (!!plane.ground !== isGround) continue;
      gl.uniform4fv(at.tint, plane.tint);
      gl.uniform3fv(at.ground, plane.ground || [0, 0, 0]);
      gl.bufferData(gl.ARRAY_BUFFER, plane.corners, gl.STREAM_DRAW);
      gl.drawArrays(gl.TRIANGLE_FAN, 0, plane.corners.length / 5);
    }
    gl.depthMask(true);
  }

  drawRods({ camera }) {
    if (!this.rods) return;
    const { gl, canvas: { width, height } } = this, at = this.use("rod");
    gl.uniformMatrix4fv(at.camera, false, camera.matrix(this.aspect));
    gl.uniform2f(at.pixels, width, height);
    gl.uniform1f(at.lens, this.lens(camera));
    gl.bindVertexArray(this.nothing);
    gl.disable(gl.BLEND);
    gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);  // smooth edges that hide everything behind
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.rods);
    gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
  }

  // Draws a picture. `ramp` has the colours of the bodies' values.
  draw(look, ramp) {
    const { gl, canvas, data: { state } } = this, solid = look.grains === "solid";
    this.fill("states", 1024, state.length / 4096, state);
    this.fill("ramp", 256, 1, ramp);
    this.setRods(look.rods);
    // The shadow map is kept while only the camera moves; glass casts no shadow.
    const cast = solid ? [this.data.now, look.balls, ...look.cut || []].join() : "none";
    if (cast !== this.cast) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
      gl.viewport(0, 0, shadowSize, shadowSize);
      this.drawNumbers(this.shadowMatrix, solid ? look : { ...look, grains: "hidden" },
        this.shadowLens);
      this.cast = cast;
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...look.paper.map(toSrgb), 1);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawPlanes(look, true);
    if (solid) this.drawGrains(look);
    this.drawRods(look);
    if (!solid) this.drawGrains(look);
    this.drawPlanes(look, false);
    gl.deleteSync(this.end);
    this.end = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
  }

  // Whether the last picture is still being drawn.
  isBusy() {
    const { gl, end } = this;
    return end !== null && gl.getSyncParameter(end, gl.SYNC_STATUS) !== gl.SIGNALED;
  }
}
