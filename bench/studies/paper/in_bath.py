# SPDX-License-Identifier: BSL-1.0
"""The distribution and the autocovariance of the total stiff energy over [0, 40], Figures 2 and 6, and run times, section 5.3."""
import math
import time

import nysalt
import numpy as np

from accuracy import RIVAL, STARTS, Sweep, crossing, is_gap
from chain import BATH, GAP, Setting, bath, divided, follow, learned_in_bath, pick, steps_text
from claims import Claim, Exhibit
from pages import Curve, Panel

START = {"trajectory": "one long trajectory", "gibbs": "Gibbs starts"}
FINE = 2.5e-3  # of the reference: its own error is far below the floor


def sweeps(metric, gaps, trajectories, **how):
    """Distances of statistics of I over [0, 40] by the name of the starts, and the command of nysalt."""
    def methods(start):
        return lambda gap: {"BAOAB": "baoab", "BAOAB with half steps": "baoab_2x", "NySALT": learned_in_bath(start, gap)}

    command = (f"nysalt compare --system fpu {BATH} --start trajectory --metric {metric}{' --range 0,1' if 'range' in how else ''} "
               f"--horizon 40 --trajectories {trajectories} --steps {steps_text(gaps)} "
               "--methods baoab,baoab_2x,learned:nystrom@end --learn-trajectories 512 --learn-horizon 1")
    return {name: Sweep(bath(start), gaps, methods(start), "floor", horizon=pick(40.0, 4.0), trajectories=pick(trajectories, 64),
                        metric=metric, fine_step=FINE, **how) for start, name in START.items()}, command


def samples(start, gap):
    """I along trajectories by method, at each step of this gap, to show."""
    step = gap * GAP
    methods = {"reference": "baoab", "BAOAB": "baoab", "BAOAB with half steps": "baoab_2x", "NySALT": learned_in_bath(start, gap)}
    for name, method in methods.items():
        fine = divided(step, FINE if name == "reference" else step)
        yield name, follow(bath(start), method, fine, step * int(pick(40.0, 4.0) / step), step, pick(1000, 64),
                           ["stiff_energy"])[:, :, 0]


def exhibit(title, place, claims, remark, found, sentence, label, command, figures, shown):
    """figures: (name, caption) of the distances and of the curves that are shown, panels by the start."""
    for one in claims:
        one.command = command
    (name, caption), (name_of_shown, caption_of_shown) = figures
    return Exhibit(title, place, claims, [remark], [(f"{sentence}, {start}:", *one.table()) for start, one in found.items()],
                   [(name, [one.panel(start, label) for start, one in found.items()], (1200, 520), caption),
                    (name_of_shown, shown, (1200, 480), caption_of_shown)])


def law_of_energy():
    gaps = pick([30, 50, 70, 100, 150, 190, 250, 330, 390, 450], [330, 450])
    found, command = sweeps("distribution", gaps, 10_000, range=(0.0, 1.0))

    def claim(name, gap, text, holds, rule):
        values = {start: (one.at(name, gap).mean, one.floor()) for start, one in found.items()}
        return Claim(text, f"total variation at gap {gap}",
                     "; ".join(f"{value:.4f}, floor {floor:.4f} ({start})" for start, (value, floor) in values.items()),
                     {start: holds(*one) for start, one in values.items()}, rule, STARTS)

    def is_hundredth(value, floor):
        return round(math.log10(value)) == -2 or value <= 1.5 * floor

    at_hundredth = "its decimal logarithm, rounded, must be -2, or it is at the floor"
    least = {rival: min(one.at(rival, gap).mean / one.at("NySALT", gap).mean for one in found.values() for gap in gaps if gap > 200)
             for rival in ("BAOAB", "BAOAB with half steps")}
    edges = np.linspace(0, 1, 101)
    shown = [Panel(f"{name}, gap 330", "I", "density",
                   [Curve(method, edges[:-1] + 0.005, np.histogram(values, edges)[0] * 100 / np.isfinite(values).sum(),
                          bold=method == "reference") for method, values in samples(start, 330)]) for start, name in START.items()]
    return exhibit(
        "Distribution of the total stiff energy", "Figure 6 (middle), section 5.3",
        [claim("BAOAB", 330, "BAOAB at gap 330: TVD 1e-1", lambda value, _: round(math.log10(value)) == -1,
               "its decimal logarithm, rounded, must be -1"),
         claim("NySALT", 330, "NySALT at gap 330: a magnitude less, about 1e-2", is_hundredth, at_hundredth),
         claim("NySALT", 450, "NySALT: TVD around 1e-2 even at gap 450", is_hundredth, at_hundredth),
         Claim("NySALT has consistently smaller TVD than BAOAB after gap 200",
               "least ratio of the rival's TVD to that of NySALT after gap 200, for both ways to start",
               ", ".join(f"{ratio:.2f} for {rival}" for rival, ratio in least.items()),
               {rival: ratio > 1 for rival, ratio in least.items()}, "above 1 at every gap. At the floor such a ratio is chance",
               RIVAL + "BAOAB with half the step")],
        "The floor is the mean distance between pairs of four ensembles of the reference: no error below it can be seen. T = 40 is 0.4 "
        "of a relaxation time: this is the departure from the initial distribution, not the error of the stationary distribution.",
        found, "Total variation", "total variation", command,
        [("law_distance", "Total variation of the distribution of I over [0, 40] from that of fine steps."),
         ("law_density", "Density of I at gap 330.")], shown)


