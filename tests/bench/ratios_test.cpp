// SPDX-License-Identifier: BSL-1.0
// What ./dev bench concludes from what was measured.
#include <boost/test/unit_test.hpp>

#include "../../bench/ratios/document.hpp"
#include "../../bench/ratios/rows.hpp"
#include "../support/refusal.hpp"
#include "../support/scratch.hpp"

using namespace nysalt::bench;
using namespace nysalt::test;

namespace {

using times = std::map<std::string, samples>;

/// As google-benchmark writes it: an entry a round, and aggregates behind.
nlohmann::json document_of(const times& runners, const std::string& race = "race") {
  nlohmann::json result{{"context", {{"num_cpus", 2}}}, {"benchmarks", nlohmann::json::array()}};
  for (std::size_t round = 0; round < runners.begin()->second.size(); ++round) {
    nlohmann::json entry{{"name", race + "/iterations:1/manual_time"}, {"run_type", "iteration"}};
    for (const auto& [name, all] : runners) entry["ns/" + name] = all[round];
    result["benchmarks"].push_back(entry);
  }
  result["benchmarks"].push_back(
      {{"name", race + "/mean"}, {"run_type", "aggregate"}, {"ns/ours", 1e9}, {"ns/peer", 1.0}});
  return result;
}
measurements read(const nlohmann::json& document) {
  measurements result;
  read_measurements(document, result);
  return result;
}
measurements measured(const times& runners) { return read(document_of(runners)); }

const samples steady(20, 1.0);
samples times_of(double value, double scatter = 0.0) {
  samples result(20, value);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] *= 1.0 + scatter * (static_cast<double>(i) / 19.0 - 0.5);
  }
  return result;
}
row speed_of_ours(double bound) { return {"speed", "race", "ours", {"peer"}, measure::speed, bound}; }
row time_of_ours(double bound) { return {"time", "race", "ours", {"peer"}, measure::time, bound}; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_ratio_holds_or_does_not) {
  const auto all = measured({{"ours", steady}, {"peer", times_of(2.0)}});
  BOOST_TEST((judge(speed_of_ours(1.9), all).said.holds == true));
  BOOST_TEST((judge(speed_of_ours(2.1), all).said.holds == false));
  BOOST_TEST((judge(time_of_ours(0.6), all).said.holds == true));
  BOOST_TEST((judge(time_of_ours(0.4), all).said.holds == false));
  BOOST_TEST(judge(speed_of_ours(1.9), all).found.value == 2.0);
  BOOST_TEST(judge(time_of_ours(0.6), all).found.value == 0.5);
  // The fastest peer counts.
  row of_two = speed_of_ours(2.0);
  of_two.against = {"slow", "quick"};
  const auto j =
      judge(of_two, measured({{"ours", steady}, {"slow", times_of(3.0)}, {"quick", times_of(1.5)}}));
  BOOST_TEST(j.against == "quick");
  BOOST_TEST((j.said.holds == false));
}

BOOST_AUTO_TEST_CASE(pairs_of_a_round_belong_together) {
  // The machine slows down to a third, both slow down alike: the ratio stays 2 in every pair.
  times runners;
  for (int i = 0; i < 20; ++i) {
    runners["ours"].push_back(1.0 + 0.1 * i);
    runners["peer"].push_back(2.0 * runners["ours"].back());
  }
  const auto j = judge(speed_of_ours(1.99), measured(runners));
  BOOST_TEST(j.found.spread == 0.0);
  BOOST_TEST((j.said.holds == true));
}

BOOST_AUTO_TEST_CASE(too_noisy_to_say_is_said_with_a_reason) {
  // 20 values from 1.9 to 2.1 at equal distances; the fifth from either end, 1.942 and 2.058, bound the
  // interval.
  const auto all = measured({{"ours", steady}, {"peer", times_of(2.0, 0.1)}});
  for (const double bound : {1.99, 2.01}) {
    const auto j = judge(speed_of_ours(bound), all);
    BOOST_TEST(!j.said.holds.has_value());
    BOOST_TEST(j.said.reason.find("too noisy") != std::string::npos);
    const auto document = to_json(j);
    BOOST_TEST(document["holds"].is_null());
    BOOST_TEST(document["reason"] == j.said.reason);
  }
  BOOST_TEST((judge(speed_of_ours(1.94), all).said.holds == true));
  BOOST_TEST((judge(speed_of_ours(2.06), all).said.holds == false));
  // From 1 to 3, the quartiles half of the median apart: beyond a spread every pair must agree.
  const auto wide = measured({{"ours", steady}, {"peer", times_of(2.0, 1.0)}});
  BOOST_TEST(judge(speed_of_ours(1.0), wide).found.spread > largest_spread);
  BOOST_TEST((judge(speed_of_ours(0.9), wide).said.holds == true));
  BOOST_TEST((judge(speed_of_ours(3.1), wide).said.holds == false));
  BOOST_TEST(!judge(speed_of_ours(1.2), wide).said.holds.has_value());
}

BOOST_AUTO_TEST_CASE(the_interval_holds_the_median_with_95_percent) {
  samples r;
  for (int i = 1; i <= 41; ++i) r.push_back(i);
  const auto found = paired_ratio(r, samples(41, 1.0));
  BOOST_TEST(found.value == 21.0);
  // From the 14th to the 28th: P(14 <= Binomial(41, 1/2) <= 27) = 0.972; one less on either side is 0.940.
  BOOST_TEST(found.low == 14.0);
  BOOST_TEST(found.high == 28.0);
  BOOST_TEST(paired_ratio({3.0}, {2.0}).low == 1.5);
}

