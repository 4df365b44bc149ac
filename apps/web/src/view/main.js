// The page of a live run and of a recording: puts the pieces together.
import { cssColor, setDark, systemIsDark } from "../common/theme.js";
import { embeddedBundle } from "./bundle.js";
import { Viewpoint } from "./camera.js";
import { addHelp, addViews, listenToKeys, Section, showLayers } from "./controls.js";
import { Parts } from "./edit.js";
import { ForceNotice } from "./force.js";
import { distance, norm } from "./frame.js";
import { Hand } from "./hand.js";
import { Live } from "./live.js";
import { Numbers } from "./numbers.js";
import { Overlay } from "./overlay.js";
import { Plots } from "./plots.js";
import { Replay } from "./replay.js";
import { addReview } from "./review.js";
import { Stage } from "./stage.js";

const $ = (id) => document.getElementById(id);
const speeds = { live: [0.05, 0.1, 0.25, 0.5, 1, 2, null], replay: [0.1, 0.25, 0.5, 1, 2, 4] };

let dark = new URLSearchParams(location.search).has("dark") || systemIsDark();
setDark(dark);

const stage = new Stage(document.querySelector("#stage canvas"));
const viewpoint = new Viewpoint(stage);
const overlay = new Overlay(stage);
const section = new Section(stage);
const numbers = new Numbers($("numbers"));
const force = new ForceNotice($("force"));
const hand = new Hand(stage, viewpoint, { lead: (pose) => live.send({ do: "lead", pose, generation: about.generation }), changed: showHand });
let parts, plots, live = null, replay = null, about = null, frame = null, frames = 0, status = {};

function showMessage(text) {
  $("message").textContent = text;
  $("message").hidden = !text;
}

function showHand(what) {
  stage.canvas.classList.toggle("grabbing", what === "drag");
  $("hand").textContent = {
    drag: "Shift turns, the wheel moves away or nearer",
    keys: "Holding by keys: arrows, Page Up / Down, Shift turns, Esc lets go",
  }[what] ?? "";
}

function showFrame(next) {
  // Of parts that the page has not yet, or no longer.
  if (!replay && next.generation !== about.generation) return;
  frame = next;
  ++frames;
  hand.showFrame(frame);
  stage.showPoses(frame.x, frame.y);
  overlay.show(frame);
  numbers.show(frame, about.reasons);
  force.show(frame, about.reasons, hand);
  $("clock").textContent = `${frame.t.toFixed(replay || about.virtual_time ? 3 : 1)} s`;
  if (replay) {
    plots.showTime(frame.t);
    if (Number($("scrub").value) !== replay.at) $("scrub").value = replay.at;
  } else plots.push(frame);
}

