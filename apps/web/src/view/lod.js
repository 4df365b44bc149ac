// A mesh with fewer triangles, to be drawn while things move: vertices in one cell of a grid become one, their mean.
const maxTrials = 10;
const keySide = 2 ** 17; // cells a side that a key tells apart

function clustered(positions, indices, low, cell) {
  const cells = new Map();
  const of = new Uint32Array(positions.length / 3);
  const sums = [];
  for (let v = 0; v < of.length; ++v) {
    let key = 0;
    for (let k = 0; k < 3; ++k) key = key * keySide + Math.floor((positions[3 * v + k] - low[k]) / cell);
    let c = cells.get(key);
    if (c === undefined) cells.set(key, (c = sums.push([0, 0, 0, 0]) - 1));
    of[v] = c;
    for (let k = 0; k < 3; ++k) sums[c][k] += positions[3 * v + k];
    ++sums[c][3];
  }
  const kept = [];
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [of[indices[i]], of[indices[i + 1]], of[indices[i + 2]]];
    if (a !== b && b !== c && c !== a) kept.push(a, b, c);
  }
  return { positions: Float32Array.from(sums.flatMap((s) => [s[0] / s[3], s[1] / s[3], s[2] / s[3]])), indices: Uint32Array.from(kept) };
}

// At most `most` triangles; the mesh itself when it has no more.
export function coarseMesh(positions, indices, most) {
  if (indices.length <= 3 * most) return { positions, indices };
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  const side = Math.max(...high.map((v, k) => v - low[k]));
  let [coarse, fine] = [side, side / 1024];
  let best = clustered(positions, indices, low, coarse);
  for (let i = 0; i < maxTrials; ++i) {
    const cell = Math.sqrt(coarse * fine);
    const next = clustered(positions, indices, low, cell);
    if (next.indices.length <= 3 * most) [best, coarse] = [next, cell];
    else fine = cell;
    if (best.indices.length > 2.2 * most) break; // near enough
  }
  return best;
}
