# SPDX-License-Identifier: BSL-1.0
"""Errors of the total stiff energy against the step, Figures 3 (left) and 6 (left), and on other starts, section 5.1."""
import math

import numpy as np

from chain import BATH, GAP, OMEGA, bath, chain, errors, learned, learned_in_bath, pick, soft_starts, steps_text
from claims import Claim, Estimate, Exhibit, agrees, exponent, mean_of
from pages import Curve, Panel

LAW, RIVAL, STARTS = ("the initial distribution", "the rival: at equal force evaluations it is ", "the starts")


class Sweep:
    """Errors by method and gap, and of the reference its own error, or the sampling floor. methods: for each gap, by name."""

    def __init__(self, system, gaps, methods, of_reference="error", **how):
        found = [errors(system, methods(gap), gap * GAP, **how) for gap in gaps]
        self.gaps, self.of_reference, self.has_floor = gaps, [one[of_reference] for _, one in found], of_reference == "floor"
        self.errors = {name: [one[name] for one, _ in found] for name in found[0][0]}

    def exponent(self, name, low, high):
        points = [(g, e.mean) for g, e in zip(self.gaps, self.errors[name]) if low <= g <= high and math.isfinite(e.mean)]
        return exponent(*zip(*points)) if points else Estimate(0.0)

    def at(self, name, gap):
        return self.errors[name][self.gaps.index(gap)]

    def floor(self):
        return float(np.mean(self.of_reference))

    def means(self, name):
        return np.array([e.mean for e in self.errors[name]])

    def table(self):
        return (["gap", *self.errors, "floor" if self.has_floor else "reference's own"],
                [[gap, *(f"{e.mean:.2e} +- {e.error:.0e}" if math.isfinite(e.mean) else "diverges" for e in row), f"{own:.0e}"]
                 for gap, own, *row in zip(self.gaps, self.of_reference, *self.errors.values())], 0)

    def panel(self, title, label="average relative RMSE of I"):
        curves = [Curve(name, self.gaps, [e.mean for e in es], [e.error for e in es], bold=name == "NySALT")
                  for name, es in self.errors.items()]
        floor = [Curve("sampling floor", self.gaps, self.of_reference, dashed=True)] if self.has_floor else []
        return Panel(title, "gap", label, curves + floor, "xy")


def crossing(gaps, found, threshold):
    """Where errors first rise above a threshold, by a line through logarithms; its standard error is that of the two points
    over the slope. The last gap where they never do, the first where they always are."""
    above = [not e.mean <= threshold for e in found]
    if True not in above:
        return Estimate(gaps[-1])
    i = above.index(True)
    if i == 0:
        return Estimate(gaps[0])
    low, high = found[i - 1], found[i]
    if not math.isfinite(high.mean):
        return Estimate(gaps[i - 1], 0.5 * (gaps[i] - gaps[i - 1]))
    rise, width = math.log(high.mean / low.mean), math.log(gaps[i] / gaps[i - 1])
    part = math.log(threshold / low.mean) / rise
    relative = math.hypot((1 - part) * low.error / low.mean, part * high.error / high.mean)
    place = gaps[i - 1] * math.exp(part * width)
    return Estimate(place, place * relative * width / rise)


def is_gap(ours, printed, distance):
    """Whether a threshold that the paper gives as a gap of its grid is ours: within one distance of that grid and two standard
    errors."""
    return abs(ours.mean - printed) <= distance + 2 * ours.error


class Readings:
    """Sweeps by the name of the reading; `short` are the names in our numbers."""

    def __init__(self, choice, sweeps, short):
        self.choice, self.sweeps, self.short = choice, sweeps, short

    def claim(self, text, quantity, number, holds, rule=""):
        """number(sweep), and whether that holds, for each."""
        found = {name: number(sweep) for name, sweep in self.sweeps.items()}
        ours = "; ".join(f"{short}: {one if isinstance(one, Estimate) else format(one, '.3g')}"
                         for short, one in zip(self.short, found.values()))
        return Claim(text, quantity, ours, {name: holds(one) for name, one in found.items()}, rule, self.choice)

    def threshold(self, name, level, printed, distance, text, rule):
        return self.claim(text, f"gap at which the average relative RMSE of I reaches {100 * level:g} %",
                          lambda sweep: crossing(sweep.gaps, sweep.errors[name], level),
                          lambda at: is_gap(at, printed, distance), f"{rule} ({distance:g}) and two standard errors")

    def slope(self, name, low, high, printed, text, rule):
        return self.claim(text, f"exponent over gaps {low} .. {high}", lambda sweep: sweep.exponent(name, low, high),
                          lambda slope: agrees(slope, printed, 0.2), rule)

    def exhibit(self, title, place, claims, remarks, sentences, figure, titles, caption, command):
        for one in claims:
            one.command = one.command or command
        sweeps = self.sweeps.values()
        return Exhibit(title, place, claims, remarks, [(s, *sweep.table()) for s, sweep in zip(sentences, sweeps)],
                       [(figure, [sweep.panel(t) for t, sweep in zip(titles, sweeps)], (1200, 520), caption)])


