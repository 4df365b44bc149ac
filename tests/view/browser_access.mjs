// Who hears the page, or goes through it by keys: every control has a role and a name of its own, keys reach all of them in
// the order of the page, and one sees where they are; what is read is told from what is behind it, light and dark. The
// oracles are Chromium's accessibility tree and contrast as WCAG 2.2 defines it.
import assert from "node:assert/strict";
import { test } from "./cases.mjs";
import { pushesBack, writeBoxes, writeFloor } from "./floor.mjs";
import { serve, until } from "./program.mjs";
import { openOn, press } from "./screens.mjs";

const controls = ["application", "button", "checkbox", "combobox", "searchbox", "slider", "spinbutton", "textbox"];
const sizes = [{ width: 1366, height: 768 }, { width: 390, height: 844, touch: true }];

// What a screen reader is told; where: the names of what it is in.
async function heard(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Accessibility.enable");
  const { nodes } = await session.send("Accessibility.getFullAXTree");
  await session.detach();
  const byId = new Map(nodes.map((node) => [node.nodeId, node]));
  const where = ({ parentId }) => (parentId ? [...where(byId.get(parentId)), byId.get(parentId).name?.value].filter(Boolean) : []);
  return nodes.filter((node) => !node.ignored).map((node) => {
    const property = (wanted) => node.properties?.find((p) => p.name === wanted)?.value.value;
    return { role: node.role.value, name: (node.name?.value ?? "").trim(), where: where(node), focusable: property("focusable") === true, live: property("live") };
  });
}

// Every control has a role and a name, and no two of one place the same; pictures and places have one too.
async function hasNames(page, least = 1) {
  const nodes = await heard(page);
  const found = nodes.filter((n) => controls.includes(n.role));
  assert.ok(found.length >= least, `${found.length} controls`);
  for (const n of nodes) {
    if (n.focusable && !["RootWebArea", "option", "dialog"].includes(n.role)) assert.ok(controls.includes(n.role), `${n.role} "${n.name}" takes keys`);
    if ([...controls, "image", "figure", "Canvas", "region", "complementary", "dialog"].includes(n.role)) assert.notEqual(n.name, "", `a ${n.role} has no name`);
  }
  const names = found.map((n) => [...n.where, n.role, n.name].join(" > "));
  assert.deepEqual(names.filter((name, i) => names.indexOf(name) !== i), [], "two controls of one name");
  return nodes;
}

// Tab goes through all controls that one sees, in the order of the page, and each shows that it has the keys.
async function keysReachAll(page) {
  const wanted = await page.evaluate(() => {
    const able = [...document.querySelectorAll("button, input, select, [tabindex='0']")].filter((e) => e.checkVisibility() && !e.disabled);
    able.forEach((e, i) => (e.dataset.order = i));
    document.getElementById("title").setAttribute("tabindex", "-1");
    return able.length;
  });
  const seen = [];
  await page.focus("#title"); // what follows is the first
  for (let i = 0; i < wanted; ++i) {
    await page.keyboard.press("Tab");
    const [order, ring, name] = await page.evaluate(() => {
      const e = document.activeElement, { outlineStyle, outlineWidth } = getComputedStyle(e);
      return [Number(e.dataset.order), outlineStyle === "none" ? 0 : parseFloat(outlineWidth), e.id || e.textContent || e.ariaLabel];
    });
    assert.ok(ring >= 2, `one does not see that ${name} has the keys`);
    seen.push(order);
  }
  assert.deepEqual(seen, seen.map((_, i) => i));
  await page.evaluate(() => document.getElementById("title").removeAttribute("tabindex"));
}

// Runs in the page: what is told from what is behind it by less than 4.5 (text) or 3 (borders of fields, the ring).
function faint() {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (color) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = color;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((v, k) => v * a + below[k] * (1 - a));
  const chain = (e) => (e ? [...chain(e.parentElement), e] : []);
  const behind = (e) => chain(e).reduce((below, a) => over(rgba(getComputedStyle(a).backgroundColor), below), [255, 255, 255]);
  const luminance = (c) => c.map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)).reduce((sum, v, k) => sum + v * [0.2126, 0.7152, 0.0722][k], 0);
  const contrast = (a, b) => {
    const [high, low] = [luminance(a), luminance(b)].sort((x, y) => y - x);
    return (high + 0.05) / (low + 0.05);
  };
  const out = [], checked = [];
  const check = (what, color, e, least) => {
    const below = behind(e);
    const opacity = chain(e).reduce((o, a) => o * Number(getComputedStyle(a).opacity), 1);
    const [r, g, b, a] = rgba(color);
    const value = contrast(over([r, g, b, a * opacity], below), below);
    checked.push(what);
    if (value < least) out.push(`${value.toFixed(2)}: ${what}`);
  };
  for (const e of document.body.querySelectorAll("*")) {
    if (!e.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true })) continue;
    const style = getComputedStyle(e);
    const name = `${e.tagName}#${e.id || e.parentElement.id} "${e.textContent.trim().slice(0, 30)}"`;
    const own = [...e.childNodes].some((n) => n.nodeType === Node.TEXT_NODE && n.textContent.trim());
    if (own && !e.disabled && e.tagName !== "OPTION") check(name, e instanceof SVGElement ? style.fill : style.color, e, 4.5);
    if (e.placeholder) check(`${name} placeholder`, getComputedStyle(e, "::placeholder").color, e, 4.5);
    if (e.matches("input[type=search], input[type=number]") && !e.disabled) check(`${name} border`, style.borderColor, e.parentElement, 3);
  }
  check("ring of who has the keys", getComputedStyle(document.documentElement).getPropertyValue("--accent"), document.body, 3);
  return { out, checked: checked.length };
}

