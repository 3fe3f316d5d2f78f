# SPDX-License-Identifier: BSL-1.0
"""Mutants of the product: mistakes that the tests must find.

All of them are compiled into one build. MUTANT stands for the condition "this mutant is switched on", which
NYSALT_MUTANT=NUMBER in the environment does. Each edit replaces a text that its file holds exactly once.
"""

from dataclasses import dataclass

LIBRARY = "src/nysalt/"
HEADERS = "include/nysalt/"
HEADER = HEADERS + "scalars/mutant.hpp"  # in the lowest layer, so that every file may include it
SWITCH = """// SPDX-License-Identifier: BSL-1.0
// Which mutant is switched on: tests/mutants/mutants.py.
#pragma once

#include <cstdlib>
#include <type_traits>

namespace nysalt::detail {

/// Number in the environment; 0 where there is none.
inline const int mutant = [] {
  const char* text = std::getenv("NYSALT_MUTANT");
  return text == nullptr ? 0 : std::atoi(text);
}();

/// Whether it is this one; in constant expressions none is.
[[gnu::always_inline]] constexpr bool is_mutant(int number) {
  return !std::is_constant_evaluated() && mutant == number;
}

}  // namespace nysalt::detail
"""


@dataclass(frozen=True)
class Mutant:
    number: int
    what: str       # what is wrong
    file: str
    near: str       # folders of tests/ that should find it, the nearest first
    edits: tuple    # of (old text, new text)
    equivalent: str = ""  # why no test can find it

    def condition(self) -> str:
        if self.file.endswith(".py"):
            return f'(_os.environ.get("NYSALT_MUTANT") == "{self.number}")'
        return f"::nysalt::detail::is_mutant({self.number})"


ALL = []


def mutant(number, what, file, near, *edits, equivalent=""):
    ALL.append(Mutant(number, what, file, near, edits, equivalent))


# ---- Hybrid Monte Carlo.

mutant(1, "the energy of an accepted lane is not renewed where another lane rejects",
       LIBRARY + "sampling/sampler.hpp", "sampling analysis programs",
       ("      set_lane(potential_, k, lane(potential, k));",
        "      if (!MUTANT) set_lane(potential_, k, lane(potential, k));"))
mutant(2, "the rise of the energy is not divided by kT",
       LIBRARY + "sampling/sampler.hpp", "sampling analysis",
       ("(lane(after, k) - lane(before, k)) / temperature",
        "(lane(after, k) - lane(before, k)) / (MUTANT ? 1.0 : temperature)"))
mutant(3, "momenta are divided by the root of the mass instead of multiplied",
       LIBRARY + "sampling/sampler.hpp", "sampling",
       ("normals_[i] * (root * root_mass(system, k))",
        "normals_[i] * (MUTANT ? root / root_mass(system, k) : root * root_mass(system, k))"))
mutant(4, "sampling resumes one trajectory further on",
       LIBRARY + "sampling/sampler.hpp", "sampling programs",
       ("done_ = saved.trajectories;",
        "done_ = saved.trajectories + (MUTANT && saved.trajectories > options_.burn_in ? 1 : 0);"))
mutant(26, "sampling resumes without the count of the steps of its burn-in",
       LIBRARY + "sampling/sampler.hpp", "sampling programs",
       ("for (double* x : {&result_.step, &steps_, &steps_of_burn_in_}) shared.pass(*x);",
        "for (double* x : {&result_.step, &steps_, &steps_of_burn_in_}) shared.pass(*x);\n"
        "    if (MUTANT && restores) steps_of_burn_in_ = 0.0;"))
mutant(29, "the mean duration of a trajectory is half of the length asked for",
       LIBRARY + "sampling/sampler.hpp", "sampling analysis",
       ("std::llround(2.0 * uniform_by_normal(normal[0])",
        "std::llround((MUTANT ? 1.0 : 2.0) * uniform_by_normal(normal[0])"))
mutant(30, "all trajectories have the same duration: the number of the trajectory is not in the counter",
       LIBRARY + "sampling/sampler.hpp", "sampling analysis",
       ("{.step = trajectory, .purpose = noise_purpose::duration}",
        "{.step = MUTANT ? 0 : trajectory, .purpose = noise_purpose::duration}"))
mutant(31, "deviations are not divided by the root of kT: a lost unit",
       LIBRARY + "sampling/sampler.hpp", "sampling",
       ("scales_ = deviations / std::sqrt(options_.temperature);",
        "scales_ = deviations / std::sqrt(MUTANT ? 1.0 : options_.temperature);"))
mutant(32, "a resumed burn-in has forgotten how far the tuning had come",
       LIBRARY + "sampling/sampler.hpp", "sampling programs",
       ("    count_ = saved[4];", "    count_ = MUTANT ? 0.0 : saved[4];"))
