// The programs that run on the graphics card (GLSL ES 3). Colours are linear light, white = 1,
// until they are `finished`.

// The light: from one direction (`sun`), with shadows, and from all around.
const lightText = `
uniform highp sampler2DShadow shadow;
uniform vec3 sun, sunColour, around, eye;
uniform mat4 shadowMatrix;
// what lies outside the picture of shadows has none
float lit(vec3 p) {
  vec3 place = (shadowMatrix * vec4(p, 1.)).xyz * .5 + .5;
  vec3 inside = step(vec3(0.), place) * step(place, vec3(1.));
  return max(texture(shadow, place), 1. - inside.x * inside.y * inside.z);
}
vec3 ambient(vec3 n) { return around * (.54 + .46 * n.z) + (.13 - .06 * n.z) * vec3(1., .97, .93); }
// sRGB within 0.4 / 255, by roots alone
vec3 srgb(vec3 c) {
  vec3 a = sqrt(max(c, 0.)), b = sqrt(a), d = sqrt(b);
  return max(.585122381 * a + .783140355 * b - .368262736 * d, 0.);
}
vec4 finished(vec3 c, float alpha) { return vec4(srgb(c) * alpha, alpha); }
`;

// A body's pose from the texture of states.
const poseText = `
uniform highp sampler2D states;
vec3 turn(vec4 q, vec3 v) { return v + 2. * cross(q.yzw, cross(q.yzw, v) + q.x * v); }
void pose(uint g, out vec4 p, out vec4 q) {
  ivec2 at = ivec2(int(g & 511u) * 2, int(g >> 9));
  p = texelFetch(states, at, 0);
  q = texelFetch(states, at + ivec2(1, 0), 0);
}
`;

// Draws a corner of a grain, or with BALL the whole grain as a ball, which is one round point.
const grainVertex = poseText + `
uniform mat4 camera;
uniform highp sampler2D ramp;
uniform float scale;
uniform int picked;
flat out vec3 albedo;
flat out float chosen;
flat out uint number;
#ifdef BALL
layout(location = 0) in float size;
uniform float lens;  // pixels of a metre at distance 1
flat out vec3 place;
flat out float radius;
#else
layout(location = 0) in vec3 corner;
layout(location = 1) in uint lowGrain;
layout(location = 2) in vec3 normal;
layout(location = 3) in uint hidden;  // and the high bits of the grain's number: mesh.js
out vec3 place, edge;
flat out vec3 facing;
#endif
void main() {
  vec4 p, q;
#ifdef BALL
  uint grain = uint(gl_VertexID);
  pose(grain, p, q);
  place = p.xyz;
  radius = .5 * size;
  gl_PointSize = size * lens / (camera * vec4(place, 1.)).w;
#else
  uint grain = lowGrain | hidden >> 3 << 16;
  pose(grain, p, q);
  place = p.xyz + turn(q, corner * scale);
  facing = turn(q, normal);
  // how far from each edge: an edge inside a face is never near
  int c = gl_VertexID % 3;
  edge = vec3(c == 0, c == 1, c == 2);
  edge = max(edge, vec3((hidden & 1u) != 0u, (hidden & 2u) != 0u, (hidden & 4u) != 0u));
#endif
  number = grain + 1u;
  chosen = int(grain) == picked ? 1. : 0.;
  albedo = texelFetch(ramp, ivec2(int(clamp(p.w, 0., 1.) * 255. + .5), 0), 0).rgb;
  if (chosen > .5) albedo = vec3(.25, .9, .95);
  gl_Position = camera * vec4(place, 1.);
}`;

const grainFragment = `
flat in vec3 albedo;
flat in float chosen;
out vec4 colour;
` + lightText + `
uniform vec4 cut;
uniform float scale;
#ifdef BALL
flat in vec3 place;
flat in float radius;
uniform mat3 axes;  // the camera's right, up, back
vec3 facing;
float edgeShare() { return 0.; }
#else
in vec3 place, edge;
flat in vec3 facing;
const float radius = 0.;  // a place is on the surface
float edgeShare() {
  vec3 width = fwidth(edge), near = edge / max(width, 1e-4);
  float share = 1. - smoothstep(.3 + chosen, 1.5 + chosen, min(near.x, min(near.y, near.z)));
  // none where a face is a few pixels only
  return share * clamp(.55 / max(max(width.x, width.y), width.z) - 1.2, 0., 1.);
}
#endif
void main() {
#ifdef BALL
  vec2 spot = 2. * gl_PointCoord - 1.;
  float rest = 1. - dot(spot, spot);
  if (rest < 0.) discard;
  facing = axes * vec3(spot.x, -spot.y, sqrt(rest));
#endif
  float edges = edgeShare(), rim = max(dot(facing, normalize(eye - place)), 0.);
#ifdef CUT
  if (dot(cut.xyz, place) > cut.w) discard;
  if (!gl_FrontFacing) {
    // the back of a convex grain, seen through the cut, is its cut face
    vec3 d = place - eye, p = eye + d * ((cut.w - dot(cut.xyz, eye)) / dot(cut.xyz, d));
    float sunlit = lit(p + cut.xyz * .004) * max(dot(cut.xyz, sun), 0.);
    colour = finished(albedo * (ambient(cut.xyz) + sunlit * sunColour), 1.);
    return;
  }
#endif
#ifdef GHOST
  float away = 1. - rim;
  colour = finished(mix(albedo, around, .4), .03 + .2 * away * away + .12 * edges + .3 * chosen);
#else
  float edgewise = mix(.8, 1., smoothstep(0., .5, rim));
  float sunlit = lit(place + facing * (radius + scale * .02)) * max(dot(facing, sun), 0.);
  vec3 direct = sunlit * sunColour;
  vec3 c = albedo * (edgewise * (direct + ambient(facing)) + .08 * rim);
  colour = finished(c * (1. - .35 * edges), 1.);
#endif
}`;

