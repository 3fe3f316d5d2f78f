// SPDX-License-Identifier: BSL-1.0
// Who is best at which cost: what error bars do not separate is not called better.
#include <numbers>
#include <set>

#include "../../src/comparison/verdict.hpp"

using namespace nysalt;
using namespace nysalt::program;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const std::string unit = "evaluations";

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

/// A method of an order: error = scale * (cost/100)^-order at costs 50, 100, ..., with relative error bars.
std::vector<ranked_method> method(const std::string& name, double scale, double order, double bar = 0.02) {
  std::vector<ranked_method> result;
  for (const double cost : {50.0, 100.0, 200.0, 400.0}) {
    const double error = scale * std::pow(cost / 100.0, -order);
    result.push_back(
        {.method = name, .step = 1.0 / cost, .cost = cost, .error = error, .standard_error = bar * error});
  }
  return result;
}

std::vector<ranked_method> together(std::initializer_list<std::vector<ranked_method>> all) {
  std::vector<ranked_method> result;
  for (const auto& one : all) result.insert(result.end(), one.begin(), one.end());
  return result;
}

using list = std::set<std::string>;

list names(const best_at_cost& one) {
  list result;
  for (const ranked_method& best : one.best) result.insert(best.method);
  return result;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_clear_winner_is_named_at_every_cost) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> order(1.0, 6.0);
  for (int draw = 0; draw < 100; ++draw) {
    const double p = order(random);
    auto all = together({method("a", 1.0, p), method("b", 3.0, p), method("c", 10.0, p)});
    std::ranges::shuffle(all, random);
    const auto found = best_at_costs(all, 1.01);
    BOOST_TEST_REQUIRE(found.size() == 4U);
    for (const auto& one : found) {
      BOOST_TEST((names(one) == list{"a"}));
      BOOST_TEST(one.next->method == "b");
    }
    const std::string text = verdict_of(found, unit);
    BOOST_TEST(has(text,
                   "`a` is best: at 50 to 400 evaluations its error is 3.00 ± 0.08 times smaller than that "
                   "of the next, `b`."),
               text);
  }
}

BOOST_AUTO_TEST_CASE(curves_that_cross_have_a_winner_on_either_side) {
  // Equal at 100 or 200: the higher order wins above, and a tie is where they cross.
  for (const double at : {100.0, 200.0}) {
    const double scale = std::pow(at / 100.0, 2.0);
    const auto found = best_at_costs(together({method("low", 1.0, 2.0), method("high", scale, 4.0)}), 1.01);
    for (const auto& one : found) {
      const list expected = one.cost < at ? list{"low"} : one.cost > at ? list{"high"} : list{"high", "low"};
      BOOST_TEST((names(one) == expected));
    }
    const std::string text = verdict_of(found, unit);
    BOOST_TEST(has(text, "Who is best depends on the cost: `low` "), text);
    BOOST_TEST(has(text, "(which error bars do not separate) at " + std::to_string(static_cast<int>(at))),
               text);
    BOOST_TEST(!has(text, "is best:"), text);
  }
}

// The same methods lead, but at other costs.
BOOST_AUTO_TEST_CASE(who_leads_in_seconds_is_said_where_the_order_differs) {
  // The second = scale cost^-4 is less than the first = cost^-2 from the cost sqrt(scale) on.
  const auto best_of = [](const char* first, const char* second, double scale, double unit_of_cost) {
    std::vector<ranked_method> all;
    for (const double cost : {10.0, 20.0, 40.0, 80.0}) {
      all.push_back({first, 0.1, cost * unit_of_cost, std::pow(cost, -2.0), 1e-9});
      all.push_back({second, 0.1, cost * unit_of_cost, std::pow(cost, -4.0) * scale, 1e-9});
    }
    return best_at_costs(all, 1.01);
  };
  const auto a_first = best_of("a", "b", 900.0, 1.0);
  const std::string by_evaluations =
      "Who is best depends on the cost: `a` from 10 to 20, `b` from 40 to 80 evaluations a unit of "
      "time.";
  BOOST_TEST(verdict_of_both(a_first, best_of("b", "a", 900.0, 1e-9)) ==
             by_evaluations +
                 " In seconds: who is best depends on the cost: `b` from 10 to 20, `a` from 40 to 80 ns a "
                 "unit of time.");
  // The same order at other costs is the same verdict.
  BOOST_TEST(verdict_of_both(a_first, best_of("a", "b", 300.0, 1e-9)) == by_evaluations);
}

