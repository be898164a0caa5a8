// Where light comes from. At rest a picture is the mean of many, each lit by one direction of the
// sun or the sky and shifted by part of a pixel: soft shadows and smooth edges in one.

const sunTo = unit([0.42, -0.5, 0.76]);
const sunColour = [0.80, 0.77, 0.71], skyColour = [0.47, 0.495, 0.53];
const restSamples = (software) => software ? 24 : 64;

// What a free level plane gets: the ground is as bright as the page there.
const freeLight = sunColour[1] * sunTo[2] + skyColour[1] + 0.07;

// While something moves: the sun alone with its shadow, and the sky from all sides.
const quickLight = () => ({ to: sunTo, colour: sunColour, around: times(skyColour, 0.86) });

// Light of sample k: every third is the sun, which is 5 degrees wide. The others are the sky.
// Places on them by Roberts' sequence, which fills evenly however early it ends.
function sampleLight(k) {
  const a = (0.5 + 0.7548776662 * (k + 1)) % 1, b = (0.5 + 0.5698402910 * (k + 1)) % 1;
  const angle = 2 * Math.PI * a, none = [0, 0, 0];
  if (k % 3 === 0) {
    const side = perpendicular(sunTo), other = cross(sunTo, side), wide = 0.09 * Math.sqrt(b);
    const to = unit(add(sunTo, add(times(side, wide * Math.cos(angle)),
      times(other, wide * Math.sin(angle)))));
    return { to, colour: times(sunColour, 3), around: none };
  }
  const z = 0.03 + 0.97 * b, flat = Math.sqrt(1 - z * z);
  return { to: [flat * Math.cos(angle), flat * Math.sin(angle), z],
    colour: times(skyColour, 2 * 1.5), around: none };
}

// The part of a pixel by which sample k is shifted.
const sampleShift = (k) => [(0.5 + 0.7548776662 * (k + 7)) % 1 - 0.5,
  (0.5 + 0.5698402910 * (k + 7)) % 1 - 0.5];

// Looks from the light at all there is.
function lightMatrix(to, data) {
  const reach = 1.02 * data.radius;
  return product(orthographic(reach, 0, 4 * reach),
    looking(add(data.centre, times(to, 2 * reach)), data.centre));
}