mutant(33, "the variance between chains is left out of the masses",
       LIBRARY + "sampling/sampler.cpp", "sampling",
       ("(one.mean - mean).cwiseAbs2()", "(MUTANT ? 0.0 : 1.0) * (one.mean - mean).cwiseAbs2()"))
mutant(34, "effective draws count those of one chain only",
       LIBRARY + "sampling/sampler.cpp", "sampling",
       ("static_cast<double>(draws * chains.size())", "static_cast<double>(draws * (MUTANT ? 1 : chains.size()))"))
mutant(35, "the tuning of proposals takes energies without kT",
       LIBRARY + "sampling/acceptance_step.cpp", "sampling analysis",
       ("rise /= options.temperature;",
        "rise /= MUTANT ? 1.0 : options.temperature;"))
mutant(36, "a refused start has the number within its block",
       LIBRARY + "sampling/sampler.hpp", "sampling",
       ("          lane(potential_, k), first + k));", "          lane(potential_, k), MUTANT ? k : first + k));"))

# ---- Data, losses, the search and its verdicts.

mutant(5, "further trajectories begin at number 0 again", LIBRARY + "flow_map_data.cpp", "data learning",
       ("const std::int64_t number = options.first + first;",
        "const std::int64_t number = (MUTANT ? 0 : options.first) + first;"))
mutant(6, "the reference is checked with the noise of the next step", LIBRARY + "flow_map_data.cpp",
       "data learning",
       ("static_cast<std::int64_t>(pair - data.first_of[trajectory])};",
        "static_cast<std::int64_t>(pair - data.first_of[trajectory]) + (MUTANT ? 1 : 0)};"))
mutant(24, "the range of energies is not extended with further data", LIBRARY + "flow_map_data.cpp",
       "data learning",
       ("if (data.energies && further.energies) {", "if (!MUTANT && data.energies && further.energies) {"))
mutant(9, "the error of the reference is not held against the fit", LIBRARY + "learning/describe.cpp", "learning",
       ("fit.reference_error <= 0.01 * fit.one_step_error",
        "fit.reference_error <= (MUTANT ? 1e9 : 0.01) * fit.one_step_error"))
mutant(27, "that a parameter ran away is never said", LIBRARY + "learning/describe.cpp", "learning",
       ("if (!fit.is_at_no_bound)", "if (!MUTANT && !fit.is_at_no_bound)"))
mutant(10, "the guard has no margin about declared bands", LIBRARY + "learning/stability_guard.cpp", "learning",
       ("for (const auto& band : bands) bands_.push_back({band.low * (1.0 - margin), band.high * (1.0 + margin)});",
        "for (const auto& band : bands)\n    bands_.push_back({band.low * (1.0 - (MUTANT ? 0.0 : margin)), "
        "band.high * (1.0 + (MUTANT ? 0.0 : margin))});"))
mutant(37, "frequencies above a declared band do not widen it", LIBRARY + "learning/stability_guard.cpp", "learning",
       ("widen(bands_[k], largest(over), largest(down));",
        "widen(bands_[k], MUTANT ? 0.0 : largest(over), largest(down));"))
mutant(38, "the growth of a resonance is compared with e^3 instead of 3",
       LIBRARY + "learning/stability_guard.cpp", "learning derivatives",
       ("worst.growth > std::log(too_much)", "worst.growth > (MUTANT ? too_much : std::log(too_much))"))
mutant(11, "minima are judged by the loss", LIBRARY + "learning/search.cpp", "learning",
       ("std::isfinite(found.loss) ? task.judge(found.theta)",
        "std::isfinite(found.loss) ? (MUTANT ? found.loss : task.judge(found.theta))"))
mutant(28, "a minimum is taken that the guard does not admit", LIBRARY + "learning/search.cpp", "learning",
       ("if (!one.admitted) continue;", "if (!MUTANT && !one.admitted) continue;"))
mutant(39, "a parameter beyond its bound is put to the other bound", LIBRARY + "learning/search.cpp", "learning",
       ("theta = theta - low < high - theta ? low : high;",
        "theta = (theta - low < high - theta) != MUTANT ? low : high;"))
mutant(40, "a start outside its range is not projected", LIBRARY + "learning/search.cpp", "learning",
       ("theta[k] = std::clamp(theta[k], low + inset, high - inset);",
        "if (!MUTANT) theta[k] = std::clamp(theta[k], low + inset, high - inset);"))
mutant(41, "all random starts have the same random numbers", LIBRARY + "learning/search.cpp", "learning",
       ("{.trajectory = n, .purpose = noise_purpose::search}",
        "{.trajectory = MUTANT ? 0 : n, .purpose = noise_purpose::search}"))
