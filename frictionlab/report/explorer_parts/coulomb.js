"use strict";
/* The part of the page that solves: four sliders, the curve, and the orbit at the belt speed chosen. */

const POINTS = 120;
const SAMPLES = 400;
const SLIDERS = {
  frequency: { low: 0.2, high: 5, start: 1, logarithmic: true },
  damping: { low: 0.01, high: 2, start: 0.1, logarithmic: true },
  friction: { low: 0, high: 1.5, start: 0.4, step: 0.01 },
  belt: { low: 0, high: 1.2, start: 0.4, step: 0.005 },
};
const held = document.getElementById("run-data");
/* The run that the page shows, if any; its scene is where the sliders begin, within limits that hold it. */
const run = held && JSON.parse(held.textContent);

const WORDS = {
  concave: "it lies above its chord",
  convex: "it lies below its chord",
  mixed: "it lies on both sides of its chord",
  undecided: "the area between it and its chord is too small, or changes sign towards V_{lin}",
};

const chosen = {}, moves = {};
let curveChart = null;
const solved = { scene: null, curve: null, milliseconds: 0 };

function byId(id) {
  return document.getElementById(id);
}

/** Join a range and a number field; what is read on the page is what is solved. */
function setUpSlider(name, { low, high, start, step, logarithmic }) {
  const range = byId(name), number = byId(`${name}-number`);
  const place = logarithmic ? Math.log : Number, value = logarithmic ? Math.exp : Number;
  const round = (found) => (logarithmic ? Number(found.toPrecision(3)) : Number(found.toFixed(4)));
  const told = document.createElement("small");
  const set = (found, from) => {
    chosen[name] = found;
    if (from !== number) number.value = found;
    if (from !== range) range.value = place(found);
    range.setAttribute("aria-valuetext", String(found));
  };
  const choose = (found, from) => {
    set(found, from);
    remember(name, found);
    update(name !== "belt");
  };
  /* A scene of a run may lie beyond the ends. */
  const move = moves[name] = (found) => {
    [low, high] = [Math.min(low, found), Math.max(high, found)];
    Object.assign(range, { min: place(low), max: place(high), step: logarithmic ? 0.005 : step });
    Object.assign(number, { min: low, max: high, step: "any" });
    told.textContent = `${Number(low.toPrecision(4))} to ${Number(high.toPrecision(4))}`;
    set(found, null);
  };
  document.querySelector(`label[for="${name}"]`).append(told);
  const known = remembered(name), possible = logarithmic ? known > 0 : known >= 0;
  move(known !== null && possible ? known : start);
  range.addEventListener("input", () => choose(Math.min(Math.max(round(value(Number(range.value))), low), high), range));
  number.addEventListener("input", () => {
    const found = Number(number.value);
    if (number.value !== "" && found >= low && found <= high) choose(found, number);
  });
  // What is out of range or no number is not solved: the field goes back to what is.
  number.addEventListener("change", () => { number.value = chosen[name]; });
}

/** Move the sliders to a scene, to six digits, and solve it. */
function showScene(scene) {
  for (const [name, value] of Object.entries(scene)) moves[name](Number(value.toPrecision(6)));
  update(true);
}

function update(sceneChanged) {
  if (sceneChanged || !solved.scene) {
    const began = performance.now();
    solved.scene = makeScene(chosen.frequency, chosen.damping, chosen.friction);
    solved.curve = solveCurve(solved.scene, POINTS);
    solved.milliseconds = performance.now() - began;
  }
  drawAll();
}

function drawAll() {
  const { scene, curve } = solved, belt = chosen.belt * scene.limitSpeed;
  const state = solvePoint(scene, belt), samples = state.unique ? sampleOrbit(scene, belt, state, SAMPLES) : [];
  tell(scene, shapeVerdict(curve), state, samples);
  drawCurve(scene, curve, state.unique ? state.mean : null);
  drawOrbit(scene, belt, samples);
  byId("timing").textContent = `${POINTS} points of the curve took ${solved.milliseconds.toFixed(0)} ms.`;
}

/** What is seen, in sentences and numbers. */
function tell(scene, shape, state, samples) {
  write(byId("verdict"), `Up to V_{lin} the curve is ${shape.verdict} by area: ${WORDS[shape.verdict]} `
    + `(area ${areaWords(shape)}). From V_{lin} on slip never reverses and mean friction is \u03bc.`);
  write(byId("point"), state.unique ? pointSentence(state) : restSentence(scene));
  const velocities = state.unique ? samples.map((sample) => sample.w) : [0];
  const swing = (Math.max(...velocities) - Math.min(...velocities)) / 2;
  const numbers = [
    ["mean friction / \u03bc", state.unique ? shown(state.mean, 6) : "not unique", "mean"],
    ["time at rest on the belt", `${shown(100 * state.stick, 1)} %`, "stick"],
    ["velocity amplitude / V_{lin}", shown(swing / scene.limitSpeed, 4), "swing"],
    ["V_{lin} / P", significant(scene.limitSpeed), "limit"],
    ["belt speed / P", significant(chosen.belt * scene.limitSpeed), "speed"],
    ["work absorbed by friction / P\u00b2", significant(scene.friction * state.work), "work"],
  ];
  byId("numbers").replaceChildren(...numbers.map(([name, value, id]) => {
    const pair = document.createElement("div"), term = document.createElement("dt"), told = document.createElement("dd");
    write(term, name);
    told.textContent = value;
    told.id = `number-${id}`;
    pair.append(term, told);
    return pair;
  }));
}

