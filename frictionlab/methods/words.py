"""Column ``model``: a few words in every row, of each of which this is the sentence.

A model reads ``words; more words (auto: method, why)``; what holds numbers, such as steps, says itself what it is.
"""

from __future__ import annotations

from enum import StrEnum

AUTO = " (auto: "


class ModelWord(StrEnum):
    """Words on what made a number, what was used, how it is known to be the only one, why auto chose the method."""

    sentence: str
    __repr__ = str.__repr__

    def __new__(cls, word: str, sentence: str) -> ModelWord:
        """Return the word as it is in the table, with what it stands for."""
        made = str.__new__(cls, word)
        made._value_, made.sentence = word, sentence
        return made

    EVENTS = (
        "events",
        "closed-form legs of slip and stick between events, fixed point of the return map by Newton's method",
    )
    NO_REVERSAL = (
        "no reversal",
        "closed form: slip never reverses, for the belt is as fast as V_lin or faster",
    )
    ANY_START = "any start", "closed form: the range of the mean over all starts"
    X2_DECAYS = (
        "x2 decays",
        "one degree of freedom: without a load across the belt x2 decays under every isotropic sliding law",
    )
    SHOOTING_LINE = (
        "shooting 1DOF",
        "shooting: the fixed point of the map of one period, motion along the belt",
    )
    SHOOTING_PLANE = (
        "shooting 2DOF",
        "shooting: the fixed point of the map of one period, motion in the plane",
    )
    SHOOTING_APART = (
        "shooting apart",
        "shooting, two degrees of freedom solved separately: per-axis friction does not couple them",
    )
    SLIP_PATH = "slip path", "deflection as a function of the slip path"
    WITH_BRISTLE = "bristle", "mass and bristle solved together (Rodas5P)"
    WITH_MEMORY = "memory", "mass and memory solved together (Rodas5P)"
    NEAR_REST = "near rest", "slip near rest in polar coordinates (Radau IIA)"
    AT_REST = "undriven rest", "undriven: at rest, where the motion from scene.initial ends"
    SLIDES = "undriven sliding", "undriven: steady sliding, which attracts"
    SLIDES_FREELY = (
        "undriven oscillation",
        "undriven: a free oscillation in slip, which does not decay without damping",
    )
    STICKS = "undriven stick-slip", "undriven: a cycle of stick and slip"
    SLIPS = "undriven slip", "undriven: a cycle of slip without rest"
    NEVER_REPEATS = "undriven, no cycle", "undriven: a motion that does not repeat"
    SLIP_ALONG = "slip along", "closed form: slip prescribed along the belt"
    SLIP_ACROSS = "slip across", "closed form: slip prescribed across the belt"
    SLIP_ON_A_CIRCLE = "slip on a circle", "closed form: slip prescribed on a circle"
    SLIP_ONE_WAY = "slip one way", "closed form: slip that never reverses saturates the deflection"
    SYMMETRY = "symmetry", "closed form: friction of the two half periods of slip cancels"
    SLIP_AND_LOAD = (
        "slip and load",
        "closed form: slip prescribed along the belt, the normal load integrated between its reversals",
    )
    QUADRATURE = (
        "quadrature",
        "prescribed slip: Gauss-Lobatto quadrature, panels between corners graded towards slow slip",
    )
    TWO_LEGS = (
        "two legs",
        "prescribed slip along a line: deflection exact along both legs, Gauss-Lobatto quadrature",
    )
    PRESCRIBED_MEMORY = "slip and memory", "prescribed slip: the memory that repeats, by maps of a period"
    MDSM_CLOSED = (
        "mdsm",
        "direct separation of motion: closed-form mean over the friction-free motion (Eqs. 5, 6)",
    )
    MDSM_PLANE = "mdsm quadrature", "direct separation of motion: quadrature over the friction-free motion"
    MDSM_WAVES = (
        "mdsm waveforms",
        "direct separation of motion: friction averaged over the friction-free motion of these waveforms",
    )
    ONE_HARMONIC = (
        "one harmonic",
        "one harmonic of x1' and of Coulomb friction balanced (Eqs. 5, 8, 9 in explicit form)",
    )
    ONE_OF_BRISTLES = (
        "one harmonic of bristles",
        "one harmonic of x1' and of the bristles' friction balanced, friction averaged over the harmonic slip",
    )
    SAMPLED = (
        "harmonics by samples",
        "harmonics of motion and of friction balanced on samples of a period, those beyond left out",
    )
    SOFT_SPRINGS = "soft springs", "a body without a spring, as the limit of three ever softer ones"
    EQUIVALENT_DRIVE = "equivalent drive", "the belt's vibration as the drive that is equivalent to it"
    DAMPED = (
        "unique: damped",
        "unique: dashpots damp and friction never falls with speed (Leine & van de Wouw, 2008)",
    )
    NEIGHBOURS = (
        "unique: neighbours",
        "unique: friction never falls with speed, and motions near this one come nearer (Leine & van de Wouw, 2008)",
    )
    PASSIVE = (
        "unique: passive",
        "unique: the body dissipates at every harmonic and friction never falls with speed "
        "(Leine & van de Wouw, 2008)",
    )
    SLOW_FALL = (
        "unique: slow fall",
        "unique: damping exceeds the steepest fall of friction with speed (Leine & van de Wouw, 2008)",
    )
    BY_SLIP = "unique: slip", "unique: friction hangs on the prescribed slip alone"
    CHEAPEST = "cheapest", "it accepts the scene, and no method is cheaper"
    CLOSER = "closer", "on soft springs the cheapest method has errors above the tolerance"
    MEMORY = "memory of friction", "exact needs friction without memory (Coulomb)"
    SPEED = "friction by speed", "exact needs friction that does not vary with speed (Coulomb)"
    STATIC = "static friction", "exact needs static friction equal to sliding friction (no mu_static)"
    UNDRIVEN = "no drive", "exact needs a drive, whose period is that of the motion"
    LOAD_ACROSS = "load across", "exact works along one line: this scene has a transverse load"
    BELT_ACROSS = "belt across", "exact works along one line: this scene has a belt that vibrates across"
    STIFF_CONTACT = (
        "stiff contact",
        "exact cannot keep the stiffness of bristles while the normal load changes",
    )
    NO_PATH = (
        "no path",
        "exact needs a deflection known along a path (Dahl, Jenkins, LuGre of constant friction)",
    )
    TWO_WAYS = "slip in a plane", "exact works along one line: this slip has a component across the belt"


_SENTENCES = {str(each): each.sentence for each in ModelWord}


def _sentence(word: str) -> str:
    """With the number, of harmonics, that it begins with."""
    number, _, rest = word.partition(" ")
    return f"{number} {_SENTENCES.get(rest, rest)}" if number.isdigit() else _SENTENCES.get(word, word)


def why_unique_in_words(model: str) -> str:
    """Return the theorem that a model names; empty where it names none."""
    words = model.partition(AUTO)[0].split("; ")
    return next((_sentence(each).partition(": ")[2] for each in words if each.startswith("unique: ")), "")


def model_in_sentences(model: str) -> str:
    """Return what a cell of the column says, each word by its sentence; words of other methods stay as they are."""
    words, _, chosen = model.partition(AUTO)
    method, _, why = chosen.removesuffix(")").partition(", ")
    told = [_sentence(each) for each in words.split("; ")]
    return "; ".join([*told, f"auto chose {method}: {_sentence(why)}"] if chosen else told)
