// SPDX-License-Identifier: BSL-1.0
// What scripts rely on: keys, their types and order, defaults, rows, and what counts as a step.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "../support/document.hpp"
#include "../support/rounding.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {

std::string kind(const json& value) {
  if (value.is_null()) return "null";
  if (value.is_string()) return "text";
  if (value.is_boolean()) return "flag";
  if (value.is_number_integer()) return "integer";
  if (value.is_number()) return "number";
  return value.is_array() ? "list" : "object";
}

/// "key:kind" for each member, in their order.
std::string shape(const json& object) {
  std::string text;
  for (const auto& [key, value] : object.items()) {
    if (!text.empty()) text += ' ';
    text += key;
    text += ':';
    text += kind(value);
  }
  return text;
}

/// A fit to whole trajectories tells how far it follows them; to one step it does not know.
std::string of_a_fit(const std::string& followed) {
  return "family:text parameters:object standard_errors:object step:number objective:text loss:number "
         "held_out_loss:number one_step_error:number trajectory_error:number followed_steps:" +
         followed + " trajectory_steps:" + followed +
         " samples:integer usable:flag "
         "verdict:text rival:text rival_loss:number rival_loss_noise:number trial:object reason:null "
         "seconds:number data_seconds:number fit_seconds:number "
         "learning_evaluations:integer expected_excess:number excess_share:number "
         "deciding_trajectories:number";
}

/// Both command lines end well and print the same, times aside.
bool same(const std::string& one, const std::string& other) {
  const auto first = run(one + " --json");
  const auto second = run(other + " --json");
  BOOST_TEST(first.code == 0, "nysalt " << one << ": " << first.err);
  BOOST_TEST(second.code == 0, "nysalt " << other << ": " << second.err);
  return without_times(first.out) == without_times(second.out);
}

}  // namespace

BOOST_AUTO_TEST_CASE(list_tells_what_there_is) {
  const auto all = document("list");
  BOOST_TEST(shape(all) == "systems:list methods:list families:list metrics:list");
  for (const auto& system : all["systems"]) {
    BOOST_TEST(shape(system) ==
               "name:text options:text hamiltonian:text starts:text observables:list default_observable:text "
               "letters:text");
    BOOST_TEST(system["default_observable"] == (system["name"] == "fpu" ? "stiff_energy" : "energy"));
  }
  for (const auto& method : all["methods"]) {
    // Their limits depend on the step, and on the system.
    const auto name = method["name"].get<std::string>();
    const bool has_limit =
        !name.starts_with("s_aia") && name != "impulse" && !name.starts_with("phase_fitted_");
    const std::string limit = has_limit ? "number" : "null";
    BOOST_TEST(shape(method) ==
               "name:text letters:text order:integer evaluations_per_step:integer limit_per_evaluation:" +
                   limit + " source:text");
  }
  for (const auto& family : all["families"]) {
    BOOST_TEST(shape(family) ==
               "name:text letters:text order:integer symmetric:flag evaluations_per_step:integer "
               "parameters:list");
    for (const auto& parameter : family["parameters"])
      BOOST_TEST(shape(parameter) == "name:text low:number high:number open:flag");
  }
  for (const auto& metric : all["metrics"]) BOOST_TEST(shape(metric) == "name:text meaning:text");
  const auto names = [&](const char* what) {
    std::string text;
    for (const auto& one : all[what]) text += one["name"].get<std::string>() + ' ';
    return text;
  };
  BOOST_TEST(
      names("systems") ==
      "fpu oscillator linear_chain pendulum henon_heiles kepler lennard_jones lennard_jones_liquid phi4 "
      "phi4_lattice gaussian logistic_regression ");
  BOOST_TEST(
      names("families") ==
      "nystrom aba4 aba5 aba6 bab2 bab3 bab4 bab5 bab6 aba3_free aba4_free aba6_free bab6_free fg_chin "
      "fg4 "
      "fd_chin "
      "r_aba2 r_aba4 r_aba6 "
      "r_fg4 ");
  BOOST_TEST(names("metrics") == "path relative state exchange energy acceptance distribution acf ");
  BOOST_TEST(
      names("methods") ==
      "verlet verlet_aba verlet_2x mclachlan2 mclachlan2v bcss2 bcss2v bcss3 bcss4 predescu3 forest_ruth "
      "pefrl vefrl "
      "omelyan5v omelyan5p mclachlan_atela4 mclachlan5 blanes_moan_s6 srkn6b srkn11b srkn14a "
      "takahashi_imada chin4a chin4a_displaced omelyan_fg4 impulse baoab baoab_2x aboba obabo "
      "takahashi_imada_processed "
      "fg4_processed s_aia2 s_aia3 phase_fitted_chin4a "
      "phase_fitted_omelyan_fg4 phase_fitted_pefrl phase_fitted_vefrl phase_fitted_mclachlan5 "
      "phase_fitted_omelyan5v phase_fitted_srkn6b ");
}

