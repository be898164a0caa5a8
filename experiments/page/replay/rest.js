// When a picture is drawn: one quick one while things move, the mean of many when all is at rest.

// Draws at once. `again`: in motion shadows and the list of seen grains may be some frames old.
function drawQuick(stage, look, again) {
  const light = quickLight(), isSolid = look.grains === "solid";
  const isHasty = again && stage.software && !look.cut;
  stage.age = isHasty && stage.wasSolid === isSolid ? (stage.age || 0) + 1 : 0;
  stage.wasSolid = isSolid;
  // behind glass grains are seen, too, and they throw no shadow
  if (stage.age % 8 === 0) {
    stage.seen = null;
    stage.listVisible(look, null);
    if (isHasty && isSolid) stage.findSeen(look);
  }
  if (stage.age === 0 || (isSolid && stage.age % 8 === 4)) stage.drawShadow(light, look);
  stage.listVisible(look, stage.seen);
  stage.drawAll(light, look, null, look.camera.matrix(stage.aspect), true);
  stage.samples = 0;
}

// Adds samples to the resting picture and shows it when it is better than the quick one. False:
// it is as good as it gets.
function drawResting(stage, look, count) {
  const { gl, canvas } = stage, { width, height } = canvas, most = restSamples(stage.software);
  if (!stage.canRest || stage.samples >= most) return false;
  if (!stage.sum) {
    stage.sample = stage.target(width, height, gl.RGBA16F);
    stage.sum = stage.target(width, height, gl.RGBA16F);
  }
  if (stage.samples === 0) {
    stage.listVisible(look, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, stage.sum.frame);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }
  for (; count > 0 && stage.samples < most; --count) {
    const light = sampleLight(stage.samples), shift = sampleShift(stage.samples++);
    stage.drawShadow(light, look);
    stage.drawAll(light, look, stage.sample, look.camera.matrix(stage.aspect,
      [2 * shift[0] / width, 2 * shift[1] / height]), false);
    copyPicture(stage, stage.sample, stage.sum, 1, false);
  }
  if (stage.samples >= 9 || !stage.software)
    copyPicture(stage, stage.sum, null, 1 / stage.samples, true);
  return true;
}

// A whole picture times `gain`, added to a target or shown.
function copyPicture(stage, from, to, gain, encode) {
  const { gl, canvas } = stage, at = stage.use("copy");
  gl.bindFramebuffer(gl.FRAMEBUFFER, to ? to.frame : null);
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.activeTexture(gl.TEXTURE0 + slots.picture);
  gl.bindTexture(gl.TEXTURE_2D, from.texture);
  gl.uniform1f(at.gain, gain);
  gl.uniform1i(at.encode, encode ? 1 : 0);
  gl.bindVertexArray(stage.nothing);
  gl.disable(gl.DEPTH_TEST);
  if (to) gl.enable(gl.BLEND); else gl.disable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.enable(gl.DEPTH_TEST);
}
