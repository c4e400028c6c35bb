"use strict";
/* Steady states of a mass on a moving belt under Coulomb friction and one sine, without time steps:

     x'' + 2 damping x' + x + friction Sgn(x' - belt) = sin(frequency t)

   Lengths, forces and speeds are those of the scene over the amplitude of the load. Between events the motion is a
   closed form: slip of one sign, or rest on the belt. A periodic state is a fixed point of the map over one period,
   found by Newton's method; derivatives go through events by saltation. Damping is above zero, so that the map has
   one fixed point and iterating it leads there; it never expands, which is why Newton's method falls back to it. */

const ROUNDING = 2.3e-16;
const STICK = 0;
const MOST_LEGS = 100000;
const MOST_MAPS = 3000;

/** The scene without its belt: friction is mu * normal load over load amplitude, limit speed is V_lin. */
function makeScene(frequency, damping, friction) {
  const stiffness = (1 - frequency) * (1 + frequency), viscous = 2 * damping * frequency;
  const square = stiffness * stiffness + viscous * viscous, amplitude = 1 / Math.sqrt(square);
  return {
    frequency, damping, friction, amplitude,
    period: 2 * Math.PI / frequency,
    rate: Math.sqrt(Math.abs((1 - damping) * (1 + damping))),
    sine: stiffness / square,
    cosine: -viscous / square,
    limitSpeed: frequency * amplitude,
  };
}

/** Position and velocity of the response to the load alone. */
function response(scene, t) {
  const sine = Math.sin(scene.frequency * t), cosine = Math.cos(scene.frequency * t);
  return {
    x: scene.sine * sine + scene.cosine * cosine,
    v: scene.frequency * (scene.sine * cosine - scene.cosine * sine),
  };
}

/** Entries of the free motion over a time r: (y, y') becomes (keep y + turn y', damp y' - turn y). */
function freeMotion(scene, r) {
  const b = scene.damping, rate = scene.rate;
  let cosine = Math.exp(-b * r), sine = cosine * r;
  if (b < 1) {
    sine = cosine * Math.sin(rate * r) / rate;
    cosine *= Math.cos(rate * r);
  } else if (rate > 0) {
    // cosh and sinh times exp(-b r), with the slow exponential taken out so that neither overflows
    const slow = Math.exp(-r / (b + rate)), gone = Math.expm1(-2 * rate * r);
    cosine = slow * (1 + 0.5 * gone);
    sine = -slow * gone / (2 * rate);
  }
  return { keep: cosine + b * sine, turn: sine, damp: cosine - b * sine };
}

/** Net force on a body at slip velocity zero, without friction. */
function netForce(scene, belt, t, x) {
  return Math.sin(scene.frequency * t) - 2 * scene.damping * belt - x;
}

/** What follows slip velocity zero: rest, or slip along the net force. */
function afterRest(scene, net) {
  return Math.abs(net) <= scene.friction ? STICK : Math.sign(net);
}

/** Slip of one sign from x and slip velocity w at time t: the motion as a function of the time r since then.
    slip, slope and bend are sign * w and its first two derivatives; jerk bounds the third. */
function slipMotion(scene, belt, t, x, w, sign) {
  const start = response(scene, t), square = scene.frequency * scene.frequency, b2 = 2 * scene.damping;
  const y0 = x - start.x + sign * scene.friction, z0 = w + belt - start.v;
  const second = -z0 - b2 * (-y0 - b2 * z0), third = y0 + b2 * z0 - b2 * second;
  const motion = (r) => {
    const free = freeMotion(scene, r), forced = response(scene, t + r);
    const y = free.keep * y0 + free.turn * z0, z = free.damp * z0 - free.turn * y0;
    const pull = -y - b2 * z;
    return {
      x: y + forced.x - sign * scene.friction,
      w: z + forced.v - belt,
      slip: sign * (z + forced.v - belt),
      slope: sign * (pull - square * forced.x),
      bend: sign * (-z - b2 * pull - square * forced.v),
      free,
    };
  };
  // The free motion only shrinks: the bound at the start holds for the whole leg.
  return { motion, jerk: Math.hypot(second, third) + square * square * scene.amplitude };
}

/** The first zero of the slip velocity of a leg before `left`; -1 without one. Panels from left to right: each is
    free of zeros, or falls monotonically through one, or is halved. */