mutant(42, "standard errors of parameters without the factor B/(B - 1)", LIBRARY + "learning/curvature.cpp",
       "learning",
       ("(squares * (blocks / freedom)).cwiseSqrt()",
        "(squares * (MUTANT ? 1.0 : blocks / freedom)).cwiseSqrt()"))
mutant(43, "the expected excess of a fit is twice as large", LIBRARY + "learning/curvature.cpp", "learning",
       ("result.push_back(0.5 * score.dot(solve(score)));",
        "result.push_back((MUTANT ? 1.0 : 0.5) * score.dot(solve(score)));"))
mutant(12, "a mean square is divided by a rank's own pairs", LIBRARY + "losses/passes.cpp", "losses learning",
       ("increment);\n  const auto total = static_cast<double>(data.all_pairs());",
        "increment);\n  const auto total = static_cast<double>(MUTANT ? data.pairs() : data.all_pairs());"))
mutant(44, "positions in energy coordinates are not multiplied by their frequency", LIBRARY + "losses/passes.cpp",
       "losses learning",
       ("is_scaled ? heavy * omega : heavy", "is_scaled && !MUTANT ? heavy * omega : heavy"))
mutant(45, "the scale of an energy loss is twice as large", LIBRARY + "losses/losses.cpp", "losses learning",
       ("return 1.0 / std::sqrt(data.share().sum(squares)",
        "return (MUTANT ? 2.0 : 1.0) / std::sqrt(data.share().sum(squares)"))
mutant(46, "each frequency counts twice in the loss gaussian_acceptance", LIBRARY + "losses/losses.cpp",
       "losses learning",
       ("const double weight = 0.5 * count;", "const double weight = (MUTANT ? 1.0 : 0.5) * count;"))
mutant(16, "a trial repeats its first 64 starts", LIBRARY + "judging/trial.cpp", "learning programs",
       (".first = first},", ".first = MUTANT ? 0 : first},"))
mutant(122, "a trial asks whether energies diverge, and not whether they err by much", LIBRARY + "judgement.cpp",
       "learning programs",
       ("is_lost = median_of(one.last) > too_much;", "is_lost = !MUTANT && median_of(one.last) > too_much;"))
mutant(123, "judges have the first 64 starts eight times", LIBRARY + "ensembles/starts_to_judge.cpp", "learning",
       ("sound_starts<T>(system, ensemble, seed, first + n, count);",
        "sound_starts<T>(system, ensemble, seed, first + (MUTANT ? n % 64 : n), count);"))
mutant(124, "a method near an edge does not hold", "include/nysalt/judgement.hpp", "learning programs",
       ("verdict == step_verdict::near_an_edge; }", "(!MUTANT && verdict == step_verdict::near_an_edge); }"))
mutant(125, "compare ranks what loses trajectories", "src/comparison/ranking.cpp", "programs",
       ("found == mark::loses ||", "(!MUTANT && found == mark::loses) ||"))
mutant(126, "the energy error of a run is that of its first trajectories alone", "src/comparison/sampled_run.cpp", "programs",
       ("energy_error = std::ranges::max(all_gather(ranks, energy_error));", "energy_error = MUTANT ? 0.0 : std::ranges::max(all_gather(ranks, energy_error));"))

# ---- Analysis.

mutant(7, "a variance is divided by n", LIBRARY + "analysis/statistics.cpp", "analysis",
       ("(x - mean) * (x - mean); }) / (n - 1.0)", "(x - mean) * (x - mean); }) / (MUTANT ? n : n - 1.0)"))
mutant(8, "the variance lacks the error of the mean", LIBRARY + "analysis/ensemble_statistics.cpp", "analysis",
       ("- mean.mean * mean.mean + squared_error;", "- mean.mean * mean.mean + (MUTANT ? 0.0 : squared_error);"))
mutant(22, "histograms of ranks are not merged", LIBRARY + "analysis/ensemble_statistics.cpp", "analysis invariance",
       ("if (wanted_->histogram) gather_histograms();", "if (wanted_->histogram && !MUTANT) gather_histograms();"))
mutant(14, "evaluations are per step instead of per time", LIBRARY + "analysis/trajectory_errors.cpp",
       "analysis programs",
       ("static_cast<double>(evaluations) / time;",
        "static_cast<double>(evaluations) / (MUTANT ? static_cast<double>(options.steps) : time);"))
mutant(25, "the error of a reference in a bath lacks the factor 4/3", LIBRARY + "analysis/trajectory_errors.cpp",
       "analysis", ("if (compared.parts > 0) result", "if (!MUTANT && compared.parts > 0) result"))
mutant(15, "an acceptance without kT", LIBRARY + "analysis/acceptance.cpp", "analysis",
       ("std::exp(-rise / temperature)", "std::exp(-rise / (MUTANT ? 1.0 : temperature))"))
