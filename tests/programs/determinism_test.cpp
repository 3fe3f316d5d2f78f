// SPDX-License-Identifier: BSL-1.0
// One seed, one result: the number of threads changes no byte, another seed changes the numbers, and nothing
// is tested where it was learned.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../../src/comparison/seeds.hpp"
#include "../support/program.hpp"
#include "../support/without_times.hpp"
#include "nysalt/energy.hpp"
#include "nysalt/ensembles/fpu_law.hpp"

using namespace nysalt::test;

namespace {

/// What ends well on every machine, and runs of which some or all trajectories diverge.
const std::vector<std::string> lines{
    "learn --family nystrom --step 0.03 --trajectories 23",
    "learn --family nystrom --system pendulum --step 0.5 --horizon 10 --trajectories 20",
    "learn --family nystrom --system linear_chain --step 1 --horizon 10 --trajectories 20 --coordinates "
    "modes",
    "run --method srkn6b --step 0.02 --horizon 2 --trajectories 23 --sample-every 7 "
    "--observables stiff_energy,energy,q1,p6",
    "run --method verlet --step 0.05 --horizon 0.15 --trajectories 40",
    "run --method verlet --step 0.05 --horizon 1 --trajectories 23",
    "compare --methods verlet,s_aia2,learned:nystrom --steps 0.02,0.03 --trajectories 23 "
    "--learn-trajectories 7",
    "compare --methods verlet,verlet_2x --steps 0.0405 --horizon 0.44 --trajectories 40 --metric state",
    "compare --system henon_heiles --methods verlet,pefrl --steps 0.3 --horizon 30 --trajectories 20 "
    "--metric energy",
};

std::string printed(const std::string& line) {
  const auto done = run(line + " --json");
  BOOST_TEST((done.code == 0 || done.code == 3), line << ": " << done.err);
  return without_times(done.out);
}

std::size_t diverged(const std::string& line) { return json_of(run(line + " --json"))["diverged"].size(); }

}  // namespace

BOOST_AUTO_TEST_CASE(threads_change_no_byte) {
  for (const auto& line : lines) {
    const auto one = printed(line + " --threads 1");
    BOOST_TEST(one.size() > 500U, line);
    for (const char* threads : {"2", "5"})
      BOOST_TEST((printed(line + " --threads " + threads) == one), line << " --threads " << threads);
  }
}

// Else the test above would not be of them.
BOOST_AUTO_TEST_CASE(some_and_all_of_the_unstable_runs_diverge) {
  BOOST_TEST(diverged(lines[4]) > 0U);
  BOOST_TEST(diverged(lines[4]) < 40U);
  BOOST_TEST(diverged(lines[5]) == 23U);
  const auto errors = json_of(run(lines[7] + " --json"));
  BOOST_TEST(errors["rows"][0]["diverged"] > 0);
  BOOST_TEST(errors["rows"][0]["diverged_at"].size() == errors["rows"][0]["diverged"]);
  BOOST_TEST(errors["rows"][0]["diverged_at"][0]["step"] > 0);
  BOOST_TEST(errors["rows"][0]["diverged"] < 40);
}

BOOST_AUTO_TEST_CASE(files_are_the_same_bytes_by_any_number_of_threads) {
  const scratch folder("determinism");
  const std::string line = " --method bcss3 --step 0.02 --horizon 1 --trajectories 23 --output ";
  for (const char* threads : {"1", "5"}) {
    const std::string with = std::string(" --threads ") + threads;
    BOOST_TEST(run(folder, "run" + line + threads + ".csv" + with).code == 0);
    BOOST_TEST(run(folder, std::string("learn --family nystrom --step 0.03 --trajectories 20 --output ") +
                               threads + ".json" + with)
                   .code == 0);
  }
  BOOST_TEST(contents(folder / "1.csv").size() > 10000U);
  BOOST_TEST((contents(folder / "1.csv") == contents(folder / "5.csv")));
  BOOST_TEST(contents(folder / "1.json").size() > 500U);
  BOOST_TEST(contents(folder / "1.json") == contents(folder / "5.json"));
}

BOOST_AUTO_TEST_CASE(another_seed_gives_other_numbers) {
  using pointer = nlohmann::ordered_json::json_pointer;
  const std::vector<std::pair<std::string, std::vector<const char*>>> numbers{
      {"learn --family nystrom --step 0.03 --trajectories 5",
       {"/parameters/b1", "/parameters/beta1", "/loss", "/held_out_loss", "/energy_range/0"}},
      {lines[3], {"/rows/0/3", "/rows/0/5", "/rows/9/6"}},
      {"compare --methods verlet,learned:nystrom --steps 0.03 --trajectories 5 --learn-trajectories 5",
       {"/rows/0/error", "/rows/1/error", "/fits/0/loss"}}};
  for (const auto& [line, pointers] : numbers) {
    const auto with = [&, &line = line](const char* seed) {
      return json_of(run(line + " --json --seed " + seed));
    };
    const auto one = with("1");
    for (const auto& other : {with("2"), with("2251799813685247")}) {  // 2^51 - 1 is the largest
      for (const char* at : pointers) BOOST_TEST(one.at(pointer(at)) != other.at(pointer(at)), at);
    }
  }
}

// Along an accurate trajectory the energy stays: it tells from which start the data are.
BOOST_AUTO_TEST_CASE(no_test_starts_where_training_did) {
  using nysalt::program::role;
  const nysalt::fpu_chain<3> chain(50.0);
  const nysalt::fpu_law<3> law(chain);
  const auto energy_from = [&](role which) {
    return nysalt::energy<double>(chain, law(nysalt::program::seed_for(which, 1), 0));
  };
  const auto training =
      json_of(run("learn --family nystrom --step 0.02 --trajectories 1 --json"))["energy_range"]
          .get<std::vector<double>>();
  const auto test =
      json_of(run("run --method verlet --step 0.02 --horizon 0.02 --observables energy --json"));
  // Both hold exactly: the range has the start in it, and the first sample is the start.
  BOOST_TEST(training[0] <= energy_from(role::training));
  BOOST_TEST(energy_from(role::training) <= training[1]);
  BOOST_TEST(test["rows"][0][3] == energy_from(role::test));
  BOOST_TEST(training[1] - training[0] < 1e-9);
  for (const auto other : {role::held_out, role::test})
    BOOST_TEST((energy_from(other) < training[0] || energy_from(other) > training[1]));
}