function firstZero(leg, left, fromRest) {
  const { motion, jerk } = leg;
  let r = fromRest ? Math.min(riseTime(motion(0), jerk), left) : 0;
  let width = Math.min(left - r, 0.5);
  while (r < left) {
    width = Math.min(width, left - r);
    const half = 0.5 * width, middle = motion(r + half), third = jerk * half * half / 2;
    const lowest = middle.slip - Math.abs(middle.slope) * half
      - Math.max(-middle.bend, 0) * half * half / 2 - third * half / 3;
    const monotone = Math.abs(middle.slope) > Math.abs(middle.bend) * half + third;
    if (lowest > 0 || (monotone && (middle.slope > 0 || motion(r + width).slip > 0))) {
      r += width;
      width *= 2;
    } else if (monotone) {
      return rootBetween((s) => { const m = motion(s); return [m.slip, m.slope]; }, r, r + width);
    } else if (width < 1e-14 * (1 + r)) {
      // It touches zero to rounding.
      if (middle.slip <= 0) return r + half;
      r += width;
      width *= 4;
    } else {
      width *= 0.5;
    }
  }
  return -1;
}

/** For how long a slip velocity that starts from zero certainly stays above it. */
function riseTime(start, jerk) {
  const slope = Math.max(start.slope, 0), bend = start.bend;
  const root = Math.sqrt(bend * bend / 4 + 2 * jerk * slope / 3);
  const time = bend >= 0 ? (bend / 2 + root) * 3 / jerk : 2 * slope / (root - bend / 2);
  return Math.max(0.9 * time, 1e-12);
}

/** The zero between two places where the function has different signs, by Newton's method inside the bracket. */
function rootBetween(f, low, high) {
  const rises = f(high)[0] > 0;
  let r = 0.5 * (low + high);
  for (let i = 0; i < 100; i++) {
    const [value, slope] = f(r);
    if (value > 0 === rises) high = r; else low = r;
    let next = r - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (Math.abs(next - r) <= ROUNDING * Math.abs(r) || next === r) return next;
    r = next;
  }
  return r;
}

/** How long a body rests on the belt from x at time t, at most `left`, and the side to which it leaves (0: it stays).
    The net force has its extrema where the load rises as fast as the belt draws the spring, and is monotone between. */
function rest(scene, belt, t, x, left) {
  const { frequency, friction } = scene, forward = belt / frequency;
  const net = (r) => netForce(scene, belt, t + r, x + belt * r);
  const slope = (r) => frequency * Math.cos(frequency * (t + r)) - belt;
  const ends = [left];
  if (forward < 1) {
    const angle = Math.acos(forward);
    for (let turn = Math.floor(frequency * t / (2 * Math.PI)); ; turn++) {
      const found = [-angle, angle].map((a) => (a + 2 * Math.PI * turn) / frequency - t);
      ends.push(...found.filter((r) => r > 0 && r < left));
      if (found[1] >= left) break;
    }
    ends.sort((a, b) => a - b);
  }
  let from = 0;
  for (const to of ends) {
    const side = net(to) > friction ? 1 : net(to) < -friction ? -1 : 0;
    if (side !== 0) {
      const excess = (r) => [side * net(r) - friction, side * slope(r)];
      return { duration: excess(from)[0] >= 0 ? from : rootBetween(excess, from, to), side };
    }
    from = to;
  }
  return { duration: left, side: 0 };
}

/** The motion over one period from x and slip velocity w at t = 0: its end, the derivative of it by the start
    (xx, xw, wx, ww), impulse of friction and work absorbed by it over mu * normal load, time at
    rest; legs are noted if asked for. */
function periodMap(scene, belt, x, w, notes) {
  const { period, friction } = scene;
  let t = 0, xx = 1, xw = 0, wx = 0, ww = 1, impulse = 0, work = 0, stick = 0, legs = 0;
  let mode = startingMode(scene, belt, x, w);
  let fromRest = Math.abs(w) <= slipNoise(scene, belt, x);
  while (t < period) {
    if (++legs > MOST_LEGS) return { x: NaN, w: NaN };
    const left = period - t;
    let duration = left;
    if (mode === STICK) {
      const held = rest(scene, belt, t, x, left), side = held.side;
      duration = held.duration;
      if (notes) notes.push({ t, x, w: 0, mode, duration });
      const resisted = stuckImpulse(scene, belt, t, x, duration) / friction;
      impulse += resisted;
      work += belt * resisted;
      stick += duration;
      x += belt * duration;
      w = wx = ww = 0;
      mode = side;
    } else {
      if (fromRest) w = 0;
      const leg = slipMotion(scene, belt, t, x, w, mode), zero = firstZero(leg, left, fromRest);
      duration = zero < 0 ? left : zero;
      if (notes) notes.push({ t, x, w, mode, duration });
      const end = leg.motion(duration), { keep, turn, damp } = end.free;
      [xx, wx] = [keep * xx + turn * wx, damp * wx - turn * xx];
      [xw, ww] = [keep * xw + turn * ww, damp * ww - turn * xw];
      impulse += mode * duration;
      work += mode * (end.x - x);
      x = end.x;
      w = end.w;
      if (zero >= 0) {
        const net = netForce(scene, belt, t + duration, x), after = afterRest(scene, net);
        // Saltation: a velocity difference is taken by friction in stick; at a reversal it lasts, scaled by the forces.
        const kept = after === STICK ? 0 : (net - after * friction) / (net - mode * friction);
        w = 0;
        wx *= kept;
        ww *= kept;
        mode = after;
      }
    }
    fromRest = true;
    t = duration === left ? period : t + duration;
  }
  return { x, w, xx, xw, wx, ww, impulse, work, stick, legs };
}

