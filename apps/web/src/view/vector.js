// Three numbers at a time.
export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const sub = (a, b) => add(a, b, -1);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const size = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => {
  const length = size(a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};
// Of unit vectors, as lines: 0 to 90°, in rad.
export const lineAngle = (a, b) => Math.atan2(size(cross(a, b)), Math.abs(dot(a, b)));