def with_both_laws(horizon):
    """"(1/omega) N(0, 1)" as a standard deviation 1/omega, and as a variance."""
    gaps = pick([10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 150, 200, 250, 300, 350, 390], [20, 50, 200, 300])

    def on_starts_of(spread):
        system = chain(OMEGA, spread)
        return Sweep(system, gaps, lambda gap: {  # at one step Verlet costs half of what the others do
            "Verlet": "verlet", "two half steps of Verlet": "verlet_2x", "McLachlan": "mclachlan2",
            "NySALT": learned(system, gap * GAP)}, horizon=horizon, trajectories=pick(400, 16))

    names = ["deviation 1/omega", "variance 1/omega"]
    readings = Readings(LAW, dict(zip(names, map(on_starts_of, (1.0, math.sqrt(OMEGA))))), names)

    def exhibit(title, place, claims, remarks, figure):
        return readings.exhibit(
            title, place, claims, remarks, [f"{name[0].upper()}{name[1:]} of the starts:" for name in names], figure, names,
            f"Error of the total stiff energy over [0, {horizon:g}] against the gap, M = 400. At the same gap, all but Verlet "
            "take two force evaluations.",
            f"nysalt compare --system fpu --methods verlet,verlet_2x,mclachlan2,learned:nystrom --steps {steps_text(gaps)} "
            f"--horizon {horizon:g} --trajectories 400 --for energy")

    return readings, exhibit


ON_THE_GRID = "within one distance of the paper's grid"
TO_A_TENTH = "2 to a tenth and two standard errors"


def quadruple(sweep):
    """The claim of the conclusion, by whom it is compared with."""
    at = {name: crossing(sweep.gaps, sweep.errors[name], 0.01).mean for name in sweep.errors}
    ratios = {name: at["NySALT"] / at[name] for name in ("Verlet", "two half steps of Verlet", "McLachlan")}
    return Claim("at T = 0.5 NySALT allows at least four times the step at 1 %",
                 "its gap at 1 % over that of others (deviation 1/omega)",
                 ", ".join(f"{ratio:.2f} times that of {name}" for name, ratio in ratios.items()),
                 {name: ratio >= 3.5 for name, ratio in ratios.items()}, "four, rounded",
                 RIVAL + "two half steps of Verlet, or McLachlan")


def accuracy_on_short_times():
    readings, exhibit = with_both_laws(0.5)

    def least_ratio(sweep):
        return min((sweep.means("Verlet") / sweep.means("NySALT"))[np.array(sweep.gaps) <= 300])

    slopes = [readings.slope(name, 10, 100, 2.0, f"T = 0.5: the error of {name} grows with slope 2", TO_A_TENTH)
              for name in ("Verlet", "NySALT")]
    thresholds = [readings.threshold(name, 0.01, gap, distance, f"T = 0.5, {name}: 1 % up to gap {gap}", ON_THE_GRID)
                  for name, gap, distance in (("Verlet", 70, 10), ("NySALT", 300, 50))]
    magnitudes = readings.claim("T = 0.5: NySALT errs two magnitudes less than Verlet until gap 300",
                                "least ratio of the errors for gaps up to 300", least_ratio,
                                lambda ratio: math.log10(ratio) >= 1.5, "its decimal logarithm, rounded, must be 2 or more")
    return exhibit("Accuracy at T = 0.5", "Figure 3 (top left), section 5.2",
                   [*slopes, magnitudes, *thresholds, quadruple(readings.sweeps["deviation 1/omega"])], [], "accuracy_T_05")


def accuracy_on_long_times():
    readings, exhibit = with_both_laws(pick(100.0, 2.0))

    def last_below(sweep):
        """The last gap up to which NySALT errs less, at it and all before."""
        below = [*(sweep.means("NySALT") < sweep.means("Verlet")), False]
        return [0, *sweep.gaps][below.index(False)]

    thresholds = [readings.threshold(name, 0.01, gap, distance, f"T = 100, {name}: 1 % up to gap {gap}", ON_THE_GRID)
                  for name, gap, distance in (("Verlet", 50, 10), ("NySALT", 200, 50))]
    return exhibit(
        "Accuracy at T = 100", "Figure 3 (bottom left), section 5.2",
        [readings.slope("NySALT", 10, 50, 2.0,
                        "T = 100: the error of NySALT depends linearly (slope 2) on the step up to gap 50", TO_A_TENTH),
         *thresholds, readings.claim("T = 100: up to gap 390 NySALT errs less than Verlet", "last gap up to which it does",
                                     last_below, lambda gap: gap >= 390)],
        ["I is an adiabatic invariant: at T = 100 its relative error saturates near the deviation of I from its start, and 1 % is "
         "not far from that. Where curves flatten they show phases, and chaos."], "accuracy_T_100")