function startingMode(scene, belt, x, w) {
  if (Math.abs(w) > slipNoise(scene, belt, x)) return Math.sign(w);
  return afterRest(scene, netForce(scene, belt, 0, x));
}

/** Slip velocities below this are zero to rounding. */
function slipNoise(scene, belt, x) {
  return 8 * ROUNDING * (scene.limitSpeed + belt + scene.amplitude + scene.friction + Math.abs(x));
}

/** The integral of the net force, which friction balances, over a time r of rest from t on. */
function stuckImpulse(scene, belt, t, x, r) {
  const half = 0.5 * scene.frequency * r;
  const load = 2 / scene.frequency * Math.sin(half) * Math.sin(scene.frequency * t + half);
  return load - r * (2 * scene.damping * belt + x + 0.5 * belt * r);
}

/** The steady state on a belt of this speed >= 0, looked for from a guess {x, w} of the state at t = 0.
    mean: mean friction coefficient over mu; work: absorbed by friction in a period, over mu * normal load; stick:
    share of the period; residual: how well the period closes. */
function steadyState(scene, belt, guess) {
  let next = guess || slippingState(scene, belt), state = next, image = null, size = Infinity;
  let share = 1, plain = true, stalled = 0, maps = 0;
  while (true) {
    const trial = periodMap(scene, belt, next.x, next.w);
    const trialSize = Math.hypot(trial.x - next.x, trial.w - next.w);
    maps += 1;
    if (!(trialSize < Infinity)) break;
    if (plain || trialSize < (1 - 0.25 * share) * size) {
      stalled = plain && trialSize >= size ? stalled + 1 : 0;
      share = plain ? 1 : Math.min(1, 4 * share);
      [state, image, size] = [next, trial, trialSize];
    } else {
      share *= 0.25;
    }
    const least = 4 * ROUNDING * (scene.amplitude + scene.limitSpeed + scene.friction + Math.abs(state.x) + belt);
    if (size <= least || maps >= MOST_MAPS || (stalled >= 4 && size < 1e4 * least)) break;
    const step = newtonStep(state, image);
    plain = share < 1e-6 || !(Math.abs(step.x) + Math.abs(step.w) < Infinity);
    next = plain
      ? { x: image.x, w: image.w }
      : { x: state.x + share * step.x, w: state.w + share * step.w };
  }
  if (!image) return { x: NaN, w: NaN, mean: NaN, work: NaN, stick: NaN, residual: Infinity, maps };
  const { period } = scene, { work } = image;
  return { ...state, mean: -image.impulse / period, work, stick: image.stick / period, residual: size, maps };
}

/** The state at t = 0 of a body that slips one way, back along the belt, all the time: the belt has drawn the spring as
    far as friction can hold it, so that no periods of rest have to be waited for. */
function slippingState(scene, belt) {
  const start = response(scene, 0);
  return { x: start.x + scene.friction, w: start.v - belt };
}

/** The solution of (1 - M) step = image - state; infinite where M has the eigenvalue 1. */
function newtonStep(state, image) {
  const a = 1 - image.xx, b = -image.xw, c = -image.wx, d = 1 - image.ww, determinant = a * d - b * c;
  if (Math.abs(determinant) < 1e-14) return { x: Infinity, w: Infinity };
  const rx = image.x - state.x, rw = image.w - state.w;
  return { x: (d * rx - b * rw) / determinant, w: (a * rw - c * rx) / determinant };
}