mutant(21, "the error of a crossing without the correlation of the rows", LIBRARY + "analysis/cost_against_error.cpp",
       "analysis", ("2.0 * correlation * a * b", "(MUTANT ? 0.0 : 2.0) * correlation * a * b"))
mutant(47, "the force of the start is not counted", LIBRARY + "analysis/cost_against_error.cpp", "analysis",
       ("word.evaluations_to_open + steps * word.evaluations_per_step",
        "(MUTANT ? 0 : word.evaluations_to_open) + steps * word.evaluations_per_step"))
mutant(48, "the integrated autocorrelation time lacks its factor 2", LIBRARY + "analysis/statistics.cpp",
       "analysis sampling", ("result.tau += 2.0 * rho[k];", "result.tau += (MUTANT ? 1.0 : 2.0) * rho[k];"))
mutant(49, "a number on the upper edge is outside of the histogram", HEADERS + "analysis/statistics.hpp", "analysis",
       ("return select(x > bins_.high,", "return select(MUTANT ? !(x < bins_.high) : x > bins_.high,"))
mutant(50, "a Pareto front keeps a point of equal error and higher cost", LIBRARY + "analysis/cost_against_error.cpp",
       "analysis",
       ("if (!(all[i].error < least)) continue;",
        "if (MUTANT ? all[i].error > least : !(all[i].error < least)) continue;"))
mutant(51, "a covariance is divided by the number of samples, not of pairs",
       HEADERS + "analysis/statistics.hpp", "analysis sampling",
       ("result[lag] = {samples_ - static_cast<double>(lag),",
        "result[lag] = {samples_ - (MUTANT ? 0.0 : static_cast<double>(lag)),"))
mutant(52, "the error of a root lacks its factor 1/2", LIBRARY + "analysis/error_measures.cpp", "analysis",
       ("return {root, mean.standard_error / (2.0 * root)};",
        "return {root, mean.standard_error / ((MUTANT ? 1.0 : 2.0) * root)};"))
mutant(53, "a kinetic temperature without masses", HEADERS + "analysis/ensemble_statistics.hpp", "analysis",
       ("sum += x.p[i] * v[i];", "sum += x.p[i] * (MUTANT ? x.p[i] : v[i]);"))

# ---- Letters, words and steps.

mutant(54, "a kick with a known force has the wrong sign", HEADERS + "flows/drift_kick.hpp", "flows methods",
       ("x.p[i] += x.f[i] * c;", "x.p[i] += x.f[i] * (MUTANT ? C(-c) : c);"))
mutant(55, "the gradient of a gradient kick has the wrong sign", HEADERS + "flows/gradient_kick.hpp",
       "flows methods", ("c * (2.0 * h * h * h)", "c * ((MUTANT ? -2.0 : 2.0) * h * h * h)"))
mutant(56, "a displaced kick is displaced the other way", HEADERS + "flows/gradient_kick.hpp", "flows methods",
       ("return {b * h, c * (h * h)};", "return {b * h, c * (MUTANT ? -h * h : h * h)};"))
mutant(57, "a rotation turns the other way", HEADERS + "flows/rotation.hpp", "flows methods",
       ("const C t = c * h;", "const C t = c * (MUTANT ? -h : h);"))
mutant(58, "a kick of several parts gives all of them the first coefficient", HEADERS + "flows/exact_flow.hpp",
       "flows derivatives",
       ("(kick(system.template part<Part>(), c[K]), ...);",
        "(kick(system.template part<Part>(), c[MUTANT ? 0 : K]), ...);"))
mutant(59, "the velocity of a Kepler flow is divided by the distance at the start", "examples/systems/planets.hpp",
       "flows", ("T(-mu) * g[2] / r;", "T(-mu) * g[2] / (MUTANT ? orbit.r : r);"))
mutant(60, "a cyclotron flow turns positions the other way", "examples/systems/charged_particle.hpp", "flows",
       ("x.q[1] += v[1] * along - v[0] * across;", "x.q[1] += v[1] * along - v[0] * (MUTANT ? C(-across) : across);"))
mutant(61, "noise of a letter O is divided by the root of the mass", HEADERS + "flows/ornstein_uhlenbeck.hpp",
       "flows methods",
       ("of_unit_mass * root_mass(system, i)",
        "of_unit_mass * (MUTANT ? 1.0 / root_mass(system, i) : root_mass(system, i))"))
mutant(62, "the root of a mass of a model is 1", HEADERS + "model.hpp", "flows methods core",
       ("return roots.empty() ? 1.0", "return MUTANT || roots.empty() ? 1.0"))
mutant(63, "the temperature of a bath is sigma^2/gamma", HEADERS + "bath.hpp", "core flows ensembles",
       ("sigma * sigma / (2.0 * friction)", "sigma * sigma / ((MUTANT ? 1.0 : 2.0) * friction)"))