// The number of the grain as a colour.
const numberFragment = `
flat in uint number;
#ifdef BALL
flat
#endif
in vec3 place;
uniform vec4 cut;
out vec4 colour;
void main() {
#ifdef BALL
  if (length(2. * gl_PointCoord - 1.) > 1.) discard;
#endif
#ifdef CUT
  if (dot(cut.xyz, place) > cut.w) discard;
#endif
  colour = vec4(number & 255u, number >> 8 & 255u, number >> 16, 255) / 255.;
}`;

// A polygon of a wall with a grid that moves with it, or the ground with its shadow.
const planeVertex = `
layout(location = 0) in vec3 corner;
layout(location = 1) in vec2 onPlane;
uniform mat4 camera;
out vec3 place;
out vec2 grid;
void main() {
  place = corner;
  grid = onPlane;
  gl_Position = camera * vec4(corner, 1.);
}`;
const planeFragment = `
in vec3 place;
in vec2 grid;
out vec4 colour;
` + lightText + `
uniform vec4 tint, cut;
uniform vec3 ground;  // centre and radius: the ground fades there
uniform float cell;
void main() {
#ifdef CUT
  if (ground.z == 0. && dot(cut.xyz, place) > cut.w) discard;
#endif
  if (ground.z > 0.) {
    // as bright as the paper where there is no shadow
    vec3 sky = ambient(vec3(0., 0., 1.)), all = sky + sun.z * sunColour;
    float share = (sky.g + lit(place + vec3(0., 0., .002)) * sun.z * sunColour.g) / all.g;
    float fade = 1. - smoothstep(.3, 1., length(place.xy - ground.xy) / ground.z);
    colour = finished(tint.rgb * mix(1., share, .8), fade);
    return;
  }
  vec2 width = fwidth(grid) / cell, near = abs(fract(grid / cell - .5) - .5) / max(width, 1e-4);
  float line = (1. - smoothstep(.2, 1.3, min(near.x, near.y))) *
      clamp(.4 / max(width.x, width.y) - 1., 0., 1.);
  colour = finished(tint.rgb, clamp(tint.a * (1. + 1.2 * line), 0., .9));
}`;

// A rod between two balls of any radii: chains, points, edges, arrows. Negative radii are pixels.
// The rod is drawn as a rectangle that faces the eye.
const rodsInRow = 256;  // rods in a row of their texture, three texels each
const rodVertex = `
uniform highp sampler2D rods;
uniform mat4 camera;
uniform vec2 pixels;
uniform float lens;
flat out float span;
flat out vec2 radii;
flat out vec4 hue;
out vec2 spot;  // along the rod from its first end and across it [pixels]
void main() {
  // six corners of two triangles: x 0 at the first end, 1 at the other; y -1 or 1 across
  int c = gl_VertexID % 6, rod = gl_VertexID / 6;
  vec2 side = vec2(c == 1 || c == 2 || c == 4, c == 2 || c == 4 || c == 5 ? 1 : -1);
  ivec2 place = ivec2(rod % ${rodsInRow} * 3, rod / ${rodsInRow});
  vec4 from = texelFetch(rods, place, 0), to = texelFetch(rods, place + ivec2(1, 0), 0);
  hue = texelFetch(rods, place + ivec2(2, 0), 0);
  vec4 a = camera * vec4(from.xyz, 1.), b = camera * vec4(to.xyz, 1.);
  vec2 s = (a.xy / a.w * .5 + .5) * pixels, t = (b.xy / b.w * .5 + .5) * pixels;
  radii = vec2(from.w < 0. ? -from.w : max(from.w * lens / a.w, .6),
               to.w < 0. ? -to.w : max(to.w * lens / b.w, .6));
  float reach = max(radii.x, radii.y) + 1.;
  vec2 along = length(t - s) > 1e-3 ? normalize(t - s) : vec2(1., 0.);
  vec2 across = vec2(-along.y, along.x);
  span = length(t - s);
  spot = vec2(mix(-reach, span + reach, side.x), side.y * reach);
  vec4 middle = side.x < .5 ? a : b;
  // without perspective, so that spot is linear in the picture
  gl_Position = a.w <= 0. || b.w <= 0. ? vec4(2., 2., 2., 1.)
      : vec4((s + along * spot.x + across * spot.y) / pixels * 2. - 1., middle.z / middle.w, 1.);
}`;
const rodFragment = lightText + `
flat in float span;
flat in vec2 radii;
flat in vec4 hue;
in vec2 spot;
out vec4 colour;
void main() {
  float on = clamp(spot.x, 0., span), radius = mix(radii.x, radii.y, on / max(span, 1e-3));
  float away = length(vec2(spot.x - on, spot.y)), alpha = clamp(radius - away + .5, 0., 1.);
  if (alpha <= 0.) discard;
  // round, lit from where the eye is
  float light = .55 + .45 * sqrt(max(0., 1. - away * away / (radius * radius)));
  colour = vec4(srgb(hue.rgb * (radius < 1.6 ? 1. : light)), alpha * hue.a);
}`;

const programTexts = { grain: [grainVertex, grainFragment], number: [grainVertex, numberFragment],
  plane: [planeVertex, planeFragment], rod: [rodVertex, rodFragment] };