function areaWords({ verdict, area, above, below }) {
  return verdict === "mixed" ? `${significant(above)} above, ${significant(below)} below` : shown(area, 3);
}

function restSentence(scene) {
  const spread = shown(startFriction(scene), 3);
  return `The belt is at rest and friction holds the body: mean friction depends on where it starts, between \u2212${spread} `
    + `and ${spread} \u03bc.`;
}

function pointSentence(state) {
  const place = `At v_{b} = ${shown(chosen.belt, 3)} V_{lin} mean friction is ${shown(state.mean, 3)} \u03bc`;
  if (chosen.belt >= 1) return `${place}: slip never reverses.`;
  const lost = `vibration takes ${shown(100 * (1 - state.mean), 0)} % of it away`;
  const rests = state.stick > 0 ? `the body rests on the belt for ${shown(100 * state.stick, 1)} % of the period` : "the body never rests on the belt";
  return `${place}: ${lost}, and ${rests}.`;
}

function drawCurve(scene, { speeds, means, sticks, start }, mean) {
  const end = Math.max(1.2, 1.05 * chosen.belt);
  const chart = curveChart = drawAxes(byId("curve"), { label: "belt speed v_{b} / V_{lin}", span: [0, end] }, { label: "mean friction / \u03bc", span: [0, 1.08] });
  const points = [[0, start], ...speeds.map((speed, i) => [speed, means[i]])];
  chart.area(points, { fill: "var(--area)" });
  chart.line([[0, start], [1, 1]], { stroke: "var(--soft)", "stroke-width": 1.5, "stroke-dasharray": "6 4" });
  for (const [from, to] of stretches(sticks.map((stick) => stick > 0))) {
    chart.box(from ? speeds[from] : 0, speeds[Math.min(to + 1, speeds.length - 1)], chart.bottom - 7, chart.bottom, { fill: "var(--mark)" });
  }
  chart.upright(1, { "stroke-dasharray": "2 4" });
  chart.text(chart.px(1) + 5, chart.bottom - 12, "V_{lin}", {});
  chart.line([...points, [end, 1]], { stroke: "var(--line-0)", "stroke-width": 2.5, "stroke-linejoin": "round" });
  if (mean !== null) chart.dot([chosen.belt, mean], { r: 6, fill: "var(--line-0)", stroke: "var(--paper)", "stroke-width": 2 });
}

function drawOrbit(scene, belt, samples) {
  const speed = (w) => w / scene.limitSpeed, all = samples.length ? samples : [{ t: 0, x: 0, w: 0, friction: 0 }];
  const times = [0, 1], positions = spanOf(all.map((s) => s.x), 0.08);
  const slips = spanOf([...all.map((s) => speed(s.w)), 0], 0.08);
  const slip = drawAxes(byId("slip"), { label: "time / period", span: times }, { label: "slip velocity / V_{lin}", span: slips });
  slip.level(0, { "stroke-dasharray": "6 4" });
  const path = samples.map((s) => [s.t / scene.period, speed(s.w)]);
  slip.line(path, { stroke: "var(--line-0)" });
  for (const [from, to] of stretches(samples.map((s) => s.stick))) {
    slip.line([path[from], path[to]], { stroke: "var(--line-0)", "stroke-width": 5 });
  }
  const velocities = slips.map((value) => value + chosen.belt);
  const phase = drawAxes(byId("phase"), { label: "position / P", span: positions }, { label: "velocity / V_{lin}", span: velocities });
  phase.level(chosen.belt, { "stroke-dasharray": "6 4" });
  phase.line(samples.map((s) => [s.x, speed(s.w + belt)]), { stroke: "var(--line-0)" });
  const loop = drawAxes(byId("loop"), { label: "position / P", span: positions }, { label: "friction on the body / \u03bc", span: [-1.25, 1.25] });
  loop.area(samples.map((s) => [s.x, -s.friction]), { fill: "var(--area)" });
  loop.line([...samples, ...samples.slice(0, 1)].map((s) => [s.x, -s.friction]), { stroke: "var(--line-0)" });
}

/** First and last places of each stretch of true ones. */
function stretches(flags) {
  const found = [];
  flags.forEach((flag, i) => {
    if (!flag) return;
    if (!i || !flags[i - 1]) found.push([i, i]);
    found.at(-1)[1] = i;
  });
  return found;
}

for (const [name, limits] of Object.entries(SLIDERS)) {
  setUpSlider(name, { ...limits, start: run?.start?.[name] ?? limits.start });
}
update(true);
dragged(byId("curve"), (x) => {
  const found = Math.max(0, Math.min(curveChart.valueAt(x), Number(byId("belt-number").max)));
  moves.belt(Number(found.toFixed(3)));
  remember("belt", chosen.belt);
  drawAll();
});
addEventListener("resize", drawAll);