BOOST_AUTO_TEST_CASE(learn_tells_of_the_fit) {
  const auto fit = document("learn --family nystrom --step 0.02 --trajectories 4");
  BOOST_TEST(
      shape(fit) ==
      of_a_fit("integer") +
          " system:text coordinates:text held_out_samples:integer trajectories:integer "
          "reference:text reference_error:number condition:number "
          "flat_directions:list dropped_coordinates:list iterations:integer "
          "starts_tried:integer in_valley:flag guard:text held_by_guard:flag unguarded:null "
          "gaps:list starts:text enough:null energy_range:list seed:integer placement:null output:null");
  BOOST_TEST(shape(fit["parameters"]) == "b1:number beta1:number");
  BOOST_TEST(shape(fit["standard_errors"]) == "b1:number beta1:number");
  BOOST_TEST(fit["samples"] == 800);  // 4 trajectories of 200 steps
  BOOST_TEST(fit["step"] == 0.02);
  BOOST_TEST(fit["seconds"].get<double>() ==
             fit["data_seconds"].get<double>() + fit["fit_seconds"].get<double>());
  const scratch folder("contract_output");
  const auto kept =
      document("learn --family nystrom --step 0.02 --trajectories 4 --output scheme.json", folder);
  BOOST_TEST(kept["output"] == "scheme.json");
}

BOOST_AUTO_TEST_CASE(a_fixed_parameter_stays) {
  const auto fit = document("learn --family nystrom --step 0.02 --trajectories 4 --fix b1=0.5");
  BOOST_TEST(fit["parameters"]["b1"] == 0.5);
  BOOST_TEST(fit["standard_errors"]["b1"] == 0.0);
  BOOST_TEST(fit["standard_errors"]["beta1"] > 0.0);
}

BOOST_AUTO_TEST_CASE(compare_gives_rows) {
  const auto all = document(
      "compare --methods verlet,learned:nystrom --steps 0.02 --trajectories 3 --learn-trajectories 4");
  BOOST_TEST(shape(all) ==
             "system:text starts:text metrics:list horizon:number trajectories:integer equal_cost:flag "
             "seed:integer references:list rows:list rankings:list fits:list warnings:list "
             "peak_memory:integer");
  BOOST_REQUIRE(all["rows"].size() == 2U);
  for (const auto& row : all["rows"]) {
    BOOST_TEST(shape(row) ==
               "metric:text method:text step:number step_size:number evaluations_per_time:number "
               "seconds_per_time:number seconds_per_time_median:number error:number standard_error:number "
               "survivors:integer diverged:integer diverged_at:list stability_margin:number "
               "reference_error:number marks:list "
               "median:number median_standard_error:number quantiles:object deciding:number "
               "enough_trajectories:number");
    BOOST_TEST(shape(row["quantiles"]) == "5 %:number 25 %:number 50 %:number 75 %:number 95 %:number");
  }
  BOOST_REQUIRE(all["fits"].size() == 1U);
  BOOST_TEST(shape(all["fits"][0]) == "method:text " + of_a_fit("null"));
  // The energy needs no reference and has no observable; a lone trajectory has no standard error.
  const auto energy = document("compare --methods verlet --steps 0.02 --trajectories 1 --metric energy");
  BOOST_TEST(energy["metrics"] == json::array({"energy"}));
  BOOST_TEST(energy["references"].empty());
  BOOST_TEST(energy["rows"][0]["reference_error"].is_null());
  BOOST_TEST(energy["rows"][0]["standard_error"].is_null());
}

