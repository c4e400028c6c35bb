# ruff: noqa: E501
"""A study without mistakes, and single mistakes to put into it: what to replace, by what, and the message."""

from __future__ import annotations

GOOD = """\
schema: 1
title: Two loads
source: Fig. 9b
scene:
  damping_ratio: 0.1
  normal_load: 10
  belt_speed: 5
  drive: {unbalance: 10, frequency: 1}
  transverse:
    natural_frequency: 0.5
    damping_ratio: 0.1
    load: {unbalance: 10}
laws:
  - {kind: coulomb, mu: 0.4}
  - {kind: coulomb, mu: 0.3, label: soft}
methods: [auto, {kind: shooting, label: second}]
tolerance: 1e-6
sweep:
  scene.belt_speed: {start: 0.5, stop: 60, num: 120}
  laws.soft.mu: [0.1, 0.2]
keep: {orbit: 200}
expect:
  - {where: {law: coulomb, scene.belt_speed: 5}, column: error, below: 1, because: Fig. 9b}
"""

BODY = GOOD[GOOD.index("damping_ratio") : GOOD.index("\nlaws:")]
"""The values of its scene."""

# fmt: off
EDITS = [
    # top level
    ("title: Two loads", "titel: Two loads", "2:1: titel: unknown key; allowed: schema, title,"),
    ("title: Two loads", "title: 2024", "2:8: title: must be text, got 2024 (put it in quotes)"),
    ("title: Two loads", "title:", "2:1: title: must be text, got null"),
    ("title: Two loads", "title: 2020-01-01", "2:8: title: must be text, got the date 2020-01-01 (put it in"),
    ("title: Two loads", "title: !foo x", "2:8: title: the YAML tag !foo has no meaning here"),
    ("title: Two loads", "schema: 1", "2:1: schema: given twice, first in line 1"),
    ("title: Two loads", "plugins: a.py", "2:10: plugins: must be a list of Python files such as [my_law.py], got the text"),
    ("title: Two loads", "plugins: [3]", "2:11: plugins[0]: must be text, got 3"),
    ("title: Two loads", "dimensional: {}", "2:1: dimensional: is a part of the scene: write scene: {dimensional: {"),
    ("title: Two loads", "? [1, 2]\n: 3", "2:3: a key must be a name"),
    ("title: Two loads", "3: x", "2:1: 3: unknown key"),
    ("title: Two loads", "<<: {title: x}", "2:1: merge keys (<<) are not used here"),
    ("schema: 1\n", "", "1:1: schema: required key is missing"),
    ("schema: 1", "schema: '1'", "1:9: schema: must be 1, got the text '1' (remove the quotes)"),
    ("schema: 1", "schema: 2", "1:9: schema: must be 1, got 2"),
    ("tolerance: 1e-6", "tolerance: 0", "17:12: tolerance: must be > 0, got 0"),
    ("keep: {orbit: 200}", "keep: {orbit: 1}", "21:15: keep.orbit: must be >= 2, got 1"),
    ("keep: {orbit: 200}", "keep: {orbits: 2}", "21:8: keep.orbits: unknown key; allowed: orbit, attractors, harmonics"),
    ("keep: {orbit: 200}", "keep: 200", "21:7: keep: must be a mapping (key: value), got 200"),
    # scene
    ("damping_ratio: 0.1\n  n", "n", "4:1: scene.damping_ratio: required key is missing"),
    ("damping_ratio: 0.1\n  n", "damping_ratio: !!binary aGk=\n  n",
     "5:18: scene.damping_ratio: the YAML tag tag:yaml.org,2002:binary has no meaning here"),
    ("normal_load: 10", "normal_load: 0", "6:16: scene.normal_load: must be > 0, got 0"),
    ("drive: {unbalance: 10, frequency: 1}", "drive:", "8:3: scene.drive: must be a mapping, got null"),
    ("drive: {unbalance: 10, frequency: 1}", "drive: {unbalance: 10, frequency: 1, waveform: {square: {duty: 1}}}",
     "8:66: scene.drive.waveform.square.duty: must be > 0 and < 1, got 1"),
    # laws
    ("mu: 0.4", "mu: -1", "14:25: laws[0].mu: must be > 0, got -1"),
    ("mu: 0.4", "mu: 0.4, mu_static: 0.1", "14:41: laws[0].mu_static: must be >= mu = 0.4, got 0.1"),
    ("kind: coulomb, mu: 0.4", "kind: colomb, mu: 0.4", "14:12: laws[0].kind: unknown law 'colomb'; installed: "),
    ("kind: coulomb, mu: 0.4", "kind: dahl, mu: 0.4, stiffness: 40, presliding_length: 1, label: coulomb",
     "14:61: laws[0].presliding_length: leave it out where stiffness is given"),
    ("kind: coulomb, mu: 0.4", "kind: dahl, mu: 0.4, stiffness: 40, exponent: -1, label: coulomb",
     "14:52: laws[0].exponent: must be >= 0, got -1"),
    ("kind: coulomb, mu: 0.4", "kind: lugre, mu_kinetic: 0.4, stiffness: 40, damping: 1, contact_damping: 1, label: coulomb",
     "14:80: laws[0].contact_damping: leave it out where damping is given"),
    ("kind: coulomb, mu: 0.4", "kind: lugre, mu_kinetic: 0.4, stiffness: 40, mu_static: 0.3, label: coulomb",
     "14:62: laws[0].mu_static: must be >= mu_kinetic = 0.4, got 0.3"),
    ("kind: coulomb, mu: 0.4", "kind: lugre, mu_kinetic: 0.4, stiffness: 40, planar: vectoral, label: coulomb",
     "14:59: laws[0].planar: must be 'vectorial' or 'per-axis'; got the text 'vectoral'"),
    ("kind: coulomb, mu: 0.4", "kind: elasto-plastic, mu_kinetic: 0.4, stiffness: 40, breakaway_ratio: 1, label: coulomb",
     "14:77: laws[0].breakaway_ratio: must be < 1, got 1"),
    ("kind: coulomb, mu: 0.4", "kind: dahl, mu: 1e-300, presliding_length: 1e300, label: coulomb",
     "14:5: laws[0]: these values give no finite stiffness > 0: check their units"),
    ("kind: coulomb, mu: 0.4", "kind: 3, mu: 0.4", "14:12: laws[0].kind: must be the name of a law, got 3"),
    ("{kind: coulomb, mu: 0.4}", "coulomb: {mu: 0.4}", "14:5: laws[0].coulomb: a name goes after kind"),
    ("label: soft", "label: coulomb", "15:37: laws[1].label: laws[0] has the label 'coulomb' too"),
    ("label: soft", "label: ''", "15:37: laws[1].label: must be one line of visible text"),
    ("label: soft", "label: 4", "15:37: laws[1].label: must be text, got 4"),
    ("  - {kind: coulomb, mu: 0.4}", "  - coulomb", "14:5: laws[0]: must be a mapping such as {kind: coulomb, mu: 0.4}"),
    ("laws:\n  - {kind: coulomb, mu: 0.4}\n  - {kind: coulomb, mu: 0.3, label: soft}", "laws: []",
     "13:1: laws: the list is empty; give at least one, such as [{kind: coulomb, mu: 0.4}]"),
    ("laws:\n  - {kind: coulomb, mu: 0.4}\n  - {kind: coulomb, mu: 0.3, label: soft}", "laws: {kind: coulomb}",
     "13:1: laws: must be a list such as [{kind: coulomb, mu: 0.4}], got a mapping"),
    # methods
    ("methods: [auto, ", "methods: [{kind: exact, certify: true}, ", "16:25: methods[0].certify: is gone: use method certified, which the package"),
    ("methods: [auto, ", "methods: [autto, ", "16:11: methods[0]: unknown method 'autto'; installed: auto"),
    ("methods: [auto, ", "methods: [auto, auto, ", "16:17: methods[1]: methods[0] has the label 'auto' too"),
    ("methods: [auto, {kind: shooting, label: second}]", "methods: auto", "16:10: methods: must be a list such as [auto]"),
    # sweep
    ("{start: 0.5, stop: 60, num: 120}", "[]", "19:3: sweep.scene.belt_speed: the list is empty"),
    ("{start: 0.5, stop: 60, num: 120}", "5", "19:21: sweep.scene.belt_speed: must be a list or {start, stop, num, spac"),
    ("{start: 0.5, stop: 60, num: 120}", "[1, 2, 1.0]", "19:28: sweep.scene.belt_speed[2]: 1 is in the list twice"),
    ("stop: 60", "stop: 0.5", "19:40: sweep.scene.belt_speed.stop: must be > start = 0.5, got 0.5"),
    ("num: 120", "num: 100000000", "19:49: sweep.scene.belt_speed.num: must be <= 1000000, got 100000000"),
    ("num: 120}", "num: 100000}\n  scene.damping_ratio: {start: 1, stop: 2, num: 2000}", "18:1: sweep: the grid has 1200000000 points, more"),
    (", num: 120", ", within: 1e-6", "19:52: sweep.scene.belt_speed.within: must be >= 1e-05, 10 times tolerance, got 1e-06"),
    ("laws.soft.mu: [0.1, 0.2]", "laws.soft.mu: {start: 0.1, stop: 0.2, within: 1e-3}", "20:41: sweep.laws.soft.mu.within: belt speeds alone are"),
    ("num: 120", "num: 120, spacing: logg", "19:63: sweep.scene.belt_speed.spacing: must be 'linear' or 'log'; got the text"),
    ("start: 0.5, stop: 60, num: 120", "start: 0, stop: 60, num: 120, spacing: log",
     "19:29: sweep.scene.belt_speed.start: must be > 0 for log spacing, got 0"),
    ("start: 0.5, stop: 60", "start: 1, stop: 1.000000000000001", "19:3: sweep.scene.belt_speed: there are no 120 different"),
    ("  scene.belt_speed: {", "  scene.belt_sped: {", "19:3: sweep.scene.belt_sped: no such value in a scene"),
    ("  scene.belt_speed: {", "  belt_speed: {", "19:3: sweep.belt_speed: only scene.<value>, laws.<label>.<parameter>, fric"),
    ("  scene.belt_speed: {", "  scene.slip.phase: {", "19:3: sweep.scene.slip.phase: the study has no scene.slip"),
    ("  scene.belt_speed: {", "  scene.drive.amplitude: {",
     "19:3: sweep.scene.drive.amplitude: scene.drive gives unbalance, so amplitude cannot be swept"),
    ("laws.soft.mu: [0.1, 0.2]", "laws.soft.mu: [0.1, -0.2]", "20:23: sweep.laws.soft.mu[1]: must be > 0, got -0.2"),
    ("laws.soft.mu: [0.1, 0.2]", "linked: [{scene.normal_load: [1, 2], laws.soft.mu: [3]}]", "20:40: sweep.linked[0].laws.soft.mu: has 1 values"),
    ("laws.soft.mu: [0.1, 0.2]", "linked: [{scene.normal_load: [1, 2]}]", "20:12: sweep.linked[0]: one list alone links nothing"),
    ("laws.soft.mu: [", "laws.sofd.mu: [", "20:3: sweep.laws.sofd.mu: no law is labelled 'sofd'"),
    ("laws.soft.mu: [", "laws.soft.mv: [", "20:3: sweep.laws.soft.mv: the law 'soft' has no parameter 'mv' to sweep"),
    ("laws.soft.mu: [", "laws.mu: [", "20:3: sweep.laws.mu: write laws.<label>.<parameter>"),
    # expect
    ("law: coulomb, scene", "law: colomb, scene", "23:19: expect[0].where.law: must be one of coulomb, soft; got the text"),
    ("scene.belt_speed: 5}", "scene.belt_sped: 5}", "23:28: expect[0].where.scene.belt_sped: is no input column"),
    ("column: error", "column: model", "23:58: expect[0].column: 'model' holds text; only numbers can be compared"),
    ("below: 1", "below: 1, above: 0", "23:5: expect[0]: give exactly one of equals, below and above, got below and above"),
    ("column: error, below: 1", "shape: concave",
     "23:28: expect[0].where.scene.belt_speed: a shape belongs to a whole curve: leave the belt speed out"),
    (", scene.belt_speed: 5}, column: error, below: 1", "}, shape: concav",
     "23:36: expect[0].shape: must be 'concave', 'convex', 'mixed' or 'undecided'; got the text 'concav'"),
    (", scene.belt_speed: 5}, column: error, below: 1", "}, shape: mixed, measure: initial",
     "23:36: expect[0].shape: must be one of concave, convex, undecided; got the text 'mixed'"),
    (", scene.belt_speed: 5}, column: error, below: 1", "}, shape: convex, measure: half",
     "23:53: expect[0].measure: must be 'area' or 'initial'; got the text 'half'"),
    (", scene.belt_speed: 5}, column: error, below: 1", "}, shape: convex, below: 1",
     "23:51: expect[0].below: does not go with shape"),
    ("below: 1", "below: 1, measure: area", "23:84: expect[0].measure: goes with shape"),
    ("column: error, below: 1", "status: fine", "23:58: expect[0].status: must be 'ok', 'refused', 'failed' or 'not_unique';"),
    ("column: error, below: 1", "status: ok, below: 1", "23:69: expect[0].below: does not go with status"),
    ("column: error, below: 1", "max_difference: [auto, third], below: 1",
     "23:73: expect[0].max_difference[1]: must be one of auto, second; got the text 'third'"),
    ("column: error, below: 1", "max_difference: [auto, auto], below: 1",
     "23:73: expect[0].max_difference[1]: is the same method: give two different ones"),
    ("column: error, below: 1", "max_difference: auto, below: 1", "23:66: expect[0].max_difference: must be a list of two"),
    ("scene.belt_speed: 5}", "scene.belt_speed: {form: 5}}", "23:47: expect[0].where.scene.belt_speed.form: unknown key"),
    ("scene.belt_speed: 5}", "scene.belt_speed: {}}", "23:28: expect[0].where.scene.belt_speed: give from, to or both"),
    ("scene.belt_speed: 5}", "scene.belt_speed: [5, fast]}", "23:50: expect[0].where.scene.belt_speed[1]: must be a number"),
    ("law: coulomb, scene", "law: [soft, colomb], scene", "23:26: expect[0].where.law[1]: must be one of coulomb, soft"),
    ("below: 1", "below: 1, minus: {law: [soft]}", "23:83: expect[0].minus.law: must be one of coulomb, soft"),
    ("below: 1", "below: 1, minus: {law: soft}, over: {law: soft}", "23:95: expect[0].over: give minus or over, not both"),
    ("column: error, below: 1", "status: ok, minus: {law: soft}", "23:62: expect[0].minus: does not go with status"),
    ("column: error", "column: shape_area", "23:28: expect[0].where.scene.belt_speed: a shape belongs to a whole curve"),
    ("because: Fig. 9b}", "because: 9}", "23:84: expect[0].because: must be text, got 9 (put it in quotes)"),
    # waveforms, directions, belt vibration, varying normal load
    ("frequency: 1}", "frequency: 1, waveform: 3}",
     "8:50: scene.drive.waveform: must be 'sine', 'square', 'triangle', 'sawtooth', {square: {duty: 0.3}}, {sawtooth: {width: 0.3}}, {points: [[0, 0], ...]}, {file: measured.csv} or {harmonics: [...]}, got 3"),
    ("frequency: 1}", "frequency: 1, waveform: }", "8:40: scene.drive.waveform: must be a value, got null"),
    ("frequency: 1}", "frequency: 1, waveform: {harmonics: []}}",
     "8:51: scene.drive.waveform.harmonics: must be 1 to 64 terms, got 0; a sum of harmonics is {harmonics: [{order: 1, amp"),
    ("frequency: 1}", "frequency: 1, waveform: {harmonic: []}}",
     "8:51: scene.drive.waveform.harmonic: unknown key; a sum of harmonics is {harmonics: [{order: 1, amplitude: 1, phase:"),
    ("frequency: 1}", "frequency: 1, direction: 30}",
     "8:51: scene.drive.direction: leave it out with transverse.load, which gives the force across the belt"),
    ("frequency: 1}\n  transverse:\n    natural_frequency: 0.5\n    damping_ratio: 0.1\n    load: {unbalance: 10}",
     "frequency: 1, direction: 30}",
     "8:51: scene.drive.direction: needs transverse, without which nothing moves across the belt"),
    (BODY, "belt_speed: 5\n  slip: {velocity_amplitude: 1, frequency: 1, direction: 30}\n  transverse_slip: {velocity_amplitude: 1}",
     "6:58: scene.slip.direction: leave it out with transverse_slip"),
    (BODY, "belt_speed: 5\n  slip: {velocity_amplitude: 1, frequency: 1}\n  belt_vibration: {velocity_amplitude: 1}",
     "7:3: scene.belt_vibration: leave it out with a prescribed slip"),
    ("load: {unbalance: 10}\n", "load: {unbalance: 10}\n  belt_vibration: {velocity_amplitude: 1, frequency: 2}\n",
     "13:54: scene.belt_vibration.frequency: leave it out, drive.frequency holds for all (frequency_ratio gives another"),
    (BODY, "belt_speed: 5\n  normal_load: 1\n  damping_ratio: 1\n  belt_vibration: {velocity_amplitude: 1, frequency: 2, frequency_ratio: 2}",
     "8:74: scene.belt_vibration.frequency_ratio: leave it out where frequency is given"),
    ("load: {unbalance: 10}\n", "load: {unbalance: 10, frequency_ratio: 1.4142}\n",
     '12:44: scene.transverse.load.frequency_ratio: must be p/q in whole numbers, q at most 64 and p/q from 1/64 to 1000, such as 2, 0.5 or "3/2", got 1.4142'),
    ("load: {unbalance: 10}\n", "load: {unbalance: 10, frequency_ratio: 1/61}\n  belt_vibration: {velocity_amplitude: 1, frequency_ratio: 1/2}\n",
     "12:44: scene.transverse.load.frequency_ratio: with it everything repeats after 122 periods of the drive only, more"),
    ("load: {unbalance: 10}\n", "load: {unbalance: 10}\n  normal_load_variation: {amplitude: 1.2}\n",
     "13:38: scene.normal_load_variation.amplitude: the normal load must stay positive over the whole period, here for amplitudes below 1, got 1.2"),
    ("load: {unbalance: 10}\n", "load: {unbalance: 10}\n  normal_load_variation: {amplitude: 0.2, contact: perload}\n",
     "13:52: scene.normal_load_variation.contact: must be 'per_load' or 'constant'; got the text 'perload'"),
    ("  scene.belt_speed: {start: 0.5, stop: 60, num: 120}", "  scene.drive.waveform: [sine, square]\n  scene.drive.waveform: 3",
     "20:3: sweep.scene.drive.waveform: given twice, first in line 19"),
    ("  laws.soft.mu", "  scene.drive.waveform: {start: 1, stop: 2, num: 3}\n  laws.soft.mu",
     "20:3: sweep.scene.drive.waveform: must be a list, got a mapping"),
    ("  laws.soft.mu", "  scene.drive.waveform: [sine, square, sine]\n  laws.soft.mu",
     "20:40: sweep.scene.drive.waveform[2]: sine is in the list twice"),
    ("  laws.soft.mu", "  scene.transverse.load.frequency_ratio: [1, 3/2, 1.5]\n  laws.soft.mu",
     "20:51: sweep.scene.transverse.load.frequency_ratio[2]: 1.5 is in the list twice"),
    ("  laws.soft.mu", "  scene.drive.wavform: [sine, square]\n  laws.soft.mu", "20:3: sweep.scene.drive.wavform: no such value in"),
    ("5}, column: error", "5, scene.drive.waveform: square}, column: error",
     "23:49: expect[0].where.scene.drive.waveform: is no input column of this study's table"),
    ("laws.soft.mu: [0.1, 0.2]\nkeep: {orbit: 200}\nexpect:\n  - {where: {law: coulomb, scene.belt_speed: 5}",
     "scene.drive.waveform: [sine, square]\nexpect:\n  - {where: {law: coulomb, scene.drive.waveform: sawtooth}",
     "22:50: expect[0].where.scene.drive.waveform: the table has sine, square alone, got sawtooth"),
]

