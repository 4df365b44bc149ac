// From shared vertices to what looks right: normals that are smooth where the surface is, and lines where it is not.
const smoothCosine = Math.cos((32 * Math.PI) / 180);
const edgeCosine = Math.cos((24 * Math.PI) / 180);
const maxFaces = 512; // at a vertex; a hub of more keeps its flat normals

function faceNormals(positions, indices) {
  const normals = new Float32Array(indices.length); // twice the area long
  for (let f = 0; f < indices.length; f += 3) {
    const [a, b, c] = [3 * indices[f], 3 * indices[f + 1], 3 * indices[f + 2]];
    const u = [positions[b] - positions[a], positions[b + 1] - positions[a + 1], positions[b + 2] - positions[a + 2]];
    const v = [positions[c] - positions[a], positions[c + 1] - positions[a + 1], positions[c + 2] - positions[a + 2]];
    normals[f] = u[1] * v[2] - u[2] * v[1];
    normals[f + 1] = u[2] * v[0] - u[0] * v[2];
    normals[f + 2] = u[0] * v[1] - u[1] * v[0];
  }
  return normals;
}

const cosine = (n, f, g) => {
  const dot = n[f] * n[g] + n[f + 1] * n[g + 1] + n[f + 2] * n[g + 2];
  return dot / (Math.hypot(n[f], n[f + 1], n[f + 2]) * Math.hypot(n[g], n[g + 1], n[g + 2]) || 1);
};

// The corners that meet at each vertex, one list after the other.
function cornersAt(indices, vertexCount) {
  const begin = new Uint32Array(vertexCount + 1);
  for (const v of indices) ++begin[v + 1];
  for (let v = 0; v < vertexCount; ++v) begin[v + 1] += begin[v];
  const fill = begin.slice();
  const corners = new Uint32Array(indices.length);
  for (let i = 0; i < indices.length; ++i) corners[fill[indices[i]]++] = i;
  return { begin, corners };
}

// {positions, normals, edges, closed}: nine numbers a triangle, nine a triangle, six a line; whether no edge is open.
export function shadedSurface(positions, indices) {
  const flat = faceNormals(positions, indices);
  const { begin, corners } = cornersAt(indices, positions.length / 3);
  const out = { positions: new Float32Array(3 * indices.length), normals: new Float32Array(3 * indices.length) };
  for (let i = 0; i < indices.length; ++i) {
    const v = indices[i];
    const own = i - (i % 3);
    const sum = [0, 0, 0];
    const hub = begin[v + 1] - begin[v] > maxFaces;
    for (let k = begin[v]; k < begin[v + 1]; ++k) {
      const other = corners[k] - (corners[k] % 3);
      if (other !== own && (hub || cosine(flat, own, other) < smoothCosine)) continue;
      for (let j = 0; j < 3; ++j) sum[j] += flat[other + j];
    }
    const length = Math.hypot(...sum) || 1;
    for (let j = 0; j < 3; ++j) {
      out.positions[3 * i + j] = positions[3 * v + j];
      out.normals[3 * i + j] = sum[j] / length;
    }
  }
  return { ...out, ...featureEdges(positions, indices, flat) };
}

function featureEdges(positions, indices, flat) {
  const count = positions.length / 3;
  const open = new Map(); // edge -> face that waits for its neighbor; -1: drawn or smooth
  const lines = [];
  const add = (a, b) => lines.push(...positions.subarray(3 * a, 3 * a + 3), ...positions.subarray(3 * b, 3 * b + 3));
  for (let f = 0; f < indices.length; f += 3) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [indices[f + k], indices[f + ((k + 1) % 3)]];
      const key = Math.min(a, b) * count + Math.max(a, b);
      const other = open.get(key);
      if (other === undefined) open.set(key, f);
      else if (other >= 0) {
        if (cosine(flat, f, other) < edgeCosine) add(a, b);
        open.set(key, -1);
      }
    }
  }
  let closed = true;
  for (const [key, face] of open) {
    if (face < 0) continue;
    closed = false;
    add(Math.floor(key / count), key % count);
  }
  return { edges: new Float32Array(lines), closed };
}
