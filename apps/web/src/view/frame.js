// A frame as apps/view/wire.cpp writes it: a row of floats, then its pairs and contact forces.
export const frameFloats = 34;
export const pairFloats = 8;
export const forceFloats = 11;

// As LagReason (tegotae/core/lag_reason.hpp) numbers them, in the flags from this bit on.
export const lagReasons = ["", "held by contacts", "out of time", "no motion proved free", "not following the pen"];
const lagShift = 8;

// Of the held part, and of the other one.
const featureNames = ["corner", "edge", "face"];
const featurePairs = 9;
const featuresOf = (number) => [featureNames[number % 3], featureNames[Math.floor(number / 3)]];

const flagNames = { touching: 1, cut: 2, overflow: 4, forceOn: 8, waiting: 16 };

// `forces` begin after the pairs where they are not given.
export function readFrame(row, pairs, forces = pairs.subarray(row[31] * pairFloats)) {
  const numbers = (at, count) => Array.from(row.subarray(at, at + count));
  const flags = row[29];
  const frame = {
    tick: row[0] * 2 ** 20 + row[1],
    t: row[2] + row[3],
    x: numbers(4, 7),
    y: numbers(11, 7),
    force: numbers(18, 3),
    torque: numbers(21, 3),
    gap: row[24],
    tickUs: row[25],
    lateUs: row[26],
    contacts: row[27],
    limits: row[28],
    reason: row[30],
    generation: row[32],
    lagReason: flags >> lagShift,
    pairs: [],
    forces: [],
  };
  for (const [name, bit] of Object.entries(flagNames)) frame[name] = (flags & bit) !== 0;
  for (let i = 0; i < row[31]; ++i) {
    const at = i * pairFloats;
    frame.pairs.push({
      point: Array.from(pairs.subarray(at, at + 3)),
      normal: Array.from(pairs.subarray(at + 3, at + 6)),
      gap: pairs[at + 6],
      part: Math.floor(pairs[at + 7] / (2 * featurePairs)),
      features: featuresOf(Math.floor(pairs[at + 7] / 2) % featurePairs),
      touching: pairs[at + 7] % 2 === 1,
    });
  }
  for (let i = 0; i < row[33]; ++i) {
    const at = i * forceFloats;
    const [point, normal, friction] = [0, 3, 6].map((k) => Array.from(forces.subarray(at + k, at + k + 3)));
    const force = normal.map((v, k) => v + friction[k]);
    frame.forces.push({ point, normal, friction, force, mu: forces[at + 9], slides: forces[at + 10] > 0 });
  }
  return frame;
}

export const norm = (v) => Math.hypot(...v);
// Between the origins of two poses.
export const distance = (a, b) => norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