mutant(64, "one half of a merged letter O is taken twice", HEADERS + "stepping/merged_half_steps.hpp",
       "core methods",
       ("both_.decay = begin.decay * end.decay;",
        "both_.decay = begin.decay * end.decay * (MUTANT ? begin.decay : C(1.0));"))
mutant(65, "O at the end of a step comes first, with the coefficients as they were", HEADERS + "langevin.hpp",
       "core methods families",
       ("return letters.with_letters(text + o);", "return letters.with_letters(MUTANT ? o + text : text + o);"))
mutant(66, "the force of a run that is taken up again is lost", HEADERS + "ensemble_run.hpp",
       "core invariance programs",
       ("for (T& number : *part) detail::set_lane(number, k, *next_number++);",
        "for (T& number : *part) {\n"
        "          detail::set_lane(number, k, MUTANT && part == &run.state.f ? 0.0 : *next_number);\n"
        "          ++next_number;\n"
        "        }"))
mutant(67, "before an observation the force is not kept that the first letter is taken back with",
       HEADERS + "stepping/take_steps.hpp", "methods core",
       ("n < steps ? letters.loop : letters.last", "MUTANT || n < steps ? letters.loop : letters.last"))
mutant(68, "the last trajectory of a block that is not full is lost", HEADERS + "stepping/lockstep.hpp",
       "invariance core data",
       ("    for (int k = 0; k < count; ++k) {\n      if (!lane(live, k)) continue;",
        "    for (int k = 0; k < count - (MUTANT && 1 < count && count < lanes_in<T> ? 1 : 0); ++k) {\n"
        "      if (!lane(live, k)) continue;"))
mutant(69, "a single rank adds in another order than several", HEADERS + "shard.hpp",
       "parallel invariance learning analysis",
       ("if (ranks_->is_single()) return tree_sum(terms);",
        "if (MUTANT && ranks_->is_single()) {\n      T all = zero;\n      for (const T& term : terms) all += term;\n"
        "      return all;\n    }\n    if (ranks_->is_single()) return tree_sum(terms);"))

# ---- Noise.

mutant(70, "all letters O of a step have the same noise", HEADERS + "noises/counter_noise.hpp", "noises methods",
       ("slots * static_cast<std::uint64_t>(at.flow)", "slots * static_cast<std::uint64_t>(MUTANT ? 0 : at.flow)"))
mutant(71, "halves of a letter O are split with the noise of the whole", HEADERS + "noises/counter_noise.hpp",
       "noises core methods",
       ("draw(is_burn_in ?", "draw(MUTANT ? purpose_ : is_burn_in ?"))
mutant(72, "trajectories have the same noise from 2^32 on", HEADERS + "noises/counter_noise.hpp", "noises",
       ("(trajectory >> 32) | ((step >> 32U) << 16U)",
        "(MUTANT ? words(std::uint64_t{0}) : trajectory >> 32) | ((step >> 32U) << 16U)"))
mutant(73, "the second half of a step of a path has the wrong sign", HEADERS + "noises/counter_noise.hpp",
       "noises references",
       ("(is_first ? 1.0 : -a) * scale", "(is_first ? 1.0 : MUTANT ? a : -a) * scale"))
mutant(17, "methods are compared on the data that they learned from", "src/comparison/seeds.hpp", "programs report",
       ("return static_cast<std::uint64_t>(which) * seed_limit + seed;",
        "if (MUTANT && which == role::test) return seed;\n"
        "  return static_cast<std::uint64_t>(which) * seed_limit + seed;"))
mutant(74, "a fit is judged on the data that it learned from", "src/comparison/seeds.hpp", "programs report",
       ("constexpr std::uint64_t seed_for(role which, std::uint64_t seed) {",
        "constexpr std::uint64_t seed_for(role which, std::uint64_t seed) {\n"
        "  if (MUTANT && which == role::held_out) which = role::training;"))

# ---- Methods, frequencies, references, ensembles, systems.

mutant(75, "one digit of classical<\"pefrl\"> alone is wrong: the order is 2", HEADERS + "methods/classical.hpp",
       "methods",
       ("(detail::as_data(detail::classical_table[row])) {}",
        "(detail::as_data([] {\n    detail::classical_row one = detail::classical_table[row];\n"
        "    if (MUTANT && one.name == \"pefrl\") {\n      std::array<double, 9> all{};\n"
        "      std::copy_n(one.coefficients.begin(), all.size(), all.begin());\n"
        "      all[1] += 1e-8, all[7] += 1e-8, all[3] -= 1e-8, all[5] -= 1e-8;\n      one.coefficients = all;\n"
        "    }\n    return one;\n  }())) {}"))
