// SPDX-License-Identifier: BSL-1.0
// How large steps may be, other starts than those learned from, and what theory says of long times.
#include <algorithm>
#include <cmath>
#include <limits>

#include "comparison/stability.hpp"
#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

lesson usual(const setting& setup) { return {.trajectories = setup.pick<std::int64_t>(100, 10)}; }

std::int64_t diverged(const std::vector<record>& runs) {
  return std::count_if(runs.begin(), runs.end(),
                       [](const record& run) { return run.diverged_at.has_value(); });
}

struct at_step {
  double step;
  std::vector<estimate> theta;
  bool usable;
  double limit;  // end of the first window of delta omega
  std::int64_t lost_by_learned, lost_by_fixed;
};

at_step stability_at(const setting& setup, const prepared_problem& system, double step, double horizon,
                     std::int64_t count) {
  const auto learned = learn_at(setup, system, step, usual(setup));
  const auto lost = [&](const tabulated& method) {
    return diverged(followed(setup, system, method, step, horizon, horizon, count, {"stiff_energy"}));
  };
  return {step,
          theta_with_errors(learned),
          learned.fit.usable,
          limit_of(learned.method),
          lost(learned.method),
          lost(two_stages(0.5, 0.40))};
}

/// The last step at which no trajectory is lost, nor at any smaller step.
double largest(const std::vector<at_step>& all, std::int64_t at_step::*lost) {
  double last = 0.0;
  for (const auto& one : all) {
    if (one.*lost > 0) break;
    last = one.step;
  }
  return last;
}

}  // namespace

exhibit largest_stable_step(const setting& setup) {
  const auto system = chain();
  const auto count = setup.pick<std::int64_t>(64, 16);
  const double distance = setup.pick(0.001, 0.006);
  std::vector<at_step> all;
  for (double step = 0.038; step < 0.0605; step += distance) {
    const double rounded = std::round(step * 1e4) * 1e-4;
    const double horizon = rounded * std::ceil(setup.pick(150.0, 5.0) / rounded);
    all.push_back(stability_at(setup, *system, rounded, horizon, count));
  }
  table rows(
      {"delta", "b1", "beta1", "its linear limit/omega", "usable", "lost, learned", "lost, (0.5, 0.40)"}, 0);
  for (const auto& one : all) {
    rows.add({fmt::format("{:.3f}", one.step), with_error(one.theta[0]), with_error(one.theta[1]),
              fmt::format("{:.4f}", one.limit / omega), one.usable ? "yes" : "no",
              fmt::format("{}", one.lost_by_learned), fmt::format("{}", one.lost_by_fixed)});
  }
  const double limit = std::sqrt(20.0 / 3.0) / omega;
  const double learned = largest(all, &at_step::lost_by_learned);
  const double fixed = largest(all, &at_step::lost_by_fixed);
  const auto is_close = [&](double step) { return std::abs(step / limit - 1.0) <= 0.05; };
  const std::vector<reading> readings{{"parameters learned at each step", is_close(learned)},
                                      {"the fixed (0.5, 0.40)", is_close(fixed)}};
  return {"Largest stable step of the chain",
          "text after Figure 4, section 5.2",
          {{"stable beyond 2/omega, up to close to sqrt(20/3)/omega = 0.0516",
            "last step up to which no trajectory diverges by time 150",
            fmt::format("learned {:.3f}, fixed (0.5, 0.40) {:.3f}; steps are {:g} apart", learned, fixed,
                        distance),
            verdict_of("whether parameters are learned at each step", readings),
            told(readings) + "; close: within 5 %",
            "nysalt stability --family nystrom --parameters 0.5,0.4 --system fpu --step 0.05"}},
          {fmt::format("{} trajectories to time 150. Learning here asks for linear stability at the chain's "
                       "frequencies; the parameters move with it, and with them the limit.",
                       count)},
          {{"Trajectories that are lost:", rows}},
          {}};
}

