// The page of a live run and of a recording: puts its modules together.
import { setDark, systemIsDark } from "../common/theme.js";
import { length } from "../common/number.js";
import { Behind } from "./behind.js";
import { embeddedBundle } from "./bundle.js";
import { Viewpoint } from "./camera.js";
import { Compass } from "./compass.js";
import { ContactCard } from "./contact.js";
import { addHelp, addPanels, addViews, listenToClicks, listenToKeys, showLayers, showMore } from "./controls.js";
import { listenToDrops } from "./drop.js";
import { Parts } from "./edit.js";
import { Ended } from "./ended.js";
import { ForceNotice } from "./force.js";
import { GuideLine } from "./guide.js";
import { Hand } from "./hand.js";
import { Live } from "./live.js";
import { Measure } from "./measure.js";
import { Numbers } from "./numbers.js";
import { Overlay } from "./overlay.js";
import { Memory, Recorded, Remembered } from "./playback.js";
import { Plots } from "./plots.js";
import { Rest } from "./rest.js";
import { addReview, saveScript, stylusScript } from "./review.js";
import { Section } from "./section.js";
import { Stage } from "./stage.js";
import { addTestDoor } from "./test_door.js";
import { Touched } from "./touched.js";

const $ = (id) => document.getElementById(id);
const speeds = { live: [0.05, 0.1, 0.25, 0.5, 1, 2, null], replay: [0.1, 0.25, 0.5, 1, 2, 4] };

let dark = new URLSearchParams(location.search).has("dark") || systemIsDark();
setDark(dark);

const stage = new Stage(document.querySelector("#stage canvas"));
const viewpoint = new Viewpoint(stage);
// Clicks come before whoever drags.
listenToClicks(stage.canvas, click);
const overlay = new Overlay(stage);
const guide = new GuideLine(stage);
const behind = new Behind(stage, overlay);
const compass = new Compass(viewpoint, document.querySelector("#compass svg"), document.querySelector("#compass .bar"));
const section = new Section(stage, viewpoint, { picked: () => lastNormal, changed: (keys) => showHand(keys ? "plane" : "") });
const measure = new Measure(stage, viewpoint, $("measured"), (on) => {
  $("measure").setAttribute("aria-pressed", String(on));
  if (on) stage.canvas.focus({ preventScroll: true }); // Enter is for the picture now
  rest.show(!stage.held && !on);
  allowHand();
});
const contact = new ContactCard(stage, $("contact"));
const numbers = new Numbers($("numbers"));
const force = new ForceNotice($("force"));
const touched = new Touched($("touched"));
const memory = new Memory();
const hand = new Hand(stage, viewpoint, { lead: (pose) => { led = true; live.send({ do: "lead", pose, generation: about.generation }); }, changed: showHand });
// player: what is played back instead of what is live.
let parts, plots, rest, ended = null, live = null, player = null, about = null, frame = null, frames = 0, status = {}, led = false, lastNormal = null;

stage.onDraw = () => {
  compass.show();
  measure.follow();
  contact.follow();
  if (frame) behind.show(frame);
};

// kind: "" something is wrong, "work" is under way, "news" go with the next click.
function showMessage(text, kind = "") {
  $("message").dataset.kind = kind;
  $("message").textContent = text;
  $("message").hidden = !text;
}
// Before whoever drags takes it.
addEventListener("pointerdown", () => $("message").dataset.kind === "news" && showMessage(""), { capture: true });

// Fingers have neither Shift nor a wheel.
const fingers = matchMedia("(pointer: coarse)").matches;

function showHand(what) {
  stage.canvas.classList.toggle("grabbing", what === "drag");
  $("hand").textContent = {
    drag: fingers ? "" : hand.turns ? "Turns the part; G: moves it" : "Shift turns, the wheel moves away or nearer",
    keys: "Holding by keys: arrows, Page Up / Down, Shift turns, Esc lets go",
    plane: "The section plane by keys: arrows tilt it, Page Up / Down move it, Esc lets go",
    take: fingers ? "Drag the blue part." : "Drag the blue part. Shift turns it, the wheel moves it away or nearer.",
  }[what] ?? "";
}

function click(x, y) {
  const hit = stage.pick(x, y);
  if (hit) lastNormal = hit.normal;
  if (measure.on) return measure.click(hit);
  if (frame && overlay.group.visible && contact.click(x, y, frame)) return;
  parts?.select(hit ? stage.parts.indexOf(hit.part) : null);
}

