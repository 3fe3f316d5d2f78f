# SPDX-License-Identifier: BSL-1.0
"""The distribution and the autocovariance of the total stiff energy over [0, 40], Figures 2 and 6, and run times, section 5.3."""
import math
import time

import nysalt
import numpy as np

from accuracy import RIVAL, STARTS, crossing, curves_of, is_gap
from chain import BATH, GAP, Setting, bath, follow, learned_in_bath, pick, reference_step, steps_text
from claims import Claim, Estimate, Exhibit
from pages import Curve, Panel

START = {"trajectory": "one long trajectory", "gibbs": "Gibbs starts"}
FINE = 1e-3  # of the reference of distributions: omega h = .05
REFERENCES = 4  # ensembles: six pairs for the floor
GROUPS = 32  # of trajectories, for the jackknife


def ensemble(method, step, every, start, number, count):
    """I by trajectory and sample over [0, 40], every `every` steps, of those trajectories that did not diverge. Ensemble 0
    feels the noise of the seed; each other has starts and noise of its own, as that of a reference must be."""
    horizon = step * int(pick(40.0, 4.0) / step + 1e-9)
    values = follow(bath(start, number), method, step, horizon, every * step, count, ["stiff_energy"],
                    repetition=number)[:, :, 0]
    return values[~np.isnan(values).any(1)]


def methods_at(start, gap):
    return {"BAOAB": "baoab", "BAOAB with half steps": "baoab_2x", "NySALT": learned_in_bath(start, gap)}


def command(metric, gaps, count):
    return (f"nysalt compare --system fpu {BATH} --start trajectory --metric {metric} --horizon 40 --trajectories {count} --steps "
            f"{steps_text(gaps)} --methods baoab,baoab_2x,learned:nystrom@end --learn-trajectories 512 --learn-horizon 1")


class Distances:
    """Of one way to start: distances from the reference by method and gap, and the sampling floor."""

    def __init__(self, start, gaps, floor=0.0):
        self.start, self.name, self.gaps, self.floor = start, START[start], gaps, floor
        self.errors = {name: [] for name in ("BAOAB", "BAOAB with half steps", "NySALT")}
        self.shown = []

    def at(self, name, gap):
        return self.errors[name][self.gaps.index(gap)]

    def table(self, sentence):
        columns = ["gap", *self.errors, "floor"]
        return (f"{sentence}, {self.name}:", columns,
                [[f"{gap:g}", *(f"{e.mean:.4f}" if math.isfinite(e.mean) else "diverges" for e in row), f"{self.floor:.4f}"]
                 for gap, *row in zip(self.gaps, *self.errors.values())], 0)

    def panel(self, label):
        floor = Curve("sampling floor", self.gaps, [self.floor] * len(self.gaps), dashed=True)
        return Panel(self.name, "gap", label, [*curves_of(self.gaps, self.errors, bars=False), floor], "xy")


def fractions(values):
    """Of the samples, in 100 bins of 0 .. 1 and beyond either end."""
    counts = np.bincount(np.clip(np.floor(values.ravel() * 100), -1, 100).astype(int) + 1, minlength=102)
    return counts / counts.sum()


def total_variation(a, b):
    return 0.5 * float(np.abs(a - b).sum())


def distributions(start, gaps):
    count = pick(10_000, 32)
    references = [fractions(ensemble("baoab", FINE, 20, start, 1 + k, count)) for k in range(REFERENCES)]
    pairs = [total_variation(a, b) for i, a in enumerate(references) for b in references[:i]]
    found = Distances(start, gaps, float(np.mean(pairs)))
    centres = (np.arange(100) + 0.5) / 100
    found.shown.append(Curve("reference", centres, 100 * references[0][1:-1], bold=True))
    for gap in gaps:
        for name, method in methods_at(start, gap).items():
            values = ensemble(method, gap * GAP, max(1, int(100 / gap)), start, 0, count)
            if 2 * len(values) <= count:
                found.errors[name].append(Estimate(math.inf))
                continue
            sampled = fractions(values)
            found.errors[name].append(Estimate(float(np.mean([total_variation(sampled, one) for one in references]))))
            if gap == 330:
                found.shown.append(Curve(name, centres, 100 * sampled[1:-1]))
    return found


