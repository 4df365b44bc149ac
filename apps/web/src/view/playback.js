// What is played back: time goes as one likes. A recording has all its frames from the beginning; of a live run those
// that the page has seen.
import { forceFloats, frameFloats, pairFloats, readFrame } from "./frame.js";

const maxRemembered = 12_000; // frames of a live run: 6 minutes

// Frames in a row: count, time(i), frame(i) come from who extends it.
class Playback {
  constructor({ onFrame, onStatus }) {
    Object.assign(this, { onFrame, onStatus, at: 0, speed: 1, playing: false });
  }

  get duration() {
    return this.time(this.count - 1);
  }

  show(i) {
    this.at = Math.min(this.count - 1, Math.max(0, i));
    this.onFrame(this.frame(this.at));
  }

  // The last frame not after `t`.
  indexAt(t) {
    let [low, high] = [0, this.count - 1];
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (this.time(middle) <= t) low = middle;
      else high = middle - 1;
    }
    return low;
  }
  seek(t) {
    this.show(this.indexAt(t));
    this.began = null;
  }

  play(on) {
    if (on === this.playing) return;
    this.playing = on;
    this.began = null;
    if (on && this.at === this.count - 1) this.at = 0;
    if (on) requestAnimationFrame((now) => this.advance(now));
    this.onStatus({ paused: !on });
  }
  advance(now) {
    if (!this.playing) return;
    this.began ??= { now, t: this.time(this.at) };
    const t = this.began.t + (this.speed * (now - this.began.now)) / 1000;
    const next = this.indexAt(t);
    if (next !== this.at) this.show(next);
    if (this.at === this.count - 1) return this.play(false);
    requestAnimationFrame((later) => this.advance(later));
  }
  setSpeed(speed) {
    this.speed = speed;
    this.began = null;
  }
}

export class Recorded extends Playback {
  constructor(bundle, events) {
    super(events);
    const { frames, pairs, pair_begin: begin, forces, force_begin: forceBegin } = bundle.about;
    this.rows = bundle.floats(frames);
    this.pairs = bundle.floats(pairs);
    this.pairBegin = bundle.integers(begin);
    this.forces = bundle.floats(forces);
    this.forceBegin = bundle.integers(forceBegin);
    this.count = this.rows.length / frameFloats;
  }

  row(i) {
    return this.rows.subarray(i * frameFloats, (i + 1) * frameFloats);
  }
  time(i) {
    return this.rows[i * frameFloats + 2] + this.rows[i * frameFloats + 3];
  }
  frame(i) {
    return readFrame(this.row(i), this.pairs.subarray(this.pairBegin[i] * pairFloats), this.forces.subarray(this.forceBegin[i] * forceFloats));
  }
}

// What the page has seen of a live run since its parts were last changed.
export class Memory {
  frames = [];

  push(frame) {
    const last = this.frames.at(-1);
    if (last && (frame.t < last.t || frame.generation !== last.generation)) this.frames = [];
    this.frames.push(frame);
    if (this.frames.length > maxRemembered) this.frames.shift();
  }
}

export class Remembered extends Playback {
  constructor(memory, events) {
    super(events);
    this.frames = memory.frames.slice();
    this.count = this.frames.length;
  }
  time(i) {
    return this.frames[i].t;
  }
  frame(i) {
    return this.frames[i];
  }
}