// A click in the middle of the picture, by a key.
function clickMiddle() {
  const { left, top, width, height } = stage.canvas.getBoundingClientRect();
  click(left + width / 2, top + height / 2);
}

function nextContact() {
  if (frame && overlay.group.visible) contact.next(frame);
}

function toggleHandKeys() {
  section.letGo();
  if (stage.held) hand.toggleKeys();
  else parts.hold();
}

function togglePlaneKeys() {
  if (hand.keys) hand.letGo();
  section.toggleKeys();
  if (section.keys) stage.canvas.focus({ preventScroll: true }); // the slider has arrow keys of its own
}

// The innermost of what is going on ends.
function escape() {
  if (section.keys) section.letGo();
  else if (measure.on) measure.toggle(false);
  else if (hand.leads) hand.letGo();
  else contact.close();
}

function showFrame(next) {
  frame = next;
  ++frames;
  hand.showFrame(frame);
  stage.showPoses(frame.x, frame.y, overlay.show(frame));
  behind.show(frame);
  contact.show(frame);
  touched.show(frame, stage.parts);
  numbers.show(frame, about.reasons);
  if (!player) force.show(frame, about.reasons, hand);
  $("clock").textContent = `${frame.t.toFixed(player || about.virtual_time ? 3 : 1)} s`;
  if (player) {
    plots.showTime(frame.t);
    if (Number($("scrub").value) !== player.at) $("scrub").value = player.at;
    $("scrub").setAttribute("aria-valuetext", $("clock").textContent);
  } else plots.push(frame);
}

function showLiveFrame(next) {
  // Of parts that the page has not yet, or no longer.
  if (next.generation !== about.generation) return;
  if (frame && next.t < (memory.frames.at(-1)?.t ?? 0)) led = false;
  memory.push(next);
  if (player) return;
  showFrame(next);
  ended.show(next, about.script_end, led);
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
  allowHand();
  section.apply();
  parts.show();
  if (about.guide) guide.setScene(bundle.floats(about.guide), stage.held);
  showLayers(overlay, behind, about.guide ? guide : null);
  const thinned = about.meshes.some((mesh) => mesh.shown < mesh.triangles);
  const total = (key) => about.parts.reduce((sum, part) => sum + about.meshes[part.mesh][key], 0).toLocaleString("en");
  $("notes").textContent = [`${total("triangles")} triangles${thinned ? `, drawn with ${total("shown")}` : ""}`, ...(about.notes ?? [])].join("\n");
}

// Another part is held, or none: then the page is for looking only.
function showHeld() {
  const held = stage.held !== null;
  const rested = held && document.body.classList.contains("rest");
  hand.setScene(about);
  touched.rest();
  document.body.classList.toggle("rest", !held);
  $("near").title = held ? "Show the held part (C)" : "Show the selected part (C)";
  for (const id of ["save", "review"]) $(id).disabled = !held && live !== null;
  overlay.hide(!held || stage.explosion > 0);
  if (!held) {
    frame = null;
    behind.rest();
    force.rest();
    contact.close();
    if (document.body.dataset.panel === "right") $("tabs").querySelector('[data-panel=""]').click();
    $("clock").textContent = "";
    $("scale").textContent = "";
    return;
  }
  overlay.setScene(about);
  if (rested) showHand("take");
  $("scale").textContent = `Arrows: ${length(overlay.metersPerNewton)} for 1 N on the pen or of a contact,\n${length(1e-3 * overlay.metersPerNewtonMeter)} for 1 N·mm`;
}

// The hand is led only in what is live and as it is.
function allowHand() {
  const leads = about?.led === true && stage.held !== null;
  hand.enabled = leads && !player && !measure.on && stage.explosion === 0;
  $("turns").hidden = !leads;
  $("turns").disabled = !hand.enabled;
}

function showStatus(next) {
  if (next.message !== undefined) showMessage(next.message);
  Object.assign(status, next);
  if (next.paused !== undefined && !player) showPaused(next.paused);
  if (next.suspended !== undefined) $("suspended").textContent = next.suspended.length ? `suspended: ${next.suspended.join(", ")}` : "";
  if (next.speed !== undefined && !player) $("speed").value = String(next.speed);
  if (next.generation !== undefined && about && next.generation !== about.generation) loadParts();
}
const showPaused = (paused) => ($("play").textContent = paused ? "Play" : "Pause");