def errors_along_paths():
    gaps, count = pick([10, 30, 50, 70, 100, 130, 160, 190, 200, 250, 300, 330, 350, 390, 450], [100, 200]), pick(10_000, 32)

    def from_starts(start):
        return Sweep(bath(start), gaps, lambda gap: {
            "BAOAB": "baoab", "BAOAB with half steps": "baoab_2x", "McLachlan, O symmetric": "mclachlan2@symmetric",
            "NySALT": learned_in_bath(start, gap), "learned, O symmetric": learned_in_bath(start, gap, placement="symmetric")},
            horizon=1.0, trajectories=count, fine_step=GAP)

    pooled = from_starts("trajectory")
    readings = Readings(STARTS, {"starts from one long trajectory": pooled, "Gibbs starts": from_starts("gibbs")},
                        ["one long trajectory", "Gibbs"])

    def first_below(rival):
        """The gap from which on NySALT errs less."""
        below = pooled.means("NySALT") < pooled.means(rival)
        last = max((i for i, one in enumerate(below) if not one), default=-1)
        return [*gaps, math.inf][last + 1]

    since = {rival: first_below(rival) for rival in ("BAOAB", "BAOAB with half steps")}
    smaller = Claim("NySALT errs less than BAOAB after gap 70", "gap from which on it does (starts from one long trajectory)",
                    ", ".join(f"from {gap:g} on below {rival}" if math.isfinite(gap) else f"never below {rival}"
                              for rival, gap in since.items()),
                    {rival: gap <= 70 for rival, gap in since.items()}, "", RIVAL + "BAOAB with half the step")
    price = mean_of((pooled.means("NySALT") / pooled.means("learned, O symmetric"))[np.array(gaps) <= 200])
    rule = "to a tenth and two standard errors"
    return readings.exhibit(
        "Errors along paths", "Figure 6 (left), section 5.3",
        [readings.slope("BAOAB", 30, 200, 2.0, "BAOAB: slope 2 until gap 200", rule),
         readings.slope("NySALT", 30, 450, 1.0, "NySALT: slope 1 until gap 450", rule), smaller,
         *(readings.threshold(name, 0.1, gap, 30, f"{name}: 10 % up to gap {gap}", "within one distance of gaps")
           for name, gap in (("BAOAB", 70), ("NySALT", 190)))],
        [f"M = {count} trajectories; all methods and the reference (BAOAB, h = 1e-4) feel the same noise.",
         "NySALT has O at the end of the step, as the paper. With half of it before the step and half behind, at the same cost, "
         f"errors up to gap 200 are smaller by a factor of {price}."],
        ["Starts from one long trajectory, as in the paper:", "Gibbs starts:"], "errors_along_paths",
        ["one long trajectory", "Gibbs starts"],
        "Error of the total stiff energy over [0, 1]. BAOAB takes one force evaluation a step, all others two.",
        f"nysalt compare --system fpu {BATH} --start trajectory --methods "
        "baoab,baoab_2x,learned:nystrom@end,learned:nystrom@symmetric --learn-trajectories 512 --learn-horizon 1 --fine-step 0.0001 "
        f"--horizon 1 --trajectories 10000 --steps {steps_text(gaps)}")


def other_starts():
    """Errors over [0, 0.5] on starts of one kind, of the schemes learned from either and of McLachlan's."""
    count, kinds = pick(400, 16), ("stiff-dominated", "soft-dominated")
    learned_on = dict(zip(kinds, (chain(), soft_starts(pick(100, 10), "training"))))
    tested_on = dict(zip(kinds, (chain(), soft_starts(count, "test"))))
    rows, worst = [], {}
    for kind, other in (kinds, kinds[::-1]):
        for step in pick((0.01, 0.02, 0.03), (0.02,)):
            found, reference = errors(tested_on[kind], {"here": learned(learned_on[kind], step), "there": learned(learned_on[other], step),
                                                  "mclachlan2": "mclachlan2"}, step, 0.5, count, metric="state")
            ratio = found["there"].mean / found["here"].mean
            worst[kind] = max(worst.get(kind, 0.0), ratio if math.isfinite(ratio) else math.inf)
            rows.append([kind, f"{step:g}", found["here"], found["there"], f"{ratio:.2f}", found["mclachlan2"],
                         f"{reference['error']:.0e}"])
    return Exhibit(
        "Starts of another kind than those learned from", "text of section 5.1",
        [Claim("trained on one type of starts only, NySALT can predict the dynamics of the other type",
               "largest ratio of the error of the scheme learned on the others to that learned there, state on [0, 0.5]",
               ", ".join(f"{ratio:.2f} on {kind} starts" for kind, ratio in worst.items()),
               {f"tests on {kind} starts": ratio <= 2 for kind, ratio in worst.items()},
               "at most twice the error of the scheme that was learned there", "which starts are tested on")],
        ["Stiff-dominated starts are the paper's (5.5). Soft-dominated ones have the same stiff springs, and the energy omega^2 in "
         "the soft ones: x_0 = omega^(1/2), y_0 = omega/3^(1/2)."],
        [("Error of the state (energy norm):", ["tested on", "delta", "learned there", "learned on the others", "ratio",
                                                "McLachlan", "reference's own"], rows, 1)])