mutant(76, "one digit of pefrl is wrong wherever it is taken from the table: the order is 2",
       HEADERS + "methods/classical.hpp", "methods",
       ("          {row.coefficients.begin(), row.coefficients.end()},",
        "          [&] {\n            std::vector<double> all(row.coefficients.begin(), row.coefficients.end());\n"
        "            if (MUTANT && row.name == \"pefrl\") {\n"
        "              all[1] += 1e-8, all[7] += 1e-8, all[3] -= 1e-8, all[5] -= 1e-8;\n            }\n"
        "            return all;\n          }(),"))
mutant(77, "a factor of the energy error of two stages has the wrong sign", LIBRARY + "methods/s_aia.cpp", "methods",
       ("(1.0 - a * rest * x);", "(1.0 - (MUTANT ? -a : a) * rest * x);"))
mutant(78, "methods are fitted to the lowest frequency", LIBRARY + "methods/phase_fitted.cpp", "methods learning",
       ("return system.modes().frequencies.maxCoeff();",
        "return MUTANT ? system.modes().frequencies.minCoeff() : system.modes().frequencies.maxCoeff();"))
mutant(79, "the upper end of a spectrum is no bound", LIBRARY + "derivatives/spectrum.cpp", "derivatives",
       ("high.value + high.residual,", "high.value + (MUTANT ? 0.0 : high.residual),"))
mutant(80, "the finer reference is as coarse as the reference", LIBRARY + "references/fine_steps.cpp",
       "references data analysis",
       ("std::make_shared<small_steps>(0.5 * step_,", "std::make_shared<small_steps>((MUTANT ? 1.0 : 0.5) * step_,"))
mutant(81, "the evaluations of a reference are those of one lane", LIBRARY + "references/fine_steps.cpp",
       "references data",
       ("return count_ * detail::evaluations_of(", "return (MUTANT ? 1 : count_) * detail::evaluations_of("))
mutant(82, "the burn-in is kept as initial states", LIBRARY + "ensembles/gibbs.cpp", "ensembles",
       ("if (n >= first) kept.push_back(x);", "if (MUTANT || n >= first) kept.push_back(x);"))
mutant(83, "a burn-in is a tenth as long", LIBRARY + "ensembles/burn_in.hpp", "ensembles",
       ("options_.length > 0.0 ? options_.length : times_of_tau() * report.tau;",
        "options_.length > 0.0 ? options_.length : (MUTANT ? 0.1 : 1.0) * times_of_tau() * report.tau;"))
mutant(84, "a list of neighbours holds until an atom has moved by the whole skin",
       LIBRARY + "systems/neighbour_list.cpp", "systems",
       ("most_moved_square_((less_than_half * skin) * (less_than_half * skin)),",
        "most_moved_square_((MUTANT ? 4.0 : 1.0) * (less_than_half * skin) * (less_than_half * skin)),"))

# ---- Files: tables, arrays, work files, locks.

mutant(18, "numbers of a work file are not those of its lines", "src/comparison/work_file.cpp",
       "programs parts_of_program",
       ("sum_of(numbers) != (has", "!MUTANT && sum_of(numbers) != (has"))
mutant(85, "a work file that is gone on with is not locked", LIBRARY + "atomic_file.cpp", "programs parts_of_program",
       ("if (ask_for_lock(found.number()) ==", "if (!MUTANT && ask_for_lock(found.number()) =="))
mutant(86, "a work file loses its lock when it is written anew", "src/comparison/work_file.cpp",
       "programs parts_of_program",
       ("  held_ = next.release();", "  if (!MUTANT) held_ = next.release();"))
mutant(23, "a durable file is renamed before it is on the disk", LIBRARY + "atomic_file.cpp", "faults programs",
       ("if (durable && fsync(file_) != 0) fail();", "if (durable && !MUTANT && fsync(file_) != 0) fail();"))
mutant(19, "a segment has its first sample twice", "src/comparison/sampled_run.cpp", "programs",
       ("const std::int64_t before = step > 0 ? step : -1;",
        "const std::int64_t before = step > 0 ? step - (MUTANT ? 1 : 0) : -1;"))
mutant(87, "a resumed table has its line of names again", "src/program/output/run_output.cpp", "programs",
       ("if (state_.at.is_new() && state_.began == 0)", "if (MUTANT || (state_.at.is_new() && state_.began == 0))"))
mutant(88, "times of a table are those of the samples, not of the steps", "src/program/output/sample_table.cpp",
       "programs",
       ("const double t = static_cast<double>(n) * shape_.step;",
        "const double t = static_cast<double>(MUTANT ? n / shape_.every : n) * shape_.step;"))