HINTS = [
    ("schema: 1\n", "", "write schema: 1"),
    ("{kind: coulomb, mu: 0.4}", "coulomb: {mu: 0.4, mu_static: 0.5}", "write {kind: coulomb, mu: 0.4, mu_static: 0.5}"),
    ("{kind: coulomb, mu: 0.4}", "coulomb: 0.4", "write {kind: coulomb, ...}"),
    ("{kind: shooting, label: second}", "{march: {steps: 100}}", "write {kind: march, steps: 100}"),
    ("kind: coulomb, mu: 0.4", "kind: coulomb, mu_kinetic: 0.4", "did you mean 'mu'?"),
    ("kind: coulomb, mu: 0.4", "kind: coulomb, mu: 0.4, mu_kinetic: 0.4", "did you mean 'mu_static'?"),
    ("  scene.belt_speed: {", "  frequency: {", "did you mean 'scene.drive.frequency'?"),
    ("  scene.belt_speed: {", "  mu: {", "did you mean 'laws.coulomb.mu'?"),
    ("  scene.belt_speed: {", "  belt_speed: {", "did you mean 'scene.belt_speed'?"),
    ("title", "titel", "did you mean 'title'?"),
    ("kind: coulomb, mu: 0.4", "kind: colomb, mu: 0.4", "did you mean 'coulomb'?"),
    ("mu: 0.4", "mu: 0.4, mus: 1", "did you mean 'mu_static'?"),
    ("methods: [auto", "methods: [autoo", "did you mean 'auto'?"),
    ("laws.soft.mu: [", "laws.sofd.mu: [", "did you mean 'laws.soft.mu'?"),
    ("column: error", "column: Error", "did you mean 'error'?"),
    ("scene.belt_speed: 5}", "scene.belt_sped: 5}", "did you mean 'scene.belt_speed'?"),
    ("law: coulomb, scene", "law: sofft, scene", "did you mean 'soft'?"),
    ("num: 120", "num: 120, spacing: logg", "did you mean 'log'?"),
]
"""Mistakes with a remedy: the last line of the message."""
# fmt: on
