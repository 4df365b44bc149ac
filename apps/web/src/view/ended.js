// When the script has ended: what one can do now.
const $ = (id) => document.getElementById(id);
const settle = 0.4; // s after the script's end, in which the hand comes to rest

export class Ended {
  // actions: {take, again, anew}; take or anew may be null where that cannot be.
  constructor(place, actions) {
    Object.assign(this, { place, actions, over: false });
    for (const [id, action] of Object.entries(actions)) {
      $(id).hidden = !action;
      $(id).addEventListener("click", () => {
        this.close();
        action();
      });
    }
    place.querySelector(".close").addEventListener("click", () => this.close());
  }

  close() {
    this.over = true;
    this.place.hidden = true;
  }

  // led: somebody has taken the hand away from the script.
  show(frame, end, led) {
    if (end === undefined) return;
    if (frame.t < end) this.over = false;
    const ended = frame.t > end + settle;
    if (led) this.over = true;
    this.place.hidden = !ended || this.over;
  }
}