// The scene has changed.
async function loadParts() {
  if (loadParts.busy) return; // the next status asks again
  loadParts.busy = true;
  const next = await live.parts().catch(() => ({})); // the stream says that the program has ended
  loadParts.busy = false;
  if (!next.parts) return;
  if (player) playLive();
  Object.assign(about, next);
  if (stage.setParts(about.parts)) {
    showHeld();
    showRun();
    allowHand();
  }
  guide.show();
  // The script's goal is that of the part that it began with.
  plots.goal = about.parts[about.scripted]?.held ? about.goal : null;
  section.apply();
  parts.show();
  viewpoint.limits();
}

const control = {
  play: () => (player ? player.play(!player.playing) : live.send({ do: status.paused ? "play" : "pause" })),
  step: () => (player ? (player.play(false), player.show(player.at + 1)) : live.send({ do: "step", ticks: 1 })),
  back: () => player && (player.play(false), player.show(player.at - 1)),
  speed: (factor) => (player ? player.setSpeed(factor) : live.send({ do: "speed", factor })),
  restart: () => {
    if (!live) return player.show(0);
    if (!about.restartable) return;
    if (player) playLive();
    parts.forget();
    live.send({ do: "restart" });
  },
};

function play(playback) {
  player = playback;
  allowHand();
  showRun();
  $("scrub").max = player.count - 1;
  plots.seek = (t) => player.seek(t);
  plots.setRecording(player);
  showPaused(true);
  player.show(0);
}

// What the page has seen of the run, from the beginning.
function playAgain() {
  if (memory.frames.length === 0) return;
  play(new Remembered(memory, { onFrame: showFrame, onStatus: ({ paused }) => showPaused(paused) }));
  player.play(true);
}

function playLive() {
  player?.play(false);
  player = null;
  plots.seek = null;
  plots.clear();
  for (const seen of memory.frames) plots.append(seen);
  allowHand();
  showRun();
  showPaused(status.paused ?? false);
}

function setTheme(on) {
  dark = on;
  setDark(dark);
  stage.applyTheme();
  overlay.applyTheme();
  guide.applyTheme();
  measure.draw();
  section.apply();
  parts.show();
  plots.build();
}

function showRun() {
  const timed = player !== null || about.virtual_time;
  for (const id of ["play", "step"]) $(id).hidden = !timed;
  $("speed").parentElement.hidden = !timed;
  $("restart").hidden = live === null;
  $("restart").disabled = !about.restartable;
  $("restart").title = about.restartable ? "Begin the run anew (R)" : "A run that is recorded cannot begin anew";
  $("timeline").hidden = player === null;
  $("live").hidden = live === null;
  $("mode").textContent = !stage.held ? "Nothing held" : player ? (live ? "Replay" : "Recording") : about.virtual_time ? "Live, virtual time" : "Live";
  $("mode").classList.toggle("live", !player);
  $("speed").replaceChildren(...(player ? speeds.replay : speeds.live).map((factor) => {
    const text = factor === null ? "fastest" : `${factor} ×`;
    return new Option(text, String(factor), false, factor === 1);
  }));
}

function explode(factor) {
  $("explode").value = factor;
  stage.explode(factor);
  viewpoint.refit();
  overlay.hide(factor > 0 || !stage.held);
  guide.show();
  allowHand();
  section.apply();
}

function setParallel(on) {
  viewpoint.setParallel(on);
  $("parallel").setAttribute("aria-pressed", String(viewpoint.parallel));
}

function setUp(axis) {
  $("up").value = axis;
  viewpoint.setUp(axis);
}

function setTechnical(on) {
  document.body.classList.toggle("technical", on);
  plots.showTechnical(on);
}

function turnsOnDrag() {
  hand.turns = !hand.turns;
  $("turns").setAttribute("aria-pressed", String(hand.turns));
}