// What a bath adds: where O was placed, and what laws are compared by.
BOOST_AUTO_TEST_CASE(a_bath_adds_placements_and_statistics) {
  const std::string in_the_bath = " --start law --friction 0.01 --sigma 0.05";
  BOOST_TEST(document("learn --family nystrom --step 0.02 --trajectories 4" + in_the_bath)["placement"] ==
             "symmetric");
  const std::string head =
      "system:text starts:text metrics:list horizon:number trajectories:integer equal_cost:flag seed:integer "
      "references:list rows:list rankings:list fits:list warnings:list peak_memory:integer";
  const auto row_with = [](const std::string& rest) {
    return "metric:text method:text step:number step_size:number evaluations_per_time:number "
           "seconds_per_time:number seconds_per_time_median:number error:number standard_error:number "
           "survivors:integer diverged:integer diverged_at:list stability_margin:number reference_error:null "
           "marks:list floor:number "
           "mean:number mean_standard_error:number "
           "effective_sample_size:number" +
           rest;
  };
  const std::string temperatures = " kinetic_temperature:number half_step_kinetic_temperature:number";
  const std::string line = "compare --methods baoab --steps 0.02 --horizon 2 --trajectories 20 --metric ";
  const auto law = document(line + "distribution" + in_the_bath);
  BOOST_TEST(shape(law) == head + " histogram:object");
  BOOST_TEST(shape(law["histogram"]) == "low:number high:number bins:integer");
  BOOST_TEST(shape(law["rows"][0]) == row_with(temperatures));
  const auto acf = document(line + "acf" + in_the_bath);
  BOOST_TEST(shape(acf) == head + " longest_lag:number");
  BOOST_TEST(shape(acf["rows"][0]) == row_with(""));
  const std::string reference =
      "metric:text step_size:number reference:text error:number null_model:number floor:number mean:number";
  BOOST_TEST(shape(acf["references"][0]) == reference);
  // These starts are of the law, as far as twenty tell: there is no null model.
  const std::string of_law =
      "metric:text step_size:number reference:text error:number null_model:null floor:number mean:number";
  BOOST_TEST(shape(law["references"][0]) == of_law + temperatures);
}

BOOST_AUTO_TEST_CASE(run_gives_samples) {
  const std::string line = "run --method verlet --step 0.01 --horizon 0.02 --observables energy,q1";
  const std::string head =
      "system:text method:text step:number trajectories:integer sample_every:integer starts:text "
      "diverged:list columns:list ";
  const std::string tail = " steps:integer seed:integer evaluations:integer seconds:number warnings:list";
  const auto all = document(line);
  BOOST_TEST(shape(all) == head + "rows:list" + tail);
  BOOST_TEST(all["columns"] == json({"trajectory", "step", "t", "energy", "q1"}));
  BOOST_REQUIRE(all["rows"].size() == 3U);
  for (const auto& row : all["rows"]) BOOST_TEST(row.size() == 5U);
  const scratch folder("contract_run");
  BOOST_TEST(shape(document(line + " --output out.csv", folder)) == head + "output:text" + tail);
  BOOST_TEST(contents(folder / "out.csv").starts_with("trajectory,step,t,energy,q1\n0,0,0,"));
}

