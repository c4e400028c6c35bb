"use strict";
/* The part of the page that shows the table of a run: a slider for each swept quantity, and the curves of every law. */

const COLOURS = [0, 1, 2, 3, 4, 5].map((i) => `var(--line-${i})`);
const DASHES = ["none", "9 4", "2 3", "9 3 2 3", "5 2", "12 3 2 3 2 3"];
/* Curves differ in dashes, too, for print in grey. */

const VISIBLE = 0.004;
/* Share of the axis: a narrower error band is thinner than its curve. */

const SOLVED = { stroke: "var(--wide)", "stroke-width": 7 };
/* The Coulomb curve that the page solves: wide and below those of the run, so that it is seen where they coincide. */

const places = run.swept.map(() => 0);
let along = 0, runChart = null;

/** How a law with a method is drawn. */
function lookOf(look) {
  const dashes = DASHES[(look + Math.floor(look / COLOURS.length)) % DASHES.length];
  return { stroke: COLOURS[look % COLOURS.length], "stroke-width": 2.3, "stroke-dasharray": dashes };
}

/** A slider over given values; ``chosen`` is told the index. A function that moves it. */
function addSlider(id, label, values, start, chosen) {
  const box = document.createElement("div"), name = document.createElement("label");
  const range = document.createElement("input"), value = document.createElement("output");
  box.className = "slider";
  name.htmlFor = range.id = id;
  write(name, label);
  const told = (found) => (typeof found === "number" ? String(Number(found.toPrecision(6))) : found);
  const most = values.length - 1, known = remembered(id), ends = document.createElement("small");
  ends.textContent = `${told(values[0])} to ${told(values[most])}, ${values.length} values`;
  const begin = Number.isInteger(known) && known >= 0 && known <= most ? known : start;
  Object.assign(range, { type: "range", min: 0, max: most, step: 1, value: begin });
  const choose = () => {
    value.textContent = told(values[Number(range.value)]);
    range.setAttribute("aria-valuetext", value.textContent);
    chosen(Number(range.value));
  };
  range.addEventListener("input", () => { remember(id, Number(range.value)); choose(); drawRun(); followRun(); });
  choose();
  name.append(ends);
  box.append(name, range, value);
  document.getElementById("run-sliders").append(box);
  return (at) => { range.value = at; range.dispatchEvent(new Event("input")); };
}

/** The page's solver goes to the scene shown, where it solves one. */
function followRun() {
  const first = curvesChosen().find((curve) => curve.coulomb), here = run.abscissa.values[along];
  if (!first) return;
  const { frequency, damping, friction, limit } = first.coulomb;
  showScene({ frequency, damping, friction, belt: Math.abs(here) / limit });
}

/** The curves at the values chosen; a quantity that a law does not have chooses nothing. */
function curvesChosen() {
  return run.curves.filter((curve) => curve.at.every((at, i) => at === null || at === places[i]));
}

/** The scenes of these curves that the page solves, each once; solved when first shown. */
const solutions = new Map();
function coulombCurves(curves) {
  // Curves of one scene have its numbers to rounding.
  const rounded = (_, value) => (typeof value === "number" ? Number(value.toPrecision(12)) : value);
  const keys = new Set(curves.filter((curve) => curve.coulomb).map(({ coulomb }) => JSON.stringify(coulomb, rounded)));
  return [...keys].map((key) => {
    if (!solutions.has(key)) {
      const given = JSON.parse(key), scene = makeScene(given.frequency, given.damping, given.friction);
      solutions.set(key, { ...given, scene, curve: solveCurve(scene, POINTS) });
    }
    return solutions.get(key);
  });
}

/** A solved curve in the units of the run, over a span of belt speeds; friction turns round with the belt. */
function inUnitsOfRun({ mu, limit, curve }, [low, high]) {
  const forth = [[0, curve.start], ...curve.speeds.map((speed, i) => [speed, curve.means[i]])];
  const half = (sign, end) => (sign * end <= 0 ? [] : [...forth, [Math.max(sign * end / limit, 1), 1]]
    .map(([speed, mean]) => [sign * speed * limit, sign * mean * mu])
    .filter(([speed]) => sign * speed <= sign * end));
  return [half(-1, low), half(1, high)].filter((part) => part.length > 1);
}

/** Mean friction of a solved scene at a belt speed of the run; null where it is not unique. */
function solvedMean({ mu, limit, scene }, speed) {
  const state = solvePoint(scene, Math.abs(speed) / limit * scene.limitSpeed);
  return state.unique ? Math.sign(speed) * mu * state.mean : null;
}