BOOST_AUTO_TEST_CASE(a_start_up_is_one_evaluation_and_no_more) {
  using costs = std::vector<double>;
  // Runs of 10 steps over the time 10: the first takes one evaluation more; the third is of another kind.
  BOOST_TEST(without_start_up({4.1, 4.0, 7.0}, 1.01, 0.1) == (costs{4.1, 4.1, 7.0}),
             boost::test_tools::per_element());
  BOOST_TEST(without_start_up({4.0, 4.3}, 1.01, 0.1) == (costs{4.0, 4.3}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(what_error_bars_do_not_separate_is_named_together) {
  const auto best_of_two = [](double scale, double bar) {
    return best_at_costs(together({method("a", 1.0, 2.0, bar), method("b", scale, 2.0, bar)}), 1.01);
  };
  // The logarithm of 1.1 is .095: more than two standard errors of .02 sqrt(2) each, less than of .05
  // sqrt(2).
  const auto apart = best_of_two(1.1, 0.02);
  for (const auto& one : apart) BOOST_TEST((names(one) == list{"a"}));
  BOOST_TEST(has(verdict_of(apart, unit), "`a` is best: at 50 to 400 evaluations"));
  const auto alike = best_of_two(1.1, 0.05);
  for (const auto& one : alike) BOOST_TEST((names(one) == list{"a", "b"}));
  BOOST_TEST(verdict_of(alike, unit) ==
             "No method is known to be better than another from 50 to 400 evaluations: error bars do not "
             "separate `a` and `b`.");
  const auto better_than_c =
      best_at_costs(together({method("a", 1.0, 2.0), method("b", 1.0, 2.0), method("c", 2.0, 2.0)}), 1.01);
  for (const auto& one : better_than_c) {
    BOOST_TEST((names(one) == list{"a", "b"}));
    BOOST_TEST(one.next->method == "c");
  }
  BOOST_TEST(verdict_of(better_than_c, unit) ==
             "The best are `a` and `b` from 50 to 400 evaluations: error bars do not separate them.");
  BOOST_TEST(verdict_of(best_at_costs(method("a", 1.0, 2.0), 1.01), unit) ==
             "Only `a` is ranked: there is no other to compare with.");
  const auto without_bars = best_of_two(1.1, not_a_number);
  BOOST_TEST((names(without_bars.front()) == list{"a"}));
  BOOST_TEST(has(verdict_of(without_bars, unit), "differences may be chance"));
  BOOST_TEST(!has(verdict_of(apart, unit), "chance"));
}

// Where the other is ranked only from 200 on, nothing is said of how much better the first is below.
BOOST_AUTO_TEST_CASE(a_lead_is_of_the_costs_at_which_there_is_another) {
  auto all = together({method("a", 1.0, 2.0), method("b", 4530.4, 3.0)});
  for (auto& one : all) {
    if (one.method == "b" && one.cost < 200.0) one.error = not_a_number;
  }
  BOOST_TEST(
      verdict_of(best_at_costs(all, 1.01), unit) ==
      "`a` is best: at 200 to 400 evaluations its error is 1,133 to 2,265 times smaller than that of the "
      "next, `b`; at less, from 50 on, no other is ranked.");
}

// The sentence is of all costs, also of those that a small table leaves out.
BOOST_AUTO_TEST_CASE(a_winner_at_one_cost_between_others_is_not_overlooked) {
  std::vector<ranked_method> once, changing;
  for (int i = 1; i <= 9; ++i) {
    const double cost = 10.0 * i;
    const double error = 1.0 / i;
    once.push_back({"a", 0.1, cost, error, 0.01 * error});
    once.push_back({"b", 0.1, cost, (i == 5 ? 0.5 : 2.0) * error, 0.01 * error});
    const double falling = std::pow(0.1, i);
    changing.push_back({"a", 0.1, cost, (i % 2 == 0 ? 1.0 : 0.5) * falling, 0.01 * falling});
    changing.push_back({"b", 0.1, cost, (i % 2 == 0 ? 0.5 : 1.0) * falling, 0.01 * falling});
  }
  once.push_back({"a", 0.1, 60.0, 0.01, 0.0001});
  BOOST_TEST(verdict_of(best_at_costs(once, 1.01), unit) ==
             "Who is best depends on the cost: `a` from 10 to 40, `b` at 50, `a` from 60 to 90 evaluations.");
  BOOST_TEST(verdict_of(best_at_costs(changing, 1.01), unit) ==
             "Who is best depends on the cost, and changes 8 times: `a` at 10, `a` at 90 evaluations.");
}

// Of the logarithm of the ratio. What trajectories share, here .3, does not hide a difference.
BOOST_AUTO_TEST_CASE(two_standard_errors_separate) {
  for (const bool in_groups : {false, true}) {
    const auto errs_more_by = [&](double standard_errors) {
      // By themselves bars of .02 and .02; of four pairs that differ by +-d the standard error is d/sqrt(3).
      const double bar = 0.02 * std::numbers::sqrt2;
      const double ratio = std::exp(standard_errors * bar);
      const double d = std::sqrt(3.0) * bar;
      ranked_method a{.method = "a", .step = 0.1, .cost = 1.0, .error = 1.0, .standard_error = 0.02};
      ranked_method b{
          .method = "b", .step = 0.1, .cost = 1.0, .error = ratio, .standard_error = 0.02 * ratio};
      if (in_groups) {
        a.groups = {1.3, 1.3, 0.7, 0.7};
        b.groups = {ratio * (1.3 + d), ratio * (1.3 - d), ratio * (0.7 + d), ratio * (0.7 - d)};
        a.standard_error = b.standard_error = 0.3;
      }
      BOOST_TEST(!errs_more(a, b));
      return errs_more(b, a);
    };
    BOOST_TEST(errs_more_by(2.01));
    BOOST_TEST(!errs_more_by(1.99));
  }
}

BOOST_AUTO_TEST_CASE(what_has_no_error_is_left_out) {
  const auto spoilt = [](const char* name, double ranked_method::*field, double by) {
    auto all = method(name, 1e-6, 2.0);  // it would win
    for (auto& one : all) one.*field = by;
    return all;
  };
  const auto failed = spoilt("failed", &ranked_method::error, not_a_number);
  const auto lost = spoilt("lost", &ranked_method::error, std::numeric_limits<double>::infinity());
  const auto untimed = spoilt("untimed", &ranked_method::cost, not_a_number);
  auto all = together({failed, lost, untimed, method("a", 1.0, 2.0), method("b", 2.0, 2.0)});
  for (const auto& one : best_at_costs(all, 1.01)) {
    BOOST_TEST((names(one) == list{"a"}));
    BOOST_TEST(one.next->method == "b");
  }
  const auto none = best_at_costs(together({failed, lost, untimed}), 1.01);
  for (const auto& one : none) BOOST_TEST(one.best.empty());
  BOOST_TEST(has(verdict_of(none, unit), "No method is ranked"));
  BOOST_TEST(has(verdict_of({}, unit), "No method is ranked"));
  all[0].error = 1e-6;  // but where it has one, it counts
  BOOST_TEST((names(best_at_costs(all, 1.01).front()) == list{"failed"}));
}

// Where the others are no better than doing nothing, the one that is has beaten them.
BOOST_AUTO_TEST_CASE(what_is_not_ranked_takes_part) {
  auto all = together({method("a", 1.0, 4.0), method("b", 2.0, 4.0)});
  for (auto& one : all) {
    if (one.cost < (one.method == "a" ? 100.0 : 400.0)) one.error = not_a_number;
  }
  const auto found = best_at_costs(all, 1.01);
  BOOST_TEST_REQUIRE(found.size() == 4U);
  BOOST_TEST(found[0].best.empty());
  for (std::size_t i = 1; i < 4; ++i) BOOST_TEST((names(found[i]) == list{"a"}));
  BOOST_TEST(!found[1].next);
  BOOST_TEST(found[3].next->method == "b");
  BOOST_TEST(
      verdict_of(found, unit) ==
      "`a` is best: at 400 evaluations its error is 2.00 ± 0.06 times smaller than that of the next, `b`; "
      "at less, from 100 on, no other is ranked. None is ranked at 50.");
}

BOOST_AUTO_TEST_CASE(errors_of_zero_are_compared_too) {
  const ranked_method exact{.method = "a", .step = 0.1, .cost = 1.0, .error = 0.0, .standard_error = 0.0};
  ranked_method other{.method = "b", .step = 0.1, .cost = 1.0, .error = 1e-3, .standard_error = 1e-4};
  BOOST_TEST(errs_more(other, exact));
  BOOST_TEST(!errs_more(exact, exact));
  other.standard_error = 1e-3;
  BOOST_TEST(!errs_more(other, exact));
}

BOOST_AUTO_TEST_CASE(costs_are_those_of_the_data) {
  // At 10 only one method can be afforded: that says nothing of the other.
  std::vector<ranked_method> all{{"cheap", 0.1, 10.0, 1.0, 0.01}};
  for (int i = 1; i <= 10; ++i) {
    all.push_back({"cheap", 0.1 / i, 20.0 * i, 1.0 / i, 0.01});
    all.push_back({"good", 0.1 / i, 20.1 * i, 0.5 / i, 0.001});
  }
  const auto found = best_at_costs(all, 1.01);
  BOOST_TEST_REQUIRE(found.size() == 10U);
  BOOST_TEST(found.front().cost == 20.1);
  BOOST_TEST(found.back().cost == 20.1 * 10);
  for (const auto& one : found) BOOST_TEST((names(one) == list{"good"}));
  // Without the tolerance the slightly more expensive one is refused at the costs of the other.
  BOOST_TEST((names(best_at_costs(all, 1.0).front()) == list{"good"}));
  BOOST_TEST(best_at_costs(all, 1.0).size() == 20U - 1U);
}

BOOST_AUTO_TEST_CASE(a_method_is_taken_at_the_step_where_it_errs_least) {
  // Of the smallest step rounding errs more.
  const std::vector<ranked_method> all{{"a", 0.1, 10.0, 1.0, 0.01},    {"a", 0.05, 20.0, 0.1, 0.001},
                                       {"a", 0.025, 40.0, 0.5, 0.005}, {"b", 0.1, 10.0, 2.0, 0.01},
                                       {"b", 0.05, 20.0, 0.3, 0.001},  {"b", 0.025, 40.0, 0.2, 0.001}};
  const auto found = best_at_costs(all, 1.01);
  BOOST_TEST(found.back().best.front().method == "a");
  BOOST_TEST(found.back().best.front().step == 0.05);
}