function showScene(bundle) {
  about = bundle.about;
  const name = about.title.replace(/.*\//, "");
  document.title = `${name} – Tegotae`;
  $("title").textContent = name;
  $("title").title = about.title;
  stage.setScene(bundle);
  overlay.applyTheme();
  showHeld();
  hand.enabled = about.led === true;
  section.set(section.axis);
  parts.show();
  showLayers(overlay);
  const thinned = about.meshes.some((mesh) => mesh.shown < mesh.triangles);
  const total = (key) => about.parts.reduce((sum, part) => sum + about.meshes[part.mesh][key], 0).toLocaleString("en");
  $("notes").textContent = [`${total("triangles")} triangles${thinned ? `, drawn with ${total("shown")}` : ""}`, ...(about.notes ?? [])].join("\n");
}

function showHeld() {
  overlay.setScene(about);
  hand.setScene(about);
  $("scale").textContent = `Arrows: ${1e3 * overlay.metersPerNewton} mm for 1 N on the pen or of a contact,\n${overlay.metersPerNewtonMeter.toPrecision(1)} mm for 1 N·mm`;
}

function showStatus(next) {
  if (next.message !== undefined) showMessage(next.message);
  Object.assign(status, next);
  if (next.paused !== undefined) $("play").textContent = next.paused ? "Play" : "Pause";
  if (next.suspended !== undefined) $("suspended").textContent = next.suspended.length ? `suspended: ${next.suspended.join(", ")}` : "";
  if (next.speed !== undefined) $("speed").value = String(next.speed);
  if (next.generation !== undefined && about && next.generation !== about.generation) loadParts();
}

// The scene has changed.
async function loadParts() {
  if (loadParts.busy) return; // the next status asks again
  loadParts.busy = true;
  const next = await live.parts().catch(() => ({})); // the stream says that the program has ended
  loadParts.busy = false;
  if (!next.parts) return;
  Object.assign(about, next);
  if (stage.setParts(about.parts)) showHeld();
  section.apply();
  parts.show();
  viewpoint.limits();
}

const control = {
  play: () => (replay ? replay.play(!replay.playing) : live.send({ do: status.paused ? "play" : "pause" })),
  step: () => (replay ? (replay.play(false), replay.show(replay.at + 1)) : live.send({ do: "step", ticks: 1 })),
  back: () => replay && (replay.play(false), replay.show(replay.at - 1)),
  speed: (factor) => (replay ? replay.setSpeed(factor) : live.send({ do: "speed", factor })),
  restart: () => (replay ? replay.show(0) : about.restartable && live.send({ do: "restart" })),
};

function setTheme(on) {
  dark = on;
  setDark(dark);
  stage.applyTheme();
  overlay.applyTheme();
  plots.build();
}

function showRun() {
  const timed = replay !== null || about.virtual_time;
  for (const id of ["play", "step"]) $(id).hidden = !timed;
  $("speed").parentElement.hidden = !timed;
  $("restart").hidden = replay !== null;
  $("restart").disabled = !about.restartable;
  $("timeline").hidden = replay === null;
  $("mode").textContent = replay ? "Recording" : about.virtual_time ? "Live, virtual time" : "Live";
  $("mode").classList.toggle("live", !replay);
  for (const factor of replay ? speeds.replay : speeds.live) {
    const text = factor === null ? "fastest" : `${factor} ×`;
    $("speed").add(new Option(text, String(factor), false, factor === 1));
  }
}

function connect() {
  const help = addHelp();
  addViews(viewpoint);
  const buttons = { play: control.play, step: control.step, restart: control.restart, fit: () => viewpoint.look(), near: () => viewpoint.lookAtHeld(), theme: () => setTheme(!dark), ask: help };
  for (const [id, action] of Object.entries(buttons)) $(id).addEventListener("click", action);
  $("speed").addEventListener("change", () => control.speed(JSON.parse($("speed").value)));
  $("scrub").addEventListener("input", () => (replay.play(false), replay.show(Number($("scrub").value))));
  const timed = () => replay || about.virtual_time;
  const actions = {
    " ": () => timed() && control.play(), ".": () => timed() && control.step(), ",": control.back,
    r: control.restart, f: buttons.fit, c: buttons.near, t: buttons.theme, s: () => section.next(), "?": help,
    h: () => hand.toggleKeys(), escape: () => hand.letGo(),
  };
  for (let i = 0; i < 7; ++i) actions[String(i + 1)] = () => viewpoint.look(i);
  listenToKeys({ actions, viewpoint, hand });
  stage.canvas.addEventListener("pointermove", (event) => {
    if (!hand.enabled || event.buttons) return;
    stage.canvas.classList.toggle("grab", stage.pick(event.clientX, event.clientY)?.part.held ?? false);
  });
}

// Recordings do not have the servo's lateness, and virtual time has no times.
function withoutValues({ mode, virtual_time: virtual }) {
  if (virtual) return ["Tick time", "Servo lateness"];
  return mode === "replay" ? ["Servo lateness"] : [];
}

async function begin() {
  let bundle = embeddedBundle();
  const token = new URLSearchParams(location.search).get("token");
  if (!bundle) {
    live = new Live(token, { onFrame: showFrame, onStatus: showStatus, onEnd: showMessage });
    bundle = await live.scene();
  }
  if (bundle.about.mode === "replay") {
    if (live) addReview($("review"), live, bundle.about.title, showMessage);
    live = null;
    replay = new Replay(bundle, { onFrame: showFrame, onStatus: showStatus });
  }
  parts = new Parts(stage, live && ((command) => live.edit(command)), showMessage);
  plots = new Plots($("plots"), replay ? (t) => replay.seek(t) : null, withoutValues(bundle.about));
  showScene(bundle);
  showRun();
  connect();
  viewpoint.look(6);
  if (replay) {
    $("scrub").max = replay.count - 1;
    plots.setRecording(replay);
    showStatus({ paused: true });
    replay.show(0);
  } else live.watch();
}

// Where a point of the world is on the screen.
function project(point) {
  stage.camera.updateMatrixWorld();
  const rect = stage.canvas.getBoundingClientRect();
  const p = stage.camera.position.clone().set(...point).project(stage.camera);
  return [rect.left + ((p.x + 1) / 2) * rect.width, rect.top + ((1 - p.y) / 2) * rect.height];
}

// What a test may ask the page.
window.__tegotae = {
  get state() {
    return {
      mode: about?.mode, parts: stage.parts?.map(({ name, held, visible, removed }) => ({ name, held, visible, removed })), places: stage.parts?.map(({ group }) => group.position.toArray()), selected: parts?.selected ?? null, frame, frames,
      status, shown: overlay.shown, plots: plots?.state(), drawn: stage.drawn,
      arrows: { force: overlay.force.group.visible ? overlay.force.length : 0, torque: overlay.torque.group.visible ? overlay.torque.length : 0 },
      force: frame ? norm(frame.force) : 0, lag: frame ? distance(frame.x, frame.y) : 0, camera: stage.camera.position.toArray(), target: viewpoint.controls.target.toArray(), background: cssColor("--stage"), count: replay?.count, message: $("message").textContent,
    };
  },
  project,
  // Of all parts together, on the screen.
  corners() {
    const { min, max } = stage.measure();
    return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => project([i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z]));
  },
  // Where the mouse holds the part.
  grip: () => hand.grip && [hand.grip.x, hand.grip.y],
  center: () => overlay.center.clone().applyMatrix4(stage.held.group.matrixWorld).toArray(),
};

begin().catch((error) => {
  showMessage(error.message);
  throw error; // for the console
});