function connect() {
  const help = addHelp();
  addViews(viewpoint);
  addPanels();
  showMore($("tools"));
  const buttons = {
    play: control.play, step: control.step, restart: control.restart, fit: () => viewpoint.look(), near: showPart, theme: () => setTheme(!dark), ask: help,
    parallel: () => setParallel(!viewpoint.parallel), measure: () => measure.toggle(), live: playLive, turns: turnsOnDrag,
  };
  for (const [id, action] of Object.entries(buttons)) $(id).addEventListener("click", action);
  $("speed").addEventListener("change", () => control.speed(JSON.parse($("speed").value)));
  $("scrub").addEventListener("input", () => (player.play(false), player.show(Number($("scrub").value))));
  $("explode").addEventListener("input", () => explode(Number($("explode").value)));
  $("up").addEventListener("change", () => setUp($("up").value));
  $("technical").addEventListener("change", () => setTechnical($("technical").checked));
  const timed = () => player || about.virtual_time;
  const actions = {
    " ": () => timed() && control.play(), ".": () => timed() && control.step(), ",": control.back,
    r: control.restart, f: buttons.fit, c: buttons.near, t: buttons.theme, s: () => section.next(), "?": help,
    "[": () => section.shift(-0.02), "]": () => section.shift(0.02), p: togglePlaneKeys, o: buttons.parallel, u: () => setUp({ z: "y", y: "x", x: "z" }[viewpoint.up]),
    m: buttons.measure, e: () => explode(stage.explosion > 0 ? 0 : 0.8), g: turnsOnDrag,
    v: () => parts.toggleVisible(), i: () => parts.isolate(), x: () => parts.fade(), a: () => parts.showAll(), "ctrl+z": () => parts.edit && parts.undo(),
    "/": () => $("search").focus(),
    h: toggleHandKeys, escape, enter: clickMiddle, n: nextContact,
  };
  for (let i = 0; i < 7; ++i) actions[String(i + 1)] = () => viewpoint.look(i);
  listenToKeys({ actions, viewpoint, movers: [hand, section] });
  listenToDrops(showMessage);
  stage.canvas.addEventListener("pointermove", (event) => {
    if (!hand.enabled || event.buttons) return;
    stage.canvas.classList.toggle("grab", stage.pick(event.clientX, event.clientY, [stage.held]) !== null);
  });
}

// The held part, or where none is, the selected one.
function showPart() {
  const part = stage.held ?? stage.parts[parts.selected];
  if (part) viewpoint.lookAt(part);
}

function takePart() {
  stage.canvas.focus();
  showPart();
  showHand("take");
}

// Recordings do not have the servo's lateness, virtual time has no times, and not every script goes somewhere.
function withoutValues({ mode, virtual_time: virtual, goal }) {
  const without = goal ? [] : ["To the goal"];
  if (virtual) return [...without, "Tick time", "Servo lateness"];
  return mode === "replay" ? [...without, "Servo lateness"] : without;
}

async function begin() {
  let bundle = embeddedBundle();
  const token = new URLSearchParams(location.search).get("token");
  if (!bundle) {
    live = new Live(token, { onFrame: showLiveFrame, onStatus: showStatus, onEnd: showMessage });
    bundle = await live.scene();
  }
  const recording = bundle.about.mode === "replay";
  if (recording) {
    const program = live;
    if (program) addReview($("review"), () => program.review(), bundle.about.title, showMessage);
    live = null;
  } else if (bundle.about.led) {
    const { title } = bundle.about;
    $("save").hidden = false;
    $("save").addEventListener("click", () => memory.frames.length > 1 && saveScript(memory.frames, title));
    if (bundle.about.reviewable) addReview($("review"), () => live.review(stylusScript(memory.frames)), title, showMessage);
  }
  parts = new Parts(stage, live && ((command) => live.edit(command)), { loose: bundle.about.loose, onMessage: showMessage, onShow: () => rest.show(!stage.held && !measure.on) });
  rest = new Rest($("rest"), parts);
  plots = new Plots($("plots"), null, withoutValues(bundle.about), bundle.about.goal ?? null);
  bundle.about.scripted = bundle.about.parts.findIndex((part) => part.held);
  showScene(bundle);
  showRun();
  connect();
  setUp(about.up ?? "z");
  ended = new Ended($("ended"), { take: about.led ? takePart : null, again: playAgain, anew: about.restartable ? control.restart : null });
  if (recording) play(new Recorded(bundle, { onFrame: showFrame, onStatus: ({ paused }) => showPaused(paused) }));
  else live.watch();
}

addTestDoor({ stage, viewpoint, overlay, guide, hand, section, measure, contact, get now() { return { about, parts, plots, player, frame, frames, status }; } });

begin().catch((error) => {
  showMessage(error.message);
  throw error; // for the console
});