BOOST_AUTO_TEST_CASE(stability_gives_windows) {
  const std::string plain =
      "method:text letters:text coefficients:list order:integer evaluations_per_step:integer limit:number "
      "limit_per_evaluation:number windows:list touching:list";
  const auto all = document("stability --method verlet");
  BOOST_TEST(shape(all) == plain);
  BOOST_TEST(all["windows"].dump() == "[[0.0,2.0]]");
  BOOST_TEST(shape(document("stability --family nystrom --parameters 0.5,0.4")) == plain);
  const auto of_system = document("stability --method verlet --system fpu --step 0.05");
  BOOST_TEST(shape(of_system) ==
             plain +
                 " system:text step:number highest_frequency:number highest_z:number "
                 "frequency_source:text declared:number of_law:number along_starts:number starts:integer "
                 "bands:list stable:flag margin:number gaps:list stable_steps:list linear_step:number "
                 "trial:object linearly_stable:flag safe_step:number warnings:list");
  for (const auto& band : of_system["bands"]) {
    BOOST_TEST(shape(band) == "low:number high:number stable:flag margin:number touching:null");
    BOOST_TEST(band["stable"] == (band["high"] <= 2.0 / 0.05));
  }
}

BOOST_AUTO_TEST_CASE(stability_of_words_that_rotate) {
  const auto all = document("stability --method impulse --system fpu --step 0.03");
  BOOST_TEST(
      shape(all) ==
      "method:text letters:text coefficients:list order:integer evaluations_per_step:integer limit:null "
      "limit_per_evaluation:null windows:list touching:list system:text step:number stable:flag "
      "magnification:object resonant_pair:object resonance:object trial:object linearly_stable:flag "
      "safe_step:null warnings:list");
  BOOST_TEST(shape(all["magnification"]) == "mode:number factor:number steps:integer");
  BOOST_TEST(shape(all["resonance"]) == "mode:number multiple:number step:number");
}

BOOST_AUTO_TEST_CASE(without_json_it_is_for_people) {
  for (const char* line : {"list", "learn --family nystrom --step 0.02 --trajectories 2",
                           "stability --method verlet", "run --method verlet --step 0.01 --horizon 0.02",
                           "compare --methods verlet --steps 0.02 --trajectories 2"}) {
    const auto done = run(line);
    BOOST_TEST(done.code == 0, line);
    BOOST_TEST(done.err == "", line);
    BOOST_TEST(done.out.size() > 40U, line);
    BOOST_TEST(json_of(done).is_discarded(), line);
  }
}

BOOST_AUTO_TEST_CASE(defaults_of_learn) {
  const std::string line = "learn --family nystrom --step 0.02";
  BOOST_TEST(same(
      line, line + " --system fpu --pairs 3 --omega 50 --fine-step 1e-4 "
                   "--trajectories 100 --horizon 4 --loss trajectory --effort normal --coordinates energy "
                   "--random-starts 24 --seed 1 --threads 1"));
  const std::string few = line + " --horizon 0.5";
  for (const char* other :
       {"--pairs 2", "--omega 40", "--fine-step 2e-4", "--trajectories 9", "--coordinates modes", "--seed 2",
        "--fix b1=0.5", "--loss state:1", "--effort quick"}) {
    BOOST_TEST(!same(few, few + ' ' + other), other);
  }
}

BOOST_AUTO_TEST_CASE(the_default_family_is_the_best_in_the_mean) {
  const std::string line = "learn --system henon_heiles --step 1 --trajectories 8";
  BOOST_TEST(same(line, line + " --family bab6"));
  BOOST_TEST(!same(line, line + " --family nystrom"));
}

BOOST_AUTO_TEST_CASE(default_horizons_are_those_of_the_runs_from_16_to_200_steps) {
  const std::string learn = "learn --system pendulum --family nystrom --trajectories 8 --step 0.1";
  BOOST_TEST(same(learn, learn + " --horizon 20"));
  BOOST_TEST(!same(learn, learn + " --horizon 10"));
  const std::string compare =
      "compare --system pendulum --methods learned:nystrom --steps 0.1 --trajectories 3 --metric state "
      "--horizon ";
  BOOST_TEST(same(compare + "1", compare + "1 --learn-horizon 1.6"));
  BOOST_TEST(same(compare + "3", compare + "3 --learn-horizon 3"));
  BOOST_TEST(same(compare + "40", compare + "40 --learn-horizon 20"));
  BOOST_TEST(!same(compare + "40", compare + "40 --learn-horizon 40"));
}