namespace {

/// Errors over [0, 0.5] on starts of one kind, of the schemes learned from either and of McLachlan's.
struct crossed {
  std::string tested_on;
  double step;
  estimate own, other, mclachlan;
  double of_reference;
};

std::vector<crossed> cross(const setting& setup, const std::vector<double>& steps) {
  const auto stiff = chain();
  const auto soft = soft_dominated_chain();
  const judged how{.horizon = 0.5, .trajectories = setup.pick<std::int64_t>(400, 16), .metric = "state"};
  std::vector<crossed> all;
  for (const double step : steps) {
    const auto from_stiff = learn_at(setup, *stiff, step, usual(setup)).method;
    const auto from_soft = learn_at(setup, *soft, step, usual(setup)).method;
    const auto mclachlan = classical("mclachlan2", *stiff);
    const auto on_stiff = errors_at(setup, *stiff, {from_stiff, from_soft, mclachlan}, step, how);
    const auto on_soft = errors_at(setup, *soft, {from_soft, from_stiff, mclachlan}, step, how);
    for (const auto& [name, found] :
         {std::pair{"stiff-dominated", &on_stiff}, std::pair{"soft-dominated", &on_soft}}) {
      all.push_back({name, step, error_of(found->methods[0]), error_of(found->methods[1]),
                     error_of(found->methods[2]), found->of_reference});
    }
  }
  return all;
}

}  // namespace

exhibit other_starts(const setting& setup) {
  const auto all = cross(setup, setup.pick<std::vector<double>>({0.01, 0.02, 0.03}, {0.02}));
  table rows({"tested on", "delta", "learned there", "learned on the others", "ratio", "McLachlan",
              "reference's own"});
  std::vector<reading> readings;
  std::string ours;
  for (const char* kind : {"stiff-dominated", "soft-dominated"}) {
    double worst = 0.0;
    for (const auto& one : all) {
      if (one.tested_on != kind) continue;
      const double ratio = one.other.mean / one.own.mean;
      worst = std::max(worst, std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity());
      rows.add({kind, fmt::format("{:g}", one.step), with_error(one.own), with_error(one.other),
                fmt::format("{:.2f}", ratio), with_error(one.mclachlan),
                fmt::format("{:.0e}", one.of_reference)});
    }
    readings.push_back({std::string("tests on ") + kind + " starts", worst <= 2.0});
    ours += fmt::format("{}{:.2f} on {} starts", ours.empty() ? "" : ", ", worst, kind);
  }
  return {"Starts of another kind than those learned from",
          "text of section 5.1",
          {{"trained on one type of starts only, NySALT can predict the dynamics of the other type",
            "largest ratio of the error of the scheme learned on the others to that learned there, state on "
            "[0, 0.5]",
            ours, verdict_of("which starts are tested on", readings),
            told(readings) + "; at most twice the error of the scheme that was learned there", ""}},
          {"Stiff-dominated starts are the paper's (5.5). Soft-dominated ones have the same stiff springs, "
           "and the "
           "energy omega^2 in the soft ones: x_0 = omega^(1/2), y_0 = omega/3^(1/2)."},
          {{"Error of the state (energy norm):", rows}},
          {}};
}

namespace {

/// Root mean square over trajectories of the difference of states, in sqrt(omega^2 q^2 + p^2), at each
/// sample.
std::vector<double> state_errors(const std::vector<record>& runs, const std::vector<record>& reference) {
  constexpr std::size_t width = 12;
  std::vector<double> result;
  for (std::size_t i = 1; i < reference[0].values.size() / width; ++i) {
    double sum = 0.0;
    for (std::size_t m = 0; m < runs.size(); ++m) {
      for (std::size_t k = 0; k < width; ++k) {
        const double scale = k < width / 2 ? omega : 1.0;
        const std::size_t at = i * width + k;
        const double off = at < runs[m].values.size() ? scale * (runs[m].values[at] - reference[m].values[at])
                                                      : std::numeric_limits<double>::infinity();
        sum += off * off;
      }
    }
    result.push_back(std::sqrt(sum / static_cast<double>(runs.size())));
  }
  return result;
}

const std::vector<std::string> whole_state{"q1", "q2", "q3", "q4", "q5", "q6",
                                           "p1", "p2", "p3", "p4", "p5", "p6"};

estimate exponent_between(const std::vector<double>& t, const std::vector<double>& e, double low,
                          double high) {
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t[i] < low - 1e-9 || t[i] > high + 1e-9) continue;
    x.push_back(t[i]);
    y.push_back(e[i]);
  }
  return exponent(x, y);
}