BOOST_AUTO_TEST_CASE(a_machine_that_cannot_show_it_is_no_failure) {
  row r = speed_of_ours(1.8);
  r.premise = premise{"kernel two", "kernel one", 1.9, "not quiet"};
  const auto with_kernel = [&](double gain, double ours) {
    return judge(r, measured({{"peer", times_of(ours)},
                              {"ours", steady},
                              {"kernel one", times_of(gain)},
                              {"kernel two", steady}}))
        .said;
  };
  BOOST_TEST((with_kernel(2.0, 1.5).holds == false));
  BOOST_TEST(!with_kernel(1.5, 1.5).holds.has_value());
  BOOST_TEST(with_kernel(1.5, 1.5).reason.find("not quiet") != std::string::npos);
  BOOST_TEST((with_kernel(1.5, 1.9).holds == true));  // what was reached was reached
}

BOOST_AUTO_TEST_CASE(growth_counts_until_memory_bounds_it) {
  const growth g{"growth", "race", {"1", "10", "100"}, "stream ", 1024.0};
  times all{{"1", times_of(1.0)},
            {"10", times_of(1.2)},
            {"100", times_of(2.0)},
            {"stream 10", times_of(0.5)},
            {"stream 100", times_of(0.9)}};
  const auto judged = [&] { return judge(growth_row(g, measured(all)), measured(all)); };
  BOOST_TEST((judged().said.holds == false));  // nothing to excuse it
  BOOST_TEST(judged().found.value == 2.0);
  all["stream 100"] = times_of(1.1);
  BOOST_TEST((judged().said.holds == true));
  BOOST_TEST(judged().found.value == 1.2);
  BOOST_TEST(judged().row.note == "memory bound from 100 on, where the state takes 100 kB");
  all["stream 10"] = times_of(1.0);
  BOOST_TEST(judged().found.value == 1.0);
}

BOOST_AUTO_TEST_CASE(all_files_of_a_compiler_count) {
  const scratch folder("ratios");
  std::ofstream(folder / "g++.1.json") << document_of({{"ours", {1.0, 2.0}}});
  std::ofstream(folder / "g++.2.json") << document_of({{"ours", {3.0}}});
  std::ofstream(folder / "clang++.1.json") << document_of({{"ours", {4.0}}});
  std::ofstream(folder / "g++.2.log") << "no JSON";
  const auto of = [&](const char* compiler) {
    return read_measurements_of(folder.path(), compiler).of("race", "ours");
  };
  BOOST_TEST((of("g++") == samples{1.0, 2.0, 3.0}));
  BOOST_TEST((of("clang++") == samples{4.0}));
  BOOST_TEST(refuses<std::runtime_error>([&] { of("icc"); }, {"./dev bench"}));
  std::ofstream(folder / "g++.3.json") << "{";
  BOOST_TEST(refuses<std::runtime_error>([&] { of("g++"); }, {"g++.3.json", "JSON"}));
}

BOOST_AUTO_TEST_CASE(the_document_says_all_that_the_table_says) {
  const auto gnu = measured({{"ours", steady}, {"peer", times_of(2.0)}});
  const auto clang = measured({{"ours", steady}, {"peer", times_of(3.0)}});
  const auto j = judge(speed_of_ours(1.9), gnu, &clang);
  const auto document = to_json(j);
  BOOST_TEST(document["name"] == "speed");
  BOOST_TEST(document["value"] == 2.0);
  BOOST_TEST(document["target"] == 1.9);
  BOOST_TEST(document["relation"] == ">=");
  BOOST_TEST(document["holds"] == true);
  BOOST_TEST(!document.contains("reason"));
  BOOST_TEST(document["pairs"] == 20);
  BOOST_TEST(document["clang++"]["value"] == 3.0);
  const std::string line = to_table({j}).csv();
  BOOST_TEST(line.find("speed,>= 1.9,yes,2,2 - 2,3,3 - 3") != std::string::npos, line);
}

BOOST_AUTO_TEST_CASE(what_is_no_measurement_is_refused) {
  const auto refused = [](auto&& action, std::string_view word) {
    return refuses<std::runtime_error>(action, {word});
  };
  BOOST_TEST(refused([] { read(nlohmann::json::array()); }, "no benchmarks"));
  BOOST_TEST(refused([] { measured({{"ours", {0.0}}}); }, "no time"));
  auto missing = document_of({{"ours", steady}, {"peer", steady}});
  missing["benchmarks"][3].erase("ns/peer");
  BOOST_TEST(refused([&] { read(missing); }, "missed a round"));
  auto failed = document_of({{"ours", steady}});
  for (auto& round : failed["benchmarks"]) {
    round["error_occurred"] = true;
    round["error_message"] = "fell over";
  }
  BOOST_TEST(refused([&] { judge(speed_of_ours(1.0), read(failed)); }, "fell over"));
  const auto without_peer = measured({{"ours", steady}});
  BOOST_TEST(refused([&] { judge(speed_of_ours(1.0), without_peer); }, "'peer'"));
}