// Ten steps, or 0.5 if that is longer.
BOOST_AUTO_TEST_CASE(default_horizons_of_losses_after_some_steps_hold_ten_steps) {
  const std::string learn =
      "learn --loss state:1 --system pendulum --family nystrom --trajectories 8 --step ";
  BOOST_TEST(same(learn + "0.4", learn + "0.4 --horizon 4"));
  BOOST_TEST(!same(learn + "0.4", learn + "0.4 --horizon 0.5"));
  BOOST_TEST(same(learn + "0.02", learn + "0.02 --horizon 0.5"));
  const std::string compare =
      "compare --learn-loss state:1 --system pendulum --methods learned:nystrom --steps 0.4 --horizon 4 "
      "--trajectories 3";
  BOOST_TEST(same(compare, compare + " --learn-horizon 4"));
  BOOST_TEST(!same(compare, compare + " --learn-horizon 0.5"));
}

// Errors of the phase change no energy.
BOOST_AUTO_TEST_CASE(compare_learns_with_the_loss_that_suits_what_is_measured) {
  const auto loss_for = [](const std::string& rest) {
    const auto all = document(
        "compare --system henon_heiles --methods learned:nystrom --steps 0.2 --horizon 2 --trajectories 2 "
        "--learn-trajectories 4 --metric " +
        rest);
    return all["fits"][0]["objective"].get<std::string>();
  };
  for (const char* of_states : {"state", "path:q1", "path:p2", "energy,state"}) {
    BOOST_TEST(loss_for(of_states) == "trajectory", of_states);
  }
  for (const char* of_energies : {"energy", "path", "path:kinetic_energy", "energy,path"}) {
    BOOST_TEST(loss_for(of_energies) == "state:1", of_energies);
  }
  BOOST_TEST(loss_for("state --friction 0.1 --temperature 0.01 --start law") == "state:1");
  BOOST_TEST(loss_for("energy --learn-loss trajectory") == "trajectory");
}

BOOST_AUTO_TEST_CASE(defaults_of_compare) {
  const std::string line = "compare --methods verlet,learned:nystrom --steps 0.02";
  BOOST_TEST(same(
      line, line + " --system fpu --pairs 3 --omega 50 --horizon 0.5 --trajectories 400 --seed 1 "
                   "--metric path --observable stiff_energy "
                   "--learn-trajectories 100 --learn-horizon 0.5 --learn-loss state:1 --learn-effort normal "
                   "--coordinates qp --threads 1"));
  const std::string few = line + " --trajectories 3 --learn-trajectories 8";
  for (const char* other : {"--horizon 0.4", "--metric exchange", "--observable energy", "--seed 2",
                            "--learn-horizon 0.4", "--coordinates modes", "--equal-cost"}) {
    BOOST_TEST(!same(few, few + ' ' + other), other);
  }
}

BOOST_AUTO_TEST_CASE(defaults_of_run) {
  const std::string line = "run --method verlet --step 0.02 --horizon 0.2";
  BOOST_TEST(same(line, line +
                            " --system fpu --pairs 3 --omega 50 --trajectories 1 --observables stiff_energy "
                            "--sample-every 1 --seed 1 --threads 1"));
  for (const char* other :
       {"--trajectories 2", "--observables energy", "--sample-every 2", "--seed 2", "--omega 40"}) {
    BOOST_TEST(!same(line, line + ' ' + other), other);
  }
}