def law_of_energy():
    gaps = pick([30, 50, 70, 100, 150, 190, 250, 330, 390, 450], [330, 450])
    found = [distributions(start, gaps) for start in START]

    def claim(name, gap, text, holds, rule):
        values = [(one, one.at(name, gap).mean) for one in found]
        return Claim(text, f"total variation at gap {gap}",
                     "; ".join(f"{value:.4f}, floor {one.floor:.4f} ({one.name})" for one, value in values),
                     {one.name: holds(value, one.floor) for one, value in values}, rule, STARTS)

    def is_hundredth(value, floor):
        return round(math.log10(value)) == -2 or value <= 1.5 * floor

    at_hundredth = "its decimal logarithm, rounded, must be -2, or it is at the floor"
    least = {rival: min(one.at(rival, gap).mean / one.at("NySALT", gap).mean for one in found for gap in gaps if gap > 200)
             for rival in ("BAOAB", "BAOAB with half steps")}
    claims = [claim("BAOAB", 330, "BAOAB at gap 330: TVD 1e-1", lambda value, _: round(math.log10(value)) == -1,
                    "its decimal logarithm, rounded, must be -1"),
              claim("NySALT", 330, "NySALT at gap 330: a magnitude less, about 1e-2", is_hundredth, at_hundredth),
              claim("NySALT", 450, "NySALT: TVD around 1e-2 even at gap 450", is_hundredth, at_hundredth),
              Claim("NySALT has consistently smaller TVD than BAOAB after gap 200",
                    "least ratio of the rival's TVD to that of NySALT after gap 200, for both ways to start",
                    ", ".join(f"{ratio:.2f} for {rival}" for rival, ratio in least.items()),
                    {rival: ratio > 1 for rival, ratio in least.items()}, "above 1 at every gap. At the floor such a ratio is chance",
                    RIVAL + "BAOAB with half the step")]
    for one in claims:
        one.command = command("distribution --range 0,1", gaps, 10_000)
    return Exhibit(
        "Distribution of the total stiff energy", "Figure 6 (middle), section 5.3", claims,
        ["The floor is the mean distance between pairs of four ensembles of the reference: no error below it can be seen. T = 40 is 0.4 "
         "of a relaxation time: this is the departure from the initial distribution, not the error of the stationary distribution."],
        [one.table("Total variation") for one in found],
        [("law_distance", [one.panel("total variation") for one in found], (1200, 520),
          "Total variation of the distribution of I over [0, 40] from that of fine steps."),
         ("law_density", [Panel(f"{one.name}, gap 330", "I", "density", one.shown) for one in found], (1200, 480),
          "Density of I at gap 330.")])


def autocorrelations(values, lags):
    """rho(k) = C(k)/C(0) of all trajectories, and without each of the groups."""
    centred = values - values.mean()
    groups = np.array_split(centred, min(GROUPS, len(centred)))
    # By group and lag: the number of pairs, and the sums of the earlier value, the later value and their product.
    n = values.shape[1]
    sums = np.array([[(g[:, k:].size, g[:, :n - k].sum(), g[:, k:].sum(), np.sum(g[:, :n - k] * g[:, k:])) for k in range(lags + 1)]
                     for g in groups])

    def rho(total):
        pairs, early, late, products = total.T
        covariances = products / pairs - early * late / pairs**2
        return covariances / covariances[0]

    return rho(sums.sum(0)), np.array([rho(sums.sum(0) - one) for one in sums])


def jackknife(without):
    """The variance of what was found without each of the groups."""
    return np.var(without, axis=0) * (len(without) - 1)


def acf_distance(a, b):
    """The RMS difference of rho over lags from the first on, with its standard error, and what sampling alone would make of it."""
    (of_a, without_a), (of_b, without_b) = a, b

    def distance(x, y):
        return np.sqrt(np.mean((x - y)[..., 1:] ** 2, axis=-1))

    error = math.sqrt(jackknife(distance(without_a, of_b)) + jackknife(distance(without_b, of_a)))
    floor = math.sqrt(np.mean((jackknife(without_a) + jackknife(without_b))[1:]))
    return Estimate(float(distance(of_a, of_b)), error), floor


