// SPDX-License-Identifier: BSL-1.0
// Compiled with -O2: 99 s at -O0, 25 s at -O2.
// What a fit says of its own uncertainty holds: its intervals cover what many data tell, and the loss that it
// expects to lose by them is lost [li_lu_tao_ye_2023, theorem 3.1].
// Tier 1 has that learning goes on until the data are enough, and finds what as many tell at once, in
// learning/reach_of_data_test and programs/cases/curves.txt.
#include <boost/test/unit_test.hpp>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <array>
#include <cmath>
#include <vector>

#include "../../../src/nysalt/losses/after_steps.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;

namespace {

constexpr int seeds = 50;
constexpr std::int64_t usual = 100;  // trajectories
const fpu_chain<3> chain(50.0);
const fpu_law<3> law(chain);
const auto reference = fine_steps(1e-3);

flow_map_data data_of(std::int64_t trajectories, std::uint64_t seed) {
  return make_flow_map_data(chain, law, reference,
                            {.step = 0.03,
                             .horizon = 0.5,
                             .trajectories = trajectories,
                             .seed = seed,
                             .execution = {.threads = 2}});
}
const flow_map_data& many() {
  static const auto data = data_of(20'000, 1'000'000);
  return data;
}

/// From its usual start, as there is one minimum.
fit fit_of(const family& family, const flow_map_data& data, const flow_map_data& held_out) {
  return learn(family, chain, data, held_out, {.loss = loss_named("state:1"), .execution = {.threads = 2}});
}

fit fit_of(const family& family, const flow_map_data& data) {
  static const auto held_out = data_of(4, 999'999);
  return fit_of(family, data, held_out);
}

/// As if all pairs were independent of each other.
flow_map_data taken_apart(flow_map_data data) {
  data.first_of.clear();
  for (std::size_t n = 0; n <= data.pairs(); ++n) data.first_of.push_back(n);
  return data;
}

/// Of seeds that print errors: how many intervals of M = 100 cover the truth, and the sum of squared
/// distances in standard errors.
struct coverage {
  int by_interval = 0;
  int by_half = 0;
  double squares = 0.0;
  double squares_taken_apart = 0.0;
};

std::vector<coverage> coverage_of(const family& family) {
  const auto truth = fit_of(family, many()).summary.parameters;
  const auto count = static_cast<std::size_t>(family.parameters());
  std::vector<coverage> result(count);
  const double quantile_95 = quantile(boost::math::students_t(usual - 1), 0.975);
  int printed = 0;
  for (std::uint64_t seed = 1; printed < seeds && seed <= 2 * seeds; ++seed) {
    const auto data = data_of(usual, seed);
    const auto held_out = data_of(usual, 3'000'000 + seed);
    const auto found = fit_of(family, data, held_out).summary;
    if (!found.errors_withheld.empty()) continue;
    ++printed;
    const auto& clustered = found.parameters;
    const auto apart = fit_of(family, taken_apart(data), taken_apart(held_out)).summary.parameters;
    for (std::size_t k = 0; k < count; ++k) {
      const double off = std::abs(clustered[k].value - truth[k].value);
      result[k].by_interval += off <= quantile_95 * clustered[k].standard_error;
      result[k].by_half += off <= 0.5 * quantile_95 * clustered[k].standard_error;
      result[k].squares += std::pow(off / clustered[k].standard_error, 2);
      result[k].squares_taken_apart += std::pow(off / apart[k].standard_error, 2);
    }
  }
  BOOST_TEST(printed == seeds);
  return result;
}

}  // namespace

// If each covers with probability .95, fewer than 43 of 50 do once in 500 times.
BOOST_AUTO_TEST_CASE(intervals_of_a_hundred_trajectories_cover_the_value_of_twenty_thousand) {
  for (const auto& family : {nysalt::family(nystrom()), nysalt::family(fg_chin())}) {
    const auto all = coverage_of(family);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const auto& covered = all[k];
      BOOST_TEST_CONTEXT(family.name << " " << family.parameter_names[k] << ": " << covered.by_interval
                                     << ", of half the width " << covered.by_half << ", squares "
                                     << covered.squares << ", with pairs taken apart "
                                     << covered.squares_taken_apart) {
        BOOST_TEST(covered.by_interval >= 43);
        BOOST_TEST(covered.by_half < 43);
        // The squares are chi-squared; a reported variance is 15 % off at most in the mean. Errors of pairs
        // cancel along a trajectory here: taken for independent they make intervals that are far too wide.
        const boost::math::chi_squared squares(seeds);
        BOOST_TEST(covered.squares > 0.85 * quantile(squares, 1e-3));
        BOOST_TEST(covered.squares < 1.15 * quantile(squares, 1.0 - 1e-3));
        BOOST_TEST(covered.squares_taken_apart < quantile(squares, 1e-3));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(the_loss_is_larger_by_what_is_expected_and_that_falls_as_one_over_the_number) {
  const nysalt::family family{nystrom()};
  // On new data, in the measure that many data tell.
  const metric measure(chain, many(), coordinates::qp);
  const auto unseen = data_of(4000, 2'000'000);
  const after_steps loss(family, chain, unseen, state_error(measure), {.execution = {.threads = 2}});
  const double least = loss.value(fit_of(family, many()).theta);
  std::vector<double> log_count, log_lost, log_expected, relative_errors;
  for (const std::int64_t trajectories : {25, 100, 400}) {
    std::vector<double> lost, expected;
    for (int n = 0; n < seeds; ++n) {
      const auto found = fit_of(family, data_of(trajectories, 1 + static_cast<std::uint64_t>(n)));
      lost.push_back(loss.value(found.theta) - least);
      expected.push_back(found.summary.expected_excess);
    }
    const auto mean_lost = mean_and_error(lost);
    const auto mean_expected = mean_and_error(expected);
    const double error = std::hypot(mean_lost.standard_error, mean_expected.standard_error);
    BOOST_TEST_CONTEXT(trajectories << ": " << mean_lost.mean << " +- " << mean_lost.standard_error << ", "
                                    << mean_expected.mean << " expected") {
      BOOST_TEST(std::abs(mean_lost.mean - mean_expected.mean) <= 3.0 * error);
      BOOST_TEST(std::abs(mean_lost.mean - 2.0 * mean_expected.mean) > 3.0 * error);  // without the half
    }
    log_count.push_back(std::log(static_cast<double>(trajectories)));
    log_lost.push_back(std::log(mean_lost.mean));
    log_expected.push_back(std::log(mean_expected.mean));
    relative_errors.push_back(mean_lost.standard_error / mean_lost.mean);
  }
  double spread = 0.0;
  for (const double x : log_count) spread += std::pow(x - mean_and_error(log_count).mean, 2);
  const double error = *std::max_element(relative_errors.begin(), relative_errors.end()) / std::sqrt(spread);
  BOOST_TEST_CONTEXT("slopes " << slope(log_count, log_lost) << " and " << slope(log_count, log_expected)
                               << " +- " << error) {
    BOOST_TEST(std::abs(slope(log_count, log_lost) + 1.0) <= 3.0 * error);
    BOOST_TEST(std::abs(slope(log_count, log_lost) + 0.5) > 3.0 * error);
    BOOST_TEST(std::abs(slope(log_count, log_expected) + 1.0) <= 0.1);  // a variance from 25 is 7 % low
  }
}