// step/ceil(step omega/5e-3), also where omega times the step is no multiple of 5e-3.
BOOST_AUTO_TEST_CASE(the_default_fine_step_divides_the_step) {
  for (const double omega : {50.0, 33.0, 33.3, 1.0}) {
    const auto fit = document(
        fmt::format("learn --family nystrom --step 0.01 --trajectories 20 --horizon 0.1 --omega {}", omega));
    const double fine = 0.01 / std::ceil(0.01 * omega / 5e-3);
    BOOST_TEST(fit["reference"] == fmt::format("srkn11b with step {:.12g}", fine));
  }
}

BOOST_AUTO_TEST_CASE(a_row_has_the_method_as_typed_and_the_nominal_step) {
  const scratch folder("contract_rows");
  document("learn --family nystrom --step 0.02 --trajectories 4 --output scheme.json", folder);
  const auto all = document(
      "compare --methods verlet,./scheme.json,s_aia2,learned:nystrom,scheme.json --steps 0.01,2e-2 "
      "--trajectories 3 --learn-trajectories 4",
      folder);
  std::vector<std::pair<std::string, double>> rows;
  for (const auto& row : all["rows"]) {
    rows.emplace_back(row["method"], row["step"]);
    BOOST_TEST(row["step_size"] == row["step"]);
  }
  const std::vector<std::pair<std::string, double>> expected{
      {"verlet", .01},        {"s_aia2", .01}, {"learned:nystrom", .01}, {"verlet", .02},
      {"./scheme.json", .02}, {"s_aia2", .02}, {"learned:nystrom", .02}, {"scheme.json", .02}};
  BOOST_TEST(rows == expected);
  BOOST_REQUIRE(all["rows"].size() == 8U);
  BOOST_TEST(all["rows"][4]["error"] == all["rows"][7]["error"]);
  BOOST_REQUIRE(all["fits"].size() == 2U);
  for (const auto& fit : all["fits"]) BOOST_TEST(fit["method"] == "learned:nystrom");
}

BOOST_AUTO_TEST_CASE(equal_cost_takes_steps_of_an_evaluation) {
  const scratch folder("contract_cost");
  document("learn --family nystrom --step 0.02 --trajectories 4 --output scheme.json", folder);
  const auto all = document(
      "compare --methods "
      "verlet,verlet_aba,verlet_2x,mclachlan2,bcss3,s_aia2,srkn6b,learned:nystrom,scheme.json "
      "--steps 0.01,0.005 --equal-cost --metric energy --horizon 1 --trajectories 2 --learn-trajectories 4",
      folder);
  const std::vector<int> evaluations{1, 1, 2, 2, 3, 2, 6, 2, 2};
  BOOST_REQUIRE(all["rows"].size() == 9U + 8U);  // the scheme is for 0.02 = 2 * 0.01 alone
  for (std::size_t i = 0; i < all["rows"].size(); ++i) {
    const auto& row = all["rows"][i];
    const double nominal = i < 9 ? 0.01 : 0.005;
    const double step = nominal * evaluations[i % 9];
    BOOST_TEST_CONTEXT(row["method"] << " at " << nominal) {
      BOOST_TEST(row["step"] == nominal);
      BOOST_TEST(row["step_size"] == step);
      // 1/nominal, and one to start with for those that begin with a kick, over the time that they reach.
      const double time = step * std::floor(1.0 / step + 1e-9);
      const double cost = row["evaluations_per_time"];
      const bool kicks = row["method"] == "verlet" || row["method"] == "verlet_2x" ||
                         row["method"] == "bcss3" || row["method"] == "srkn6b";
      BOOST_TEST(cost == 1.0 / nominal + (kicks ? 1.0 / time : 0.0), boost::test_tools::tolerance(8 * eps));
    }
  }
}

