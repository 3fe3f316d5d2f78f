// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 15 s at -O0, 2.5 s at -O1.
// Comparisons, recommendations and pages of systems that callers of the library bring.
#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "../support/refusal.hpp"
#include "../support/scratch.hpp"
#include "nysalt/compare.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/recommend.hpp"

using namespace nysalt;

namespace {

/// Two bonds of a Morse potential in a row, one mass at rest: V = sum (1 - exp(-r))^2.
struct morse_pair {
  static constexpr int dimension = 2;
  double sign = 1.0;  // -1: a force that is not -grad V
  double depth = 1.0;

  template <class T>
  T potential(const vector<T, 2>& q) const {
    using std::exp;
    const T a = 1.0 - exp(-q[0]);
    const T b = 1.0 - exp(q[0] - q[1]);
    return (a * a + b * b) * depth;
  }
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    using std::exp;
    const T a = 2.0 * (1.0 - exp(-q[0])) * exp(-q[0]);
    const T b = 2.0 * (1.0 - exp(q[0] - q[1])) * exp(q[0] - q[1]);
    f[0] = (b - a) * (sign * depth);
    f[1] = -b * (sign * depth);
  }
};

initial_value_problem morse(double sign = 1.0, double depth = 1.0) {
  const vector<double, 2> rest(0.0, 0.0);
  return {.system = morse_pair{sign, depth}, .starts = normal_around<2>({rest, rest}, 0.1, 0.2)};
}

comparison_options quick() {
  return {.methods = {"verlet", "pefrl", "learned:nystrom"},
          .steps = {0.1, 0.2},
          .equal_cost = true,
          .horizon = 8.0,  // ten steps of four evaluations, as means over time take
          .trajectories = 8,
          .metrics = {"state", "energy"},
          .learning = {.trajectories = 8, .horizon = 4.0}};
}

/// What the refusal of a comparison says.
std::string refused(const initial_value_problem& problem, const auto& change) {
  auto options = quick();
  change(options);
  try {
    compare(problem, options);
  } catch (const std::invalid_argument& told) {
    return told.what();
  }
  return {};
}

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(every_method_has_a_row_at_every_step_by_every_metric) {
  const auto found = compare(morse(), quick());
  BOOST_TEST(found.rows().size() == 12U);
  for (const auto& row : found.rows()) {
    BOOST_TEST_CONTEXT(row.method << " at " << row.step << " by " << row.metric) {
      BOOST_TEST(row.reason == "");
      BOOST_TEST(row.value.mean > 0.0);
      BOOST_TEST(row.value.standard_error > 0.0);
      BOOST_TEST(row.seconds_per_time > 0.0);
      // Of equal cost: 1/step evaluations, and one more for the start of 8 units of time.
      const double nominal = row.evaluations_per_time > 7.5 ? 0.1 : 0.2;
      BOOST_TEST(std::abs(row.evaluations_per_time - 1.0 / nominal) <= 0.125 + 1e-9);
      BOOST_TEST(row.is_learned == row.method.starts_with("learned:"));
    }
  }
  const auto first_with = [](std::uint64_t seed) {
    auto classical = quick();
    classical.methods = {"verlet"};
    classical.steps = {0.2};
    return compare(morse(), classical, {.seed = seed}).rows().front().value.mean;
  };
  BOOST_TEST(first_with(1) == first_with(1));
  BOOST_TEST(first_with(1) != first_with(2));
  BOOST_TEST(has(found.text(), "learned:nystrom"));
  BOOST_TEST(has(found.json(), "\"rows\""));
}

BOOST_AUTO_TEST_CASE(a_report_is_a_folder_with_a_page) {
  const test::scratch folder("own_system_report");
  auto options = quick();
  options.steps = {0.2};
  options.methods = {"verlet", "pefrl"};
  report(morse(), options, folder / "page");
  for (const char* file : {"report.html", "report.json", "rows.csv"}) {
    BOOST_TEST(std::filesystem::file_size(folder / "page" / file) > 100U);
  }
  BOOST_TEST(!has(test::contents(folder / "page" / "report.json"), "provenance"));  // no command made it
  BOOST_TEST(test::contents(folder / "page" / "rows.csv").starts_with("metric,"));
}