async function isTold(page) {
  const { out, checked } = await page.evaluate(faint);
  assert.ok(checked > 25, `${checked} texts`);
  assert.deepEqual(out, []);
}

// A finger meets what it aims at: 24 px at least, with its label.
async function fingersMeet(page) {
  const small = await page.evaluate(() => [...document.querySelectorAll("button, input, select")].filter((e) => e.checkVisibility()).map((e) => {
    const { width, height } = (e.closest("label") ?? e).getBoundingClientRect();
    return [e.id || e.textContent, width, height];
  }).filter(([, width, height]) => Math.min(width, height) < 24));
  assert.deepEqual(small, []);
}

async function isForAll(page) {
  const nodes = await hasNames(page);
  await isTold(page);
  if (page.touch) await fingersMeet(page);
  assert.equal(await page.evaluate(() => document.getAnimations().length), 0);
  return nodes;
}

// What is told without being asked for, as text.
const news = (page) => page.evaluate(() => [...document.querySelectorAll("[role=status], [role=alert], [aria-live]")].filter((e) => e.checkVisibility()).map((e) => e.textContent.trim()).filter(Boolean));

for (const screen of sizes.flatMap((size) => [false, true].map((dark) => ({ ...size, dark })))) {
  const name = `${screen.width}, ${screen.dark ? "dark" : "light"}`;

  test(`access: a run, ${name}`, async (browser) => {
    const program = await serve("tegotae", "run", writeFloor("0,0,0,0.008,1,0,0,0\n0.3,0,0,0.0015,1,0,0,0\n"), "--view", "--fast");
    const { page, context } = await openOn(browser, program.url, screen, { play: true });
    await page.focus("#stage canvas");
    await page.keyboard.press("1");
    await until(page, (s) => pushesBack(s) && s.frame.t > 1);
    // Where it is drawn nobody hears it.
    await until(page, (s) => s.touched === "Touches floor");
    await page.panel("left");
    await page.evaluate(() => document.querySelector("#parts .name").click());
    for (const panel of page.narrow ? ["left", "right", ""] : [""]) {
      await page.panel(panel);
      await isForAll(page);
      await keysReachAll(page);
    }
    await page.focus("#stage canvas");
    await page.keyboard.press("n");
    await page.keyboard.press("m");
    await page.keyboard.press("Enter");
    await until(page, (s) => s.picked.length === 1);
    const nodes = await isForAll(page);
    for (const card of ["Contact", "Measured"]) assert.ok(nodes.some((n) => n.role === "region" && n.name === card && n.live === "polite"), `${card} is told`);
    await page.keyboard.press("?");
    assert.equal(await page.evaluate(() => document.querySelector("#help").scrollTop), 0, "the help begins at its beginning");
    await isForAll(page);
    await page.keyboard.press("Escape");
    await context.close();
    assert.equal(await program.stop(), 0);
  });

  test(`access: looking, ${name}`, async (browser) => {
    const program = await serve("tegotae", "view", writeBoxes("access", [[[0, 0, 0], [20, 20, 5]], [[0, 0, 6], [20, 20, 9]]]));
    const { page, context } = await openOn(browser, program.url, screen, { runs: false });
    assert.deepEqual(await news(page), ["Nothing is held: click a part to take it."]);
    await page.panel("left");
    await page.evaluate(() => document.querySelectorAll("#parts .name")[1].click());
    await press(page, "#section [data-kind=z]");
    // The plane is where the text says: in the middle of 9 mm.
    assert.equal(await page.getAttribute("#cut", "aria-valuetext"), "z 4.5\u00a0mm");
    assert.deepEqual(await news(page), ["box 1"]);
    await isForAll(page);
    await keysReachAll(page);
    await context.close();
    assert.equal(await program.stop(), 0);
  });
}
