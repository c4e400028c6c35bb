"use strict";
/* Charts as SVG: axes with ticks, and on them lines, areas, bars and marks in the units of the axes. */

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 58, right: 14, top: 12, bottom: 44 };

function svgElement(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) {
    for (const [letters, level] of levelsOf(text)) {
      const part = document.createElementNS(SVG, "tspan");
      part.textContent = letters;
      if (level) part.setAttribute("font-size", "75%");
      if (level) part.setAttribute("baseline-shift", "sub");
      element.append(part);
    }
  }
  parent.append(element);
  return element;
}

/** Text cut at its subscripts, which stand in "_{}". */
function levelsOf(text) {
  return text.split(/_\{([^}]*)\}/).map((part, i) => [part, i % 2]).filter(([part]) => part);
}

/** Put text with subscripts into an element. */
function write(element, text) {
  element.replaceChildren(...levelsOf(text).map(([letters, level]) => {
    const part = document.createElement(level ? "sub" : "span");
    part.textContent = letters;
    return part;
  }));
}

/** Round numbers within the span, two at least and about as many as asked for. */
function ticksOf(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) ticks.push(i * step);
  // One number is no scale.
  if (ticks.length < 2 && most < 20) return ticksOf(low, high, 2 * most);
  return { ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** A span around the values with some air; a flat one is widened. */
function spanOf(values, air) {
  const found = values.filter(Number.isFinite);
  const low = Math.min(...found), high = Math.max(...found);
  const room = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? (high - low) * air : 0.1 * (Math.abs(high) || 1);
  return [low - room, high + room];
}

/** Empty the svg and draw axes; functions that draw on them in their units. x, y: {label, span}. */
function drawAxes(svg, x, y) {
  svg.replaceChildren();
  const width = svg.clientWidth || 600, height = svg.clientHeight || 240;
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const [left, right, top, bottom] = [MARGIN.left, width - MARGIN.right, MARGIN.top, height - MARGIN.bottom];
  const px = (value) => left + (right - left) * (value - x.span[0]) / (x.span[1] - x.span[0]);
  const py = (value) => bottom - (bottom - top) * (value - y.span[0]) / (y.span[1] - y.span[0]);
  const across = ticksOf(...x.span, Math.max(3, (right - left) / 80)), up = ticksOf(...y.span, Math.max(3, (bottom - top) / 45));
  for (const tick of across.ticks) {
    svgElement(svg, "line", { class: "grid", x1: px(tick), x2: px(tick), y1: top, y2: bottom });
    svgElement(svg, "text", { x: px(tick), y: bottom + 17, "text-anchor": "middle" }, shown(tick, across.digits));
  }
  for (const tick of up.ticks) {
    svgElement(svg, "line", { class: "grid", x1: left, x2: right, y1: py(tick), y2: py(tick) });
    svgElement(svg, "text", { x: left - 6, y: py(tick) + 4, "text-anchor": "end" }, shown(tick, up.digits));
  }
  svgElement(svg, "path", { class: "axis", fill: "none", d: `M${left},${top}V${bottom}H${right}` });
  svgElement(svg, "text", { x: (left + right) / 2, y: height - 9, "text-anchor": "middle" }, x.label);
  const middle = (top + bottom) / 2;
  svgElement(svg, "text", { x: 14, y: middle, "text-anchor": "middle", transform: `rotate(-90 14 ${middle})` }, y.label);
  // An empty path is none that a browser reads.
  const path = (points) => (points.length ? "" : "M0,0") + points.map(([a, b], i) => `${i ? "L" : "M"}${px(a).toFixed(2)},${py(b).toFixed(2)}`).join("");
  return {
    px, py, left, right, top, bottom,
    valueAt: (place) => x.span[0] + (x.span[1] - x.span[0]) * (place - left) / (right - left),
    line: (points, look) => svgElement(svg, "path", { fill: "none", stroke: "var(--ink)", "stroke-width": 2, ...look, d: path(points) }),
    area: (points, look) => svgElement(svg, "path", { stroke: "none", ...look, d: `${path(points)}Z` }),
    dot: ([a, b], look) => svgElement(svg, "circle", { cx: px(a), cy: py(b), r: 5, fill: "var(--ink)", ...look }),
    box: (from, to, low, high, look) => svgElement(svg, "rect", { x: px(from), width: Math.max(px(to) - px(from), 1), y: low, height: high - low, ...look }),
    upright: (at, look) => svgElement(svg, "line", { x1: px(at), x2: px(at), y1: top, y2: bottom, stroke: "var(--soft)", ...look }),
    level: (at, look) => svgElement(svg, "line", { x1: left, x2: right, y1: py(at), y2: py(at), stroke: "var(--soft)", ...look }),
    text: (a, b, text, look) => svgElement(svg, "text", { x: a, y: b, ...look }, text),
  };
}

/** While a pointer is down on the svg, its place across it is told. */
function dragged(svg, moved) {
  let down = false;
  const tell = (event) => moved(event.clientX - svg.getBoundingClientRect().left);
  svg.classList.add("dragged");
  svg.addEventListener("pointerdown", (event) => { down = true; tell(event); });
  addEventListener("pointermove", (event) => { if (down) tell(event); });
  for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => { down = false; });
}

/** A number for reading, with a true minus sign. */
function shown(value, digits) {
  return (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits).replace("-", "\u2212");
}

/** A number to four significant digits. */
function significant(value) {
  if (!Number.isFinite(value)) return "\u2013";
  const digits = Math.min(Math.max(3 - Math.floor(Math.log10(Math.abs(value) || 1)), 0), 8);
  return shown(value, digits);
}