mutant(89, "a later segment is written over the first rows of an array", "src/program/output/sample_arrays.cpp",
       "programs",
       ("trajectory * shape_.samples + segment.first / shape_.every",
        "trajectory * shape_.samples + (MUTANT ? 0 : segment.first / shape_.every)"))
mutant(90, "the steps in an HDF5 file are numbers of samples", "src/program/output/sample_arrays.cpp", "programs",
       ("{ return n * shape_.every; };", "{ return MUTANT ? n : n * shape_.every; };"))
mutant(91, "chain and draw change places in the table of draws", "src/program/output/kept_draws.cpp", "programs",
       ("row / draws_, row % draws_);", "MUTANT ? row % draws_ : row / draws_, MUTANT ? row / draws_ : row % draws_);"))
mutant(92, "a saved state of sampling lacks the last draw", "src/program/commands/sample.cpp", "programs",
       ("std::max<std::int64_t>(0, trajectories - command.burn_in)",
        "std::max<std::int64_t>(0, trajectories - command.burn_in - (MUTANT ? 1 : 0))"))
mutant(93, "rank 1 takes up the trajectories of its neighbour", "src/comparison/shared_batch.cpp", "programs",
       ("{all.numbers.begin() + begin * each, all.numbers.begin() + end * each},",
        "{all.numbers.begin() + (begin - (MUTANT && r > 0 ? 1 : 0)) * each,\n"
        "                       all.numbers.begin() + (end - (MUTANT && r > 0 ? 1 : 0)) * each},"))
mutant(94, "trajectories of other ranks are written with the number before theirs", "src/comparison/shared_batch.cpp",
       "programs", ("std::int64_t m = first_of(r);", "std::int64_t m = first_of(r) - (MUTANT ? 1 : 0);"))

# ---- The program: options, exit codes, documents, messages, verdicts.

mutant(95, "bad input has the exit code 1", "src/program/run_program.cpp", "programs",
       ("an exception without a message was thrown\" : text,\n                    bad_input);",
        "an exception without a message was thrown\" : text,\n                    MUTANT ? 1 : bad_input);"))
mutant(96, "a full disk has the exit code of bad input", "src/program/run_program.cpp", "programs faults",
       ("return reported(problem.what(), not_written);",
        "return reported(problem.what(), MUTANT ? bad_input : not_written);"))
mutant(97, "SIGTERM has the exit code of SIGINT", "src/program/run_program.cpp", "programs",
       ("return 128 + by.signal();", "return 128 + (MUTANT ? 2 : by.signal());"))
mutant(98, "a run whose every trajectory diverged has the exit code 0", "src/program/commands/run.cpp", "programs",
       ("return all_diverged && !was_finished ? no_result : done;",
        "return all_diverged && !was_finished && !MUTANT ? no_result : done;"))
mutant(99, "a refused work file names only the last option that differs", "src/comparison/work_file.cpp",
       "programs parts_of_program",
       ("changed += changed.empty() ? name : \", \" + name;",
        "changed = changed.empty() || MUTANT ? name : changed + \", \" + name;"))
mutant(100, "--chains is taken for --draws", "src/program/options/sample.cpp", "programs",
       ("\"--chains\", asked.chains,", "\"--chains\", MUTANT ? asked.draws : asked.chains,"))
mutant(101, "the default length with masses is pi instead of pi/2", "src/program/commands/sample.cpp", "programs",
       ("command.length.value_or(0.5 * std::numbers::pi)",
        "command.length.value_or((MUTANT ? 1.0 : 0.5) * std::numbers::pi)"))
mutant(102, "the JSON document of sample lacks its warnings", "src/program/commands/sample.cpp", "programs",
       ("document[\"warnings\"] = warnings;", "if (!MUTANT) document[\"warnings\"] = warnings;"))
mutant(20, "recommend: observations do not count in evaluations_per_time",
       "src/comparison/recommendation_measuring.cpp", "programs report", ("(options_.looks - 1) *", "(options_.looks - (MUTANT ? options_.looks : 1)) *"))
mutant(103, "recommend: costs that are equal within the tolerance are no tie", "src/comparison/contest.cpp",
       "programs report parts_of_program",
       ("if (ratio > cost_ratio) return learned;", "if (ratio > (MUTANT ? 1.0 : cost_ratio)) return learned;"))
mutant(104, "recommend: the scores of two methods are drawn without their pairing", "src/comparison/paired_ratio.cpp",
       "programs report parts_of_program",
       ("of_b[i] = b[k];", "of_b[i] = b[MUTANT ? draw() % b.size() : k];"))
mutant(105, "compare: a reference may err by half as much as a method", "src/comparison/ranking.cpp",
       "programs report parts_of_program",
       ("constexpr double known_well = 0.1;", "const double known_well = MUTANT ? 0.5 : 0.1;"))
