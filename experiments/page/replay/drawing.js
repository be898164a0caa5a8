// One canvas and all that is drawn into it with WebGL 2.

const slots = { states: 0, ramp: 1, shadow: 2, picture: 3, rods: 4 };  // texture units

class Stage {
  constructor(canvas, data, mesh) {
    this.canvas = canvas;
    this.data = data;
    this.mesh = mesh;
    const gl = this.gl = canvas.getContext("webgl2",
      { antialias: false, alpha: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("this browser gives no WebGL 2");
    const facts = gl.getExtension("WEBGL_debug_renderer_info");
    this.renderer = facts ? gl.getParameter(facts.UNMASKED_RENDERER_WEBGL) : "";
    this.software = /swiftshader|llvmpipe|software|basic render/i.test(this.renderer);
    this.canRest = !!(gl.getExtension("EXT_color_buffer_float") ||
      gl.getExtension("EXT_color_buffer_half_float"));
    this.programs = new Map();
    this.samples = 0;
    this.upload();
  }

  // A program with its switches ("CUT", "GHOST"), made when it is first needed.
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

  // A buffer of corners with its layout: [place, numbers, type, offset, is it whole numbers].
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
    this.grains = this.vertices(this.mesh.bytes, 12, [[0, 3, gl.SHORT, 0],
      [1, 1, gl.UNSIGNED_SHORT, 6, true], [2, 3, gl.BYTE, 8], [3, 1, gl.UNSIGNED_BYTE, 11, true]]);
    this.indices = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.mesh.index.byteLength, gl.DYNAMIC_DRAW);
    this.planes = this.vertices(null, 20, [[0, 3, gl.FLOAT, 0], [1, 2, gl.FLOAT, 12]]);
    this.rods = new Rods(this);
    this.nothing = gl.createVertexArray();
    this.texture("states", gl.RGBA32F, 1024, this.data.state.length / 4096);
    this.texture("ramp", gl.RGBA32F, 256, 1);
    // the shadow: how far the light's first surface is
    const size = this.shadowSize = this.software ? 768 : 2048;
    const depth = this.texture("shadow", gl.DEPTH_COMPONENT24, size, size);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, name, this.software ? gl.NEAREST : gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    this.shadowTarget = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    gl.drawBuffers([gl.NONE]);
    gl.readBuffer(gl.NONE);
    this.numbers = this.target(480, 320, gl.RGBA8);
  }

  // Something to draw into, with depth.
  target(width, height, format) {
    const gl = this.gl, texture = this.texture("picture", format, width, height);
    const frame = gl.createFramebuffer(), depth = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    return { texture, frame, depth, width, height };
  }
  free({ texture, frame, depth }) {
    this.gl.deleteTexture(texture);
    this.gl.deleteFramebuffer(frame);
    this.gl.deleteRenderbuffer(depth);
  }