/// Of one step: the errors over time, and where the phases of the stiff springs are off by so much that their
/// part of the error can hardly grow: half of its largest value up to time 40, before chaos shows.
struct growth {
  double step;
  curve errors;
  double saturated;
  estimate before, late;  // exponents up to there, and in the second half of the time
};

growth growth_at(const setting& setup, const prepared_problem& system, double step, double sample,
                 double horizon, const std::vector<record>& reference) {
  const auto learned = learn_at(setup, system, step, usual(setup)).method;
  const auto count = static_cast<std::int64_t>(reference.size());
  const auto e =
      state_errors(followed(setup, system, learned, step, horizon, sample, count, whole_state), reference);
  std::vector<double> t;
  for (std::size_t i = 0; i < e.size(); ++i) t.push_back(sample * static_cast<double>(i + 1));
  const auto quiet = static_cast<std::ptrdiff_t>(std::min(40.0, horizon) / sample + 0.5);
  const double level = 0.5 * *std::max_element(e.begin(), e.begin() + quiet);
  const auto first = std::find_if(e.begin(), e.end(), [&](double x) { return x > level; });
  const double saturated = t[static_cast<std::size_t>(first - e.begin())];
  return {step,
          {fmt::format("delta = {:g}", step), t, e, {}, step == 0.02},
          saturated,
          exponent_between(t, e, 0.0, saturated),
          exponent_between(t, e, 0.5 * horizon, horizon)};
}

}  // namespace

exhibit growth_of_error(const setting& setup) {
  const auto system = chain();
  const double horizon = setup.pick(100.0, 10.0);
  constexpr double sample = 0.2;
  const auto reference = followed(setup, *system, classical("srkn11b", *system), 0.5 * reference_step(sample),
                                  horizon, sample, setup.pick<std::int64_t>(64, 16), whole_state);
  panel picture{"", "time", "error of the state", false, {}};
  picture.log_log = true;
  table rows(
      {"delta", "exponent up to saturation", "saturated at", "exponent in the second half of the time"}, 0);
  bool before = true;
  bool late = true;
  std::string ours;
  for (const double step : {0.005, 0.01, 0.02}) {
    const growth one = growth_at(setup, *system, step, sample, horizon, reference);
    rows.add({fmt::format("{:g}", step), with_error(one.before), fmt::format("{:.3g}", one.saturated),
              with_error(one.late)});
    before = before && agrees(one.before, 1.0, 0.4);
    late = late && one.late.mean - 2.0 * one.late.standard_error <= 1.2;
    ours += fmt::format("{}{} and {} at delta = {:g}", ours.empty() ? "" : ", ", with_error(one.before),
                        with_error(one.late), step);
    curve thinned{one.errors.label, {}, {}, {}, one.errors.emphasised};
    for (std::size_t i = 0; i < one.errors.x.size(); i += 1 + i / 20) {
      thinned.x.push_back(one.errors.x[i]);
      thinned.y.push_back(one.errors.y[i]);
    }
    picture.curves.push_back(thinned);
  }
  const std::vector<reading> readings{{"times until the stiff phases are off", before},
                                      {fmt::format("times from {:g} to {:g}", 0.5 * horizon, horizon), late}};
  return {
      "Growth of the global error",
      "section 3.4",
      {{"the error grows at most linearly in time, C h^(p+1) i, up to i = C' h^(-p-1)",
        "exponent of the error of the state (energy norm) against time, up to saturation and after half of "
        "the time",
        ours, verdict_of("the time", readings),
        told(readings) +
            "; at most 1, to a fifth and two standard errors. The theorem is of integrable systems "
            "near their tori; the chain is chaotic, and shows it from time 50 on",
        "nysalt compare --system fpu --methods learned:nystrom --steps 0.02 --horizon 2 --metric state"}},
      {"Between, the error of the stiff phases goes up and down: it cannot be more than the whole motion."},
      {{"Growth of the error of the learned schemes:", rows}},
      {{{"growth_of_error", {picture}}, "Error of the state of learned schemes against time."}}};
}