/** Mean friction over mu at `count` belt speeds up to V_lin, denser towards it, where the curve rises steeply: V_lin
    times the sine of even angles. Continued from V_lin, where the motion is linear, down. */
function solveCurve(scene, count) {
  const speeds = [1], means = [1], sticks = [0];
  let state = slippingState(scene, scene.limitSpeed), last = scene.limitSpeed;
  for (let i = count - 1; i >= 1; i--) {
    const ratio = Math.sin(0.5 * Math.PI * i / count), belt = ratio * scene.limitSpeed;
    state = steadyState(scene, belt, { x: state.x, w: state.w + (last - belt) });
    last = belt;
    speeds.unshift(ratio);
    means.unshift(state.mean);
    sticks.unshift(state.stick);
  }
  return { speeds, means, sticks, start: startFriction(scene) };
}

/** Mean friction over mu as belt speed falls to zero. A body that friction holds moves with the belt until spring and
    load at its peak exceed friction. */
function startFriction(scene) {
  return Math.max(0, 1 - 1 / scene.friction);
}

/** The steady state at one belt speed: that of steady sliding from V_lin on. `unique` is false where friction holds the
    body on a belt at rest: its mean is then anything between -startFriction and startFriction. */
function solvePoint(scene, belt) {
  if (belt >= scene.limitSpeed) {
    return { ...slippingState(scene, belt), mean: 1, work: 0, stick: 0, residual: 0, maps: 0, unique: true };
  }
  if (belt === 0 && scene.friction >= 1) {
    return { x: 0, w: 0, mean: NaN, work: 0, stick: 1, residual: 0, maps: 0, unique: false };
  }
  const state = steadyState(scene, belt, null);
  // On a belt at rest the orbit is its own mirror image half a period later.
  return { ...state, mean: belt === 0 ? 0 : state.mean, unique: true };
}

/** Samples of one period from a steady state: time, x, slip velocity w, friction over mu * normal load (resistance),
    jumps of friction included. */
function sampleOrbit(scene, belt, state, count) {
  const legs = [], samples = [];
  periodMap(scene, belt, state.x, state.w, legs);
  for (const { t, x, w, mode, duration } of legs) {
    const n = Math.max(2, Math.ceil(count * duration / scene.period));
    const motion = mode === STICK ? null : slipMotion(scene, belt, t, x, w, mode).motion;
    for (let i = 0; i <= n; i++) {
      const r = duration * i / n;
      if (mode === STICK) {
        const at = x + belt * r;
        samples.push({ t: t + r, x: at, w: 0, friction: netForce(scene, belt, t + r, at) / scene.friction, stick: true });
      } else {
        const at = motion(r);
        samples.push({ t: t + r, x: at.x, w: at.w, friction: mode, stick: false });
      }
    }
  }
  return samples;
}

/** The area between a curve of solveCurve and its chord up to a share of V_lin, twice, in shares of both spans; above and
    below apart. error: the area between the curves through all points and through every second one. */
function chordArea(curve, window) {
  const places = [0, ...curve.speeds], heights = [curve.start, ...curve.means];
  let last = places.length - 1;
  while (places[last] > window) last -= 1;
  const excess = (i) => (heights[i] - heights[0]) / (heights[last] - heights[0]) - places[i] / places[last];
  const panel = (from, to) => (places[to] - places[from]) / places[last] * (excess(from) + excess(to));
  let above = 0, below = 0, error = 1e-9;
  for (let i = 0; i < last; i += 2) {
    const middle = Math.min(i + 1, last), end = Math.min(i + 2, last);
    const parts = [panel(i, middle), panel(middle, end)];
    for (const part of parts) if (part > 0) above += part; else below -= part;
    error += Math.abs(parts[0] + parts[1] - panel(i, end));
  }
  return { area: above - below, above, below, error };
}

/** The verdict of shape by area: concave, convex, mixed or undecided. */
function shapeVerdict(curve) {
  const whole = chordArea(curve, 1), window = chordArea(curve, 0.8);
  const sign = ({ area, error }) => (Math.abs(area) > error ? Math.sign(area) : 0);
  let verdict = whole.area > 0 ? "concave" : "convex";
  if (whole.above > whole.error && whole.below > whole.error) verdict = "mixed";
  if (sign(whole) === 0 || sign(window) !== sign(whole)) verdict = "undecided";
  return { verdict, ...whole };
}

if (typeof module !== "undefined") {
  module.exports = { makeScene, solveCurve, solvePoint, startFriction, sampleOrbit, shapeVerdict };
}