BOOST_AUTO_TEST_CASE(steps_are_those_within_the_horizon) {
  const std::vector<std::pair<std::string, std::int64_t>> known{{"0.3", 3},  // 0.3/0.1 is 2.9999999999999996
                                                                {"0.29", 2},
                                                                {"0.1", 1},
                                                                {"0.39999999", 3},
                                                                {"1", 10}};
  for (const auto& [horizon, steps] : known) {
    BOOST_TEST_CONTEXT("horizon " << horizon) {
      const auto all = document("run --system pendulum --method verlet --step 0.1 --horizon " + horizon);
      BOOST_TEST(all["steps"] == steps);
      BOOST_TEST(all["evaluations"] == steps + 1);  // Verlet takes one to start with
      BOOST_REQUIRE(all["rows"].size() == static_cast<std::size_t>(steps) + 1);
      for (std::int64_t n = 0; n <= steps; ++n) {
        const auto& row = all["rows"][static_cast<std::size_t>(n)];
        BOOST_TEST(row[1] == n);
        BOOST_TEST(row[2] == static_cast<double>(n) * 0.1);
      }
      const auto errors = document(
          "compare --system pendulum --methods verlet --steps 0.1 --metric acceptance --trajectories 1 "
          "--horizon " +
          horizon);
      const double cost = errors["rows"][0]["evaluations_per_time"];
      BOOST_TEST(cost * 0.1 * static_cast<double>(steps) == static_cast<double>(steps + 1),
                 boost::test_tools::tolerance(8 * eps));
    }
  }
  const auto fit = json_of(
      run("learn --family nystrom --system pendulum --step 0.1 --horizon 0.3 --trajectories 2 --json"));
  BOOST_TEST(fit["samples"] == 2 * 3);  // usable or not
}

BOOST_AUTO_TEST_CASE(samples_are_taken_every_so_many_steps) {
  const auto all = document(
      "run --system pendulum --method bcss3 --step 0.1 --horizon 1 --sample-every 4 --trajectories 2");
  std::vector<std::pair<std::int64_t, std::int64_t>> seen;
  for (const auto& row : all["rows"]) seen.emplace_back(row[0], row[1]);
  const std::vector<std::pair<std::int64_t, std::int64_t>> expected{{0, 0}, {0, 4}, {0, 8},
                                                                    {1, 0}, {1, 4}, {1, 8}};
  BOOST_TEST(seen == expected);
  BOOST_TEST(all["evaluations"] == 3 * 10 + 1);
}

BOOST_AUTO_TEST_CASE(alone_it_shows_three_commands) {
  const auto done = run("");
  BOOST_TEST(done.code == 0);
  BOOST_TEST(done.err == "");
  std::size_t shown = 0;
  for (auto at = done.out.find("\n  nysalt "); at != std::string::npos;
       at = done.out.find("\n  nysalt ", at + 1))
    ++shown;
  BOOST_TEST(shown == 3U);
}

BOOST_AUTO_TEST_CASE(the_program_tells_its_version) {
  const auto done = run("--version");
  BOOST_TEST(done.code == 0);
  BOOST_REQUIRE(done.out.starts_with("nysalt "));
  const std::string version = done.out.substr(7, done.out.find('\n') - 7);
  const auto header = contents(std::string(NYSALT_SOURCE_DIR) + "/include/nysalt/version.hpp");
  BOOST_TEST(header.find("version = \"" + version + "\";") != std::string::npos, version);
}

// More than a pipe holds (64 kB), so that the program still writes when the reader is gone.
BOOST_AUTO_TEST_CASE(a_reader_who_goes_away_is_no_trouble) {
  const scratch folder("contract_head");
  for (const char* line : {"list", "learn --family nystrom --step 0.02 --trajectories 2 --json",
                           "run --method verlet --step 0.001 --horizon 10",
                           "run --method verlet --step 0.001 --horizon 10 --json"}) {
    const auto done = shell(folder, std::string("\"$nysalt\" ") + line + " | head -n 1");
    BOOST_TEST(done.code == 0, line);
    BOOST_TEST(done.err == "", line);
    BOOST_TEST(std::count(done.out.begin(), done.out.end(), '\n') == 1, line);
  }
}