BOOST_AUTO_TEST_CASE(a_report_that_was_interrupted_goes_on) {
  const test::scratch folder("own_system_work");
  const auto page = folder / "page";
  auto options = quick();
  options.steps = {0.2};
  options.methods = {"verlet"};
  std::vector<std::string> parts;
  bool stops = true;
  const common_options told{.progress_of_parts = [&](const std::string& part, double share) {
    BOOST_TEST((0.0 <= share && share <= 1.0));
    if (parts.empty() || parts.back() != part) parts.push_back(part);
    if (stops && part.starts_with("energies of")) throw std::runtime_error("stopped");
  }};
  const auto has_compared = [&] {
    return std::ranges::any_of(parts, [](const auto& part) { return part.starts_with("comparing"); });
  };
  BOOST_CHECK_THROW(report(morse(), options, page, told), std::runtime_error);
  BOOST_TEST(has_compared());
  BOOST_TEST(std::filesystem::file_size(page / "report.work") > 100U);
  auto others = options;
  others.trajectories = 9;
  BOOST_TEST(test::refuses<std::invalid_argument>([&] { report(morse(), others, page); },
                                                  {"another question (trajectories)"}));
  BOOST_TEST(test::refuses<std::invalid_argument>([&] { report(morse(1.0, 1.1), options, page); },
                                                  {"another question (seen_at_starts)"}));
  stops = false;
  parts.clear();
  const auto resumed = report(morse(), options, page, told).rows();
  BOOST_TEST(!has_compared());  // it is in the work file
  BOOST_TEST(!std::filesystem::exists(page / "report.work"));
  BOOST_TEST(std::filesystem::exists(page / "report.html"));
  const auto whole = compare(morse(), options).rows();
  BOOST_REQUIRE(whole.size() == resumed.size());
  for (std::size_t n = 0; n < whole.size(); ++n) BOOST_TEST(whole[n].value.mean == resumed[n].value.mean);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_in_terms_of_the_options) {
  BOOST_TEST(has(refused(morse(-1.0), [](auto&) {}), "force"));
  using change = void (*)(comparison_options&);
  for (const auto& [changed, words] : std::vector<std::pair<change, std::string>>{
           {[](auto& o) { o.methods = {"verlett"}; }, "verlett"},
           {[](auto& o) { o.steps = {-0.1}; }, "steps must be"},
           {[](auto& o) { o.learning.trajectories = 0; }, "learning.trajectories must be"},
           {[](auto& o) { o.metrics = {"exchange"}; }, "exchange"},
           {[](auto& o) { o.metrics = {}; }, "metrics must be"},
           {[](auto& o) { o.steps = {}; }, "steps"},
           {[](auto& o) { o.horizon = 0.01; }, "horizon"},
           {[](auto& o) { o.levels = {0.0}; }, "levels"}}) {
    const auto text = refused(morse(), changed);
    BOOST_TEST(has(text, words), text);
    BOOST_TEST(!has(text, "--"), text);
  }
  BOOST_TEST(test::refuses<std::invalid_argument>(
      [] { compare(morse(), quick(), {.execution = {.threads = 0}}); }, {"threads must be"}));
}

BOOST_AUTO_TEST_CASE(a_recommendation_names_a_method_and_its_step) {
  const auto found = recommend(morse(), {.budget = 10.0,
                                         .horizon = 4.0,
                                         .trajectories = 16,
                                         .families = {"nystrom"},
                                         .learning = {.trajectories = 8, .horizon = 4.0}});
  BOOST_TEST(found.has_result());
  BOOST_TEST(found.method() != "");
  // A budget of 10 evaluations: a word of s evaluations takes steps of s/10.
  BOOST_TEST(std::abs(10.0 * found.step() - std::round(10.0 * found.step())) < 1e-9);
  BOOST_TEST(has(found.text(), found.method()));
  // The winner is available as a method file, which compare() accepts.
  const auto file = found.method_file();
  BOOST_TEST_REQUIRE(file.has_value());
  BOOST_TEST((file->find("nysalt scheme") != std::string::npos) == (found.verdict() == "learned"));
  const auto rows = compare(morse(), {.methods = {"best.json"},
                                      .steps = {found.step()},
                                      .horizon = 12.0 * found.step(),
                                      .trajectories = 4,
                                      .metrics = {"state"},
                                      .held = {{"best.json", *file}}})
                        .rows();
  BOOST_TEST(rows.front().reason == "");
  BOOST_TEST(test::refuses<std::invalid_argument>([] { recommend(morse(), {.horizon = 4.0}); },
                                                  {"one of budget (", "budget_seconds (", "error ("}));
}