function drawRun() {
  const curves = curvesChosen(), here = run.abscissa.values[along];
  const values = run.curves.flatMap((curve) => [...curve.mean, ...curve.low, ...curve.high]).filter((v) => v !== null);
  const spanned = spanOf(values.length ? [...values, 0] : [0, 1], 0.05);
  const chart = runChart = drawAxes(byId("run-curves"),
    { label: run.abscissa.label, span: spanOf(run.abscissa.values, 0.02) }, { label: "mean friction coefficient", span: spanned });
  chart.upright(here, { stroke: "var(--ink)" });
  chart.level(0, { stroke: "var(--mark)" });
  const solved = coulombCurves(curves), ends = [run.abscissa.values[0], run.abscissa.values.at(-1)];
  for (const each of solved) for (const part of inUnitsOfRun(each, ends)) chart.line(part, SOLVED);
  const drawn = curves.filter((curve) => curve.look !== null);
  for (const curve of drawn) drawBand(chart, curve, spanned);
  for (const curve of drawn) {
    const look = lookOf(curve.look);
    for (const part of partsOf(curve)) chart.line(part, look);
    const at = curve.x.indexOf(here);
    if (at >= 0 && curve.mean[at] !== null) chart.dot([here, curve.mean[at]], { fill: look.stroke, stroke: "var(--paper)" });
  }
  // Curves of one scene have one V_{lin}, known to rounding: one mark for all of them.
  for (const kink of new Set(curves.filter((curve) => curve.kink !== null).map((curve) => Number(curve.kink.toPrecision(9))))) {
    chart.upright(kink, { "stroke-dasharray": "2 4" });
    chart.text(chart.px(kink) - 4, chart.top + 12, "V_{lin}", { "text-anchor": "end" });
  }
  listValues(curves, here, solved);
}

/** The stretches of a curve that have numbers. */
function partsOf(curve) {
  const parts = [[]];
  curve.x.forEach((x, i) => {
    if (curve.mean[i] === null) parts.push([]); else parts.at(-1).push([x, curve.mean[i]]);
  });
  return parts.filter((part) => part.length > 0).map((part) => (part.length > 1 ? part : [...part, ...part]));
}

function drawBand(chart, curve, span) {
  const fill = lookOf(curve.look).stroke, wide = VISIBLE * (span[1] - span[0]);
  const known = curve.x.map((x, i) => i).filter((i) => curve.mean[i] !== null && curve.error[i] !== null);
  if (known.some((i) => curve.error[i] > wide)) {
    const edge = (side) => known.map((i) => [curve.x[i], clamp(curve.mean[i] + side * curve.error[i], span)]);
    chart.area([...edge(1), ...edge(-1).reverse()], { fill, opacity: 0.16 });
  }
  curve.x.forEach((x, i) => {
    if (curve.low[i] !== null) chart.line([[x, curve.low[i]], [x, curve.high[i]]], { stroke: fill, "stroke-width": 3, opacity: 0.5 });
  });
}

function clamp(value, [low, high]) {
  return Math.min(Math.max(value, low), high);
}

/** The table beside the chart, which is its legend, too. */
function listValues(curves, here, solved) {
  const table = document.getElementById("run-values");
  write(table.caption, `${run.abscissa.label} = ${Number(here.toPrecision(6))}`);
  const rows = curves.map((curve) => {
    const at = curve.x.indexOf(here);
    const status = at < 0 ? "no point here" : curve.status[at], mean = at < 0 ? null : curve.mean[at];
    const range = at >= 0 && curve.low[at] !== null ? `${shown(curve.low[at], 6)} ... ${shown(curve.high[at], 6)}` : "";
    const error = mean === null || curve.error[at] === null ? "" : curve.error[at].toExponential(1);
    const look = curve.look === null ? null : lookOf(curve.look);
    return listed(look, curve.law, [curve.method, mean === null ? range : shown(mean, 6), error, status]);
  });
  const own = solved.map((each) => {
    const mean = solvedMean(each, here);
    return listed(SOLVED, `Coulomb, \u03bc = ${Number(each.mu.toPrecision(6))}`,
      ["solved on this page", mean === null ? "" : shown(mean, 6), "", mean === null ? "not_unique" : "ok"]);
  });
  table.tBodies[0].replaceChildren(...rows, ...own);
}

/** A row of the table: how its curve is drawn, whose it is, and what there is to read. */
function listed(look, name, cells) {
  const row = document.createElement("tr"), head = document.createElement("th");
  head.scope = "row";
  const swatch = svgElement(head, "svg", { viewBox: "0 0 40 12", "aria-hidden": "true" });
  if (look !== null) svgElement(swatch, "line", { x1: 0, x2: 40, y1: 6, y2: 6, ...look });
  head.append(name);
  row.append(head);
  for (const text of cells) row.insertCell().textContent = text;
  return row;
}

run.swept.forEach((quantity, i) => {
  addSlider(`run-${i}`, quantity.label, quantity.values, 0, (at) => { places[i] = at; });
});
const middle = Math.floor((run.abscissa.values.length - 1) / 2);
const moveAlong = addSlider("run-along", run.abscissa.label, run.abscissa.values, middle, (at) => { along = at; });
dragged(byId("run-curves"), (x) => {
  const far = run.abscissa.values.map((value) => Math.abs(value - runChart.valueAt(x)));
  moveAlong(far.indexOf(Math.min(...far)));
});
drawRun();
addEventListener("resize", drawRun);
