// SPDX-License-Identifier: BSL-1.0
// Growth of the global error in time: section 3.4.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parts.hpp"

namespace nysalt::program::paper {

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
  const auto learned = learn_at(setup, system, step, usual_learning_setup(setup)).method;
  const auto count = static_cast<std::int64_t>(reference.size());
  const auto e =
      state_errors(followed(setup, system, learned, step, horizon, sample, count, whole_state), reference);
  std::vector<double> t;
  for (std::size_t i = 0; i < e.size(); ++i) t.push_back(sample * static_cast<double>(i + 1));
  const auto quiet = std::lround(std::min(40.0, horizon) / sample);
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
        summary_of(readings) +
            "; at most 1, to a fifth and two standard errors. The theorem is of integrable systems "
            "near their tori; the chain is chaotic, and shows it from time 50 on",
        "nysalt compare --system fpu --methods learned:nystrom --learn-loss state:1 --steps 0.02 --horizon 2 "
        "--metric state"}},
      {"Between, the error of the stiff phases goes up and down: it cannot be more than the whole motion."},
      {{"Growth of the error of the learned schemes:", rows}},
      {{{"growth_of_error", {picture}}, "Error of the state of learned schemes against time."}}};
}

}  // namespace nysalt::program::paper