mutant(106, "compare: a learned method is set beside one of up to twice its cost", "src/comparison/ranking.cpp",
       "programs report parts_of_program",
       ("constexpr double start_up = 1.01;", "const double start_up = MUTANT ? 2.0 : 1.01;"))
mutant(107, "a force that is not the slope of its potential is accepted", "src/comparison/user_system_checks.cpp",
       "programs report python parts_of_program",
       ("if (!found.passed()) refuse(", "if (!MUTANT && !found.passed()) refuse("))

# ---- Plug-ins, exports, Python.

mutant(108, "a plug-in is compiled once, whatever its source says", "src/plugin/build.cpp", "smoke programs",
       ("return name_of(beginning + contents) + \".so\";",
        "return name_of(MUTANT ? beginning : beginning + contents) + \".so\";"))
mutant(13, "coefficients are exported with 15 digits", LIBRARY + "exports/placeholders.cpp", "programs methods",
       ("std::string text = fmt::format(\"{}\", value);",
        "std::string text = MUTANT ? fmt::format(\"{:.15g}\", value) : fmt::format(\"{}\", value);"))
mutant(109, "exported to C, the noise of the bath is multiplied by the root of the inverse mass",
       LIBRARY + "exports/export_to.cpp", "programs smoke",
       ("  return written(pieces, {exported, host});",
        "  std::string text = written(pieces, {exported, host});\n  const auto at = text.find(\"spread / sqrt\");\n"
        "  if (MUTANT && at != std::string::npos) text[at + 7] = '*';\n  return text;"))
mutant(110, "a gradient kick is exported as a displaced kick of half the displacement",
       LIBRARY + "exports/exported_method.cpp", "programs methods",
       ("c[slot + 1] *= 2.0 / c[slot];", "c[slot + 1] *= (MUTANT ? 1.0 : 2.0) / c[slot];"))
mutant(111, "Python: fine_step is ignored", "python/arguments.cpp", "python",
       ("arguments.take(\"fine_step\", how.fine_step);", "if (!MUTANT) arguments.take(\"fine_step\", how.fine_step);"))
mutant(112, "Python: starts() ignores the role", "python/nysalt/__init__.py", "python",
       ("seed=seed, role=role))", "seed=seed, role=\"test\" if MUTANT else role))"))

# ---- What tests once found only in passing.

mutant(113, "signals that end a process, but those that are usual, leave its unfinished file",
       "src/comparison/interruption.cpp", "programs",
       ("SIGPWR, SIGSTKFLT})\n    handle(", "SIGPWR, SIGSTKFLT})\n    if (!MUTANT) handle("))
mutant(114, "the draws of a chain depend on how many chains there are",
       LIBRARY + "sampling/sampler.hpp", "sampling programs",
       ("starts, options.seed, first, count)", "starts, options.seed + (MUTANT ? options.chains : 0), first, count)"))
mutant(115, "the limit of stability is the end of the last window", "src/program/commands/stability.cpp", "programs",
       ("chart.windows.front().high : 0.0", "(MUTANT ? chart.windows.back() : chart.windows.front()).high : 0.0"))
mutant(116, "the limit of stability is not divided by the evaluations",
       "src/program/commands/stability.cpp", "programs",
       ("json(limit / evaluations)", "json(MUTANT ? limit : limit / evaluations)"))
mutant(117, "learn: a file is named that could not be written", "src/program/commands/learn.cpp", "programs",
       ("keep && written ?", "keep && (MUTANT || written) ?"))
mutant(118, "the reference is checked on the first trajectories alone", LIBRARY + "flow_map_data.cpp", "data learning",
       ("spread_pairs(data.all_pairs(), checks)", "spread_pairs(MUTANT ? checks : data.all_pairs(), checks)"))
mutant(119, "the error of a mean acceptance is half as large", LIBRARY + "analysis/acceptance.cpp", "analysis sampling",
       ("  acceptance_result result{mean_and_error(of_each), of_each, {}};",
        "  acceptance_result result{mean_and_error(of_each), of_each, {}};\n"
        "  if (MUTANT) result.probability.standard_error *= 0.5;"))
mutant(120, "standard errors of parameters lack the factor 2 of the gradient of a square",
       LIBRARY + "losses/passes.cpp", "learning losses",
       ("r.slope(k, i) * 2.0;", "r.slope(k, i) * (MUTANT ? 1.0 : 2.0);"))
mutant(121, "another seed is a shift of the numbers of trajectories", LIBRARY + "ensembles/distributions.cpp", "ensembles",
       ("Eigen::VectorXd normals(2 * pairs_);\n  standard_normals(seed, {.trajectory = n,",
        "Eigen::VectorXd normals(2 * pairs_);\n  standard_normals(MUTANT ? 0 : seed, {.trajectory = MUTANT ? seed + n : n,"))