def autocovariances(start, gaps):
    count = pick(2000, 32)
    found = Distances(start, gaps)
    for gap in gaps:
        step = gap * GAP
        longest = int(1 / step + 1e-9)
        every = max(1, longest // 50)
        lags, finer = longest // every, round(step / reference_step(step))
        reference = autocorrelations(ensemble("baoab", step / finer, every * finer, start, 1, count), lags)
        x = step * every * np.arange(lags + 1)
        if gap == 190:
            found.shown.append(Curve("reference", x, reference[0], bold=True))
        for name, method in methods_at(start, gap).items():
            values = ensemble(method, step, every, start, 0, count)
            if 2 * len(values) <= count:
                found.errors[name].append(Estimate(math.inf))
                continue
            sampled = autocorrelations(values, lags)
            off, floor = acf_distance(sampled, reference)
            found.errors[name].append(off)
            if name == "NySALT":
                found.floor += floor / len(gaps)
            if gap == 190:
                found.shown.append(Curve(name, x, sampled[0], bold=name == "NySALT"))
    return found


def autocovariance_of_energy():
    gaps = pick([30, 50, 70, 100, 130, 160, 190, 200, 250, 330, 390, 400, 450], [190, 200])
    found = [autocovariances(start, gaps) for start in START]

    def at_one_gap(gap, text):
        pairs = [(one, one.at("NySALT", gap).mean, one.at("BAOAB", gap).mean) for one in found]
        return Claim(text, "RMS error of the normalised ACF over lags up to 1",
                     "; ".join(f"NySALT {a:.1e}, BAOAB {b:.1e}, floor {one.floor:.1e} ({one.name})" for one, a, b in pairs),
                     {one.name: a <= 3 * one.floor and b > 10 * one.floor for one, a, b in pairs},
                     "NySALT within three times the sampling floor, BAOAB above ten times", STARTS)

    def threshold(name, gap, distance, text, level):
        at = {one.name: crossing(gaps, one.errors[name], level * one.floor) for one in found}
        return Claim(text, f"gap at which the RMS error of the normalised ACF rises above {level:g} times the floor",
                     ", ".join(f"{at[one.name]} ({one.name}, floor {one.floor:.1e})" for one in found),
                     {start: is_gap(one, gap, distance) for start, one in at.items()},
                     f"within {distance} gaps and two standard errors", STARTS)

    claims = [at_one_gap(200, "at delta = 0.02 BAOAB produces an inaccurate ACF, NySALT remains very reliable"),
              at_one_gap(190, "at gap 190 NySALT is almost exactly as the reference, BAOAB oscillates much more"),
              threshold("BAOAB", 100, 30, "the error of BAOAB grows from gap 100 on", 2),
              threshold("NySALT", 400, 50, "NySALT remains accurate until about gap 400", 10)]
    for one in claims:
        one.command = command("acf", gaps, 2000)
    return Exhibit(
        "Autocovariance of the total stiff energy", "Figures 2 (section 2) and 6 (right), section 5.3", claims,
        ["The paper's ACF is not normalised; here rho(k) = C(k)/C(0), so that starts which inflate the variance do not hide the shape."],
        [one.table("RMS error of the ACF") for one in found],
        [("acf_error", [one.panel("RMS error of rho") for one in found], (1200, 520),
          "RMS error of the normalised autocovariance of I."),
         ("acf_shape", [Panel(f"{one.name}, gap 190", "lag", "rho", one.shown) for one in found], (1200, 480),
          "Normalised autocovariance of I at gap 190.")])


def run_times():
    step = 0.019
    began = time.perf_counter()
    scheme = nysalt.learn(bath("gibbs"), "nystrom", step=step, loss="state:1", random_starts=0, horizon=1.0,
                          trajectories=pick(512, 16), placement="end", fine_step=GAP, seed=Setting.seed, threads=Setting.threads)
    learning = time.perf_counter() - began

    def seconds(method, step_size):
        """Of 10^4 trajectories to T = 40 on one core, without their starts."""
        found = nysalt.compare(bath("gibbs"), [method], step_size, metric="relative", observable="stiff_energy", horizon=1.0,
                               trajectories=16, fine_step=GAP, force=True, seed=Setting.seed, threads=1)
        return found["rows"][0]["seconds_per_time"] * 40 * 10_000

    fine, coarse, half = (seconds(*one) for one in (("baoab", GAP), (scheme, step), ("baoab", 0.5 * step)))
    return Exhibit(
        "Run times", "section 5.3",
        [Claim("NySALT at gap 190 is almost 115 times faster than BAOAB with fine steps (2078 s and 18 s)",
               "ratio of seconds for 10^4 trajectories to T = 40, one core",
               f"{fine / coarse:.3g} to fine steps, {half / coarse:.2f} to BAOAB with half the step",
               {"steps of h = 1e-4": fine / coarse >= 85, "BAOAB at equal force evaluations": half / coarse >= 85},
               "at least three quarters of 115. 190 fine steps are replaced by one of two evaluations: a factor of 95 by counting",
               "what it is compared with",
               f"nysalt compare --system fpu {BATH} --steps 0.019 --methods baoab,learned:nystrom@end"),
         Claim("learning takes 854 s", "seconds of learning from M = 512, data included", f"{learning:.2g}", 427 < learning < 1708,
               f"within a factor of two; faster by a factor of {854 / learning:.0f}",
               command=f"nysalt learn --system fpu {BATH} --placement end --trajectories 512 --horizon 1 --step 0.019")],
        ["Seconds are those of `nysalt compare` for a unit of time of one trajectory, scaled; learning is timed as it stands."],
        [("Seconds:", ["job", "paper, s", "ours, s"],
          [["BAOAB, h = 1e-4, 10^4 trajectories to T = 40", "2078", f"{fine:.3g}"],
           ["NySALT, gap 190, the same", "18", f"{coarse:.3g}"],
           ["BAOAB, gap 95, the same force evaluations", "", f"{half:.3g}"],
           ["learning at gap 190", "854", f"{learning:.3g}"]], 1)])