def autocorrelation(values, lags):
    """rho(k) = C(k)/C(0) of the trajectories that did not diverge."""
    x = values[np.isfinite(values).all(1)]
    x, n = x - x.mean(), values.shape[1]
    covariances = np.array([np.mean(x[:, :n - k] * x[:, k:]) for k in range(lags + 1)])
    return covariances / covariances[0]


def autocovariance_of_energy():
    gaps = pick([30, 50, 70, 100, 130, 160, 190, 200, 250, 330, 390, 400, 450], [190, 200])
    found, command = sweeps("acf", gaps, 2000, longest_lag=1.0)

    def at_one_gap(gap, text):
        values = {start: (one.at("NySALT", gap).mean, one.at("BAOAB", gap).mean, one.floor()) for start, one in found.items()}
        return Claim(text, "RMS error of the normalised ACF over lags up to 1",
                     "; ".join(f"NySALT {a:.1e}, BAOAB {b:.1e}, floor {c:.1e} ({start})" for start, (a, b, c) in values.items()),
                     {start: a <= 3 * c and b > 10 * c for start, (a, b, c) in values.items()},
                     "NySALT within three times the sampling floor, BAOAB above ten times", STARTS)

    def threshold(name, gap, distance, text, level):
        at = {start: crossing(gaps, one.errors[name], level * one.floor()) for start, one in found.items()}
        return Claim(text, f"gap at which the RMS error of the normalised ACF rises above {level:g} times the floor",
                     ", ".join(f"{at[start]} ({start}, floor {one.floor():.1e})" for start, one in found.items()),
                     {start: is_gap(one, gap, distance) for start, one in at.items()},
                     f"within {distance} gaps and two standard errors", STARTS)

    step, lags = 190 * GAP, 52  # up to 1
    shown = [Panel(f"{name}, gap 190", "lag", "rho",
                   [Curve(method, step * np.arange(lags + 1), autocorrelation(values, lags), bold=method in ("reference", "NySALT"))
                    for method, values in samples(start, 190)]) for start, name in START.items()]
    return exhibit(
        "Autocovariance of the total stiff energy", "Figures 2 (section 2) and 6 (right), section 5.3",
        [at_one_gap(200, "at delta = 0.02 BAOAB produces an inaccurate ACF, NySALT remains very reliable"),
         at_one_gap(190, "at gap 190 NySALT is almost exactly as the reference, BAOAB oscillates much more"),
         threshold("BAOAB", 100, 30, "the error of BAOAB grows from gap 100 on", 2),
         threshold("NySALT", 400, 50, "NySALT remains accurate until about gap 400", 10)],
        "The paper's ACF is not normalised; here rho(k) = C(k)/C(0), so that starts which inflate the variance do not hide the shape.",
        found, "RMS error of the ACF", "RMS error of rho", command,
        [("acf_error", "RMS error of the normalised autocovariance of I."),
         ("acf_shape", "Normalised autocovariance of I at gap 190.")], shown)


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