  // The canvas gets so many pixels for each of the page's.
  resize(quality) {
    const { canvas } = this, ratio = Math.min(window.devicePixelRatio || 1, 2) * quality;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width === width && canvas.height === height) return;
    canvas.width = width;
    canvas.height = height;
    for (const target of [this.sample, this.sum]) if (target) this.free(target);
    this.sample = this.sum = null;
    this.samples = 0;
  }
  get aspect() { return this.canvas.width / this.canvas.height; }

  // The bodies stand elsewhere, or have other colours. `seen` is out of date a little later.
  moved(ramp) {
    const gl = this.gl, state = this.data.state;
    gl.activeTexture(gl.TEXTURE0 + slots.states);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 1024, state.length / 4096, gl.RGBA, gl.FLOAT, state);
    gl.activeTexture(gl.TEXTURE0 + slots.ramp);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 256, 1, gl.RGBA, gl.FLOAT, ramp);
    this.samples = 0;
  }

  setLight(at, light, look, encode) {
    const gl = this.gl;
    if (at.sun) gl.uniform3fv(at.sun, light.to);
    gl.uniform3fv(at.sunColour, light.colour);
    gl.uniform3fv(at.around, light.around);
    gl.uniform3fv(at.eye, look.camera.eye);
    gl.uniformMatrix4fv(at.shadowMatrix, false, this.shadowMatrix);
    gl.uniform1i(at.encode, encode ? 1 : 0);
    if (at.cut) gl.uniform4fv(at.cut, look.cut || [0, 0, 0, 1e9]);
  }

  drawShadow(light, look) {
    const gl = this.gl, cut = look.cut ? ["CUT"] : [], at = this.use("number", ...cut);
    this.shadowMatrix = lightMatrix(light.to, this.data);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowTarget);
    gl.viewport(0, 0, this.shadowSize, this.shadowSize);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (look.grains !== "solid") return;
    gl.uniformMatrix4fv(at.camera, false, this.shadowMatrix);
    gl.uniform1f(at.scale, this.data.head.scale);
    if (at.cut) gl.uniform4fv(at.cut, look.cut);
    gl.bindVertexArray(this.grains.array);
    gl.drawArrays(gl.TRIANGLES, 0, this.mesh.corners);
  }

  drawGrains(light, look, camera, encode) {
    if (look.grains === "hidden") return;
    const gl = this.gl, ghost = look.grains === "ghost";
    const plain = look.isHasty && !look.cut && encode;
    const switches = [...look.cut ? ["CUT"] : [], ...ghost ? ["GHOST"] : [],
      ...plain ? ["PLAIN"] : []];
    const at = this.use("grain", ...switches);
    this.setLight(at, light, look, encode);
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform1f(at.scale, this.data.head.scale);
    gl.uniform1i(at.picked, look.picked);
    gl.bindVertexArray(this.grains.array);
    gl.depthMask(!ghost);
    if (ghost) gl.enable(gl.BLEND); else gl.disable(gl.BLEND);
    if (look.cut) gl.drawArrays(gl.TRIANGLES, 0, this.mesh.corners);
    else gl.drawElements(gl.TRIANGLES, this.visibleCorners, gl.UNSIGNED_INT, 0);
    gl.depthMask(true);
  }

  // Ground, walls: polygons of look.planes.
  drawPlanes(light, look, camera, encode, isGround) {
    // where software draws, walls have no grid while things move
    const switches = [...look.cut ? ["CUT"] : [], ...look.isHasty ? ["PLAIN"] : []];
    const gl = this.gl, at = this.use("plane", ...switches);
    this.setLight(at, light, look, encode);
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform1f(at.free, light.around[0] ? sunColour[1] * sunTo[2] + light.around[1] + 0.07 :
      freeLight);
    gl.bindVertexArray(this.planes.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.planes.buffer);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    for (const plane of look.planes) {
      if (!!plane.ground !== isGround) continue;
      gl.uniform4fv(at.tint, plane.tint);
      gl.uniform3fv(at.ground, plane.ground || [0, 0, 0]);
        gl.bufferData(gl.ARRAY_BUFFER, plane.corners, gl.STREAM_DRAW);
      gl.drawArrays(gl.TRIANGLE_FAN, 0, plane.corners.length / 5);
    }
    gl.depthMask(true);
  }

  drawAll(light, look, target, camera, encode) {
    const gl = this.gl, width = target ? target.width : this.canvas.width;
    const height = target ? target.height : this.canvas.height;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target ? target.frame : null);
    gl.viewport(0, 0, width, height);
    const paper = encode ? look.paper.map(toSrgb) : look.paper;
    gl.clearColor(...paper, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const solid = look.grains === "solid";
    // the ground has the paper's colour where there is no shadow
    if (solid || !look.isHasty) this.drawPlanes(light, look, camera, encode, true);
    if (solid) this.drawGrains(light, look, camera, encode);
    this.rods.draw(light, look, camera, encode, width, height);
    if (!solid) this.drawGrains(light, look, camera, encode);
    this.drawPlanes(light, look, camera, encode, false);
  }

  // Which grains can be seen, found on a small picture of their numbers. Where software draws,
  // this halves the work of the frames that follow.
  findSeen(look) {
    const gl = this.gl, { frame, width, height } = this.numbers, at = this.use("number");
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(at.camera, false, look.camera.matrix(this.aspect));
    gl.uniform1f(at.scale, this.data.head.scale);
    gl.bindVertexArray(this.grains.array);
    gl.drawElements(gl.TRIANGLES, this.visibleCorners, gl.UNSIGNED_INT, 0);
    const pixels = new Uint8Array(4 * width * height), seen = new Uint8Array(this.data.grains);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    for (let k = 0; k < pixels.length; k += 4)
      if (pixels[k + 3]) seen[(pixels[k] | pixels[k + 1] << 8) - 1] = 1;
    this.seen = seen;
  }

  listVisible(look, seen) {
    const gl = this.gl;
    this.visibleCorners = look.cut ? 0 : this.mesh.visible(look.camera.eye, seen);
    gl.bindVertexArray(this.grains.array);
    gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 0, this.mesh.index, 0, this.visibleCorners);
  }
}
