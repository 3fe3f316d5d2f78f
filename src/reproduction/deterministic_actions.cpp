// SPDX-License-Identifier: BSL-1.0
// Actions over long times: section 3.4.
#include <algorithm>
#include <cmath>
#include <limits>

#include "parts.hpp"

namespace nysalt::program::paper {

namespace {

/// Largest |x - x_0|/x_0 along each trajectory for observable k of two, over a part of the time.
std::vector<double> largest_change(const std::vector<record>& runs, std::size_t k, double part) {
  std::vector<double> result;
  for (const auto& run : runs) {
    const auto samples = static_cast<std::size_t>(part * 0.5 * static_cast<double>(run.values.size()));
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
    const auto learned = learn_at(setup, *system, step, usual_learning_setup(setup)).method;
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
        summary_of(readings) +
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