namespace {

/// Largest |x - x_0|/x_0 along each trajectory for observable k of two, over a part of the time.
std::vector<double> largest_change(const std::vector<record>& runs, std::size_t k, double part) {
  std::vector<double> result;
  for (const auto& run : runs) {
    const auto samples = static_cast<std::size_t>(part * static_cast<double>(run.values.size() / 2));
    double most = 0.0;
    for (std::size_t i = 1; i < samples; ++i) {
      most = std::max(most, std::abs(run.values[2 * i + k] / run.values[k] - 1.0));
    }
    result.push_back(run.diverged_at ? std::numeric_limits<double>::quiet_NaN() : most);
  }
  return result;
}

}  // namespace

exhibit conserved_action(const setting& setup) {
  const auto system = chain();
  const double horizon = setup.pick(10'000.0, 20.0);
  const auto count = setup.pick<std::int64_t>(32, 16);
  constexpr double sample = 0.12;  // a multiple of all steps
  const std::vector<std::string> watched{"stiff_energy", "energy"};
  const auto by_reference = followed(setup, *system, classical("srkn11b", *system), reference_step(sample),
                                     horizon, sample, count, watched);
  const estimate exact = mean_and_error(largest_change(by_reference, 0, 1.0));
  table rows({"delta", "I, whole time", "I, first tenth", "H, whole time", "H, first tenth"}, 0);
  rows.add({"reference", with_error(exact), with_error(mean_and_error(largest_change(by_reference, 0, 0.1))),
            with_error(mean_and_error(largest_change(by_reference, 1, 1.0))),
            with_error(mean_and_error(largest_change(by_reference, 1, 0.1)))});
  const std::vector<double> steps{0.005, 0.01, 0.02, 0.03, 0.04};
  std::vector<double> of_I;
  std::vector<double> of_H;
  double drift = 0.0;
  for (const double step : steps) {
    const auto learned = learn_at(setup, *system, step, usual(setup)).method;
    const auto runs = followed(setup, *system, learned, step, horizon, sample, count, watched);
    const auto H = mean_and_error(largest_change(runs, 1, 1.0));
    const auto early = mean_and_error(largest_change(runs, 1, 0.1));
    of_I.push_back(mean_and_error(largest_change(runs, 0, 1.0)).mean);
    of_H.push_back(H.mean);
    drift = std::max(drift, H.mean / early.mean);
    rows.add({fmt::format("{:g}", step), with_error(mean_and_error(largest_change(runs, 0, 1.0))),
              with_error(mean_and_error(largest_change(runs, 0, 0.1))), with_error(H), with_error(early)});
  }
  const auto rises_at_least_as = [&](const std::vector<double>& x) {
    const estimate found = exponent(steps, x);
    return found.mean + 2.0 * found.standard_error >= 1.9;
  };
  const std::vector<reading> readings{{"I, the stiff energy", rises_at_least_as(of_I)},
                                      {"H, the energy", rises_at_least_as(of_H)}};
  return {
      "Actions over long times",
      "section 3.4",
      {{"an action stays within C h^p of its start over long times",
        "exponent of the largest change up to time 10^4 against the step, for I and for H",
        fmt::format("I {}, H {}; exact dynamics change I by {}", with_error(exponent(steps, of_I)),
                    with_error(exponent(steps, of_H)), with_error(exact)),
        verdict_of("what is called an action", readings),
        told(readings) +
            "; at least 2 within two standard errors. I is an adiabatic invariant, no action: it moves "
            "by itself, however small the step",
        "nysalt run --system fpu --method srkn6b --step 0.02 --horizon 10000 --sample-every 10 --observables "
        "stiff_energy,energy"},
       {"and does so without a drift",
        "largest change of H over the whole time over that of the first tenth, worst step",
        fmt::format("{:.2f}", drift), verdict_of(drift <= 2.0), "at most 2: a drift would give 10", ""}},
      {},
      {{fmt::format("Largest relative change up to time {:g}, mean over {} trajectories:", horizon, count),
        rows}},
      {}};
}

}  // namespace nysalt::program::paper
