// SPDX-License-Identifier: BSL-1.0
// One seed, one noise: in a bath too, the number of threads changes no byte, and another seed changes them.
#include <boost/test/unit_test.hpp>

#include <string>
#include <vector>

#include "../support/program.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

const std::string fpu = " --friction 0.01 --sigma 0.05 ";
const std::string pendulum = " --system pendulum --friction 0.5 --temperature 0.3 ";

/// Each command and metric, starts of all kinds, lanes that are full and not, runs that diverge.
const std::vector<std::string> lines{
    "learn --family nystrom --step 0.03 --trajectories 23 --start law" + fpu,
    "learn --family nystrom --step 0.2 --horizon 2 --trajectories 37 --placement end" + pendulum,
    "learn --family nystrom --step 0.2 --horizon 2 --trajectories 37 --start trajectory" + pendulum,
    "run --method obabo --step 0.02 --horizon 2 --trajectories 23 --sample-every 7" + fpu,
    "run --method bcss3@middle --step 0.2 --horizon 20 --trajectories 3" + pendulum,
    "run --method baoab --step 0.05 --horizon 0.15 --trajectories 40 --start law --friction 1 --temperature "
    "0.1",
    "compare --methods baoab,verlet@symmetric,learned:nystrom@end --steps 0.2,0.3 --horizon 2 "
    "--trajectories 23 --learn-trajectories 37 --learn-horizon 2" +
        pendulum,
    "compare --methods baoab,learned:nystrom --steps 0.2,0.3 --horizon 5 --trajectories 70 "
    "--learn-trajectories 37 --learn-horizon 2 --metric distribution" +
        pendulum,
    "compare --methods baoab,verlet@end --steps 0.2,0.3 --horizon 5 --trajectories 70 --metric acf" +
        pendulum,
};

std::string printed(const std::string& line) {
  const auto done = run(line + " --json");
  BOOST_TEST((done.code == 0 || done.code == 3), line << ": " << done.err);
  return without_times(done.out);
}

}  // namespace

BOOST_AUTO_TEST_CASE(threads_change_no_byte) {
  for (const auto& line : lines) {
    const auto one = printed(line + " --threads 1");
    BOOST_TEST(one.size() > 500U, line);
    BOOST_TEST((printed(line + " --threads 2") == one), line);
  }
}

// Else the test above would not be of them.
BOOST_AUTO_TEST_CASE(some_of_the_unstable_runs_diverge) {
  const auto diverged = json_of(run(lines[5] + " --json"))["diverged"].size();
  BOOST_TEST(diverged > 0U);
  BOOST_TEST(diverged < 40U);
}

BOOST_AUTO_TEST_CASE(files_are_the_same_bytes_by_any_number_of_threads) {
  const scratch folder("langevin_determinism");
  for (const std::string& threads : {std::string("1"), std::string("5")}) {
    const std::string to = " --threads " + threads + " --output " + threads;
    BOOST_TEST(
        run(folder, "run --method obabo --step 0.2 --horizon 20 --trajectories 23" + pendulum + to + ".csv")
            .code == 0);
    BOOST_TEST(
        run(folder, "learn --family nystrom --step 0.2 --horizon 2 --force" + pendulum + to + ".json").code !=
        2);
  }
  BOOST_TEST(contents(folder / "1.csv").size() > 10000U);
  BOOST_TEST((contents(folder / "1.csv") == contents(folder / "5.csv")));
  BOOST_TEST(contents(folder / "1.json").size() > 500U);
  BOOST_TEST(contents(folder / "1.json") == contents(folder / "5.json"));
}

// A trajectory has its number's start and noise, whichever trajectories run beside it.
BOOST_AUTO_TEST_CASE(more_trajectories_leave_the_first_as_they_are) {
  const auto csv = [](const std::string& trajectories) {
    return run("run --method obabo --step 0.2 --horizon 4 --trajectories " + trajectories + pendulum).out;
  };
  const auto few = csv("2");
  BOOST_TEST(few.size() > 1000U);
  BOOST_TEST(csv("40").starts_with(few));
  BOOST_TEST(few.starts_with(csv("1")));
}

BOOST_AUTO_TEST_CASE(another_seed_gives_other_numbers) {
  using pointer = nlohmann::ordered_json::json_pointer;
  const std::vector<std::pair<std::string, std::vector<const char*>>> numbers{
      {lines[1], {"/parameters/b1", "/parameters/beta1", "/loss", "/held_out_loss", "/energy_range/0"}},
      {lines[4], {"/rows/0/3", "/rows/5/3"}},
      {lines[6], {"/rows/0/error", "/rows/2/error", "/references/0/error", "/fits/0/loss"}},
      {lines[7], {"/rows/0/error", "/rows/0/floor", "/rows/0/kinetic_temperature", "/references/0/mean"}},
      {lines[8], {"/rows/0/error", "/rows/0/standard_error", "/rows/0/floor"}}};
  for (const auto& [line, pointers] : numbers) {
    const auto with = [&, &line = line](const char* seed) {
      return json_of(run(line + " --json --seed " + seed));
    };
    const auto one = with("1");
    const auto other = with("2");
    for (const char* at : pointers) BOOST_TEST(one.at(pointer(at)) != other.at(pointer(at)), line << at);
  }
}

BOOST_AUTO_TEST_CASE(noise_alone_parts_paths_of_one_start) {
  const auto at_end = [](const std::string& bath) {
    const auto all =
        json_of(run("run --system pendulum --start law --method baoab --step 0.2 --horizon 4 --json "
                    "--observables q1 --sample-every 20" +
                    bath));
    return std::pair{all["rows"][0][3].get<double>(), all["rows"][1][3].get<double>()};
  };
  const auto quiet = at_end(" --friction 0.5 --temperature 0");
  const auto noisy = at_end(" --friction 0.5 --temperature 0.3");
  BOOST_TEST(quiet.first == noisy.first);
  BOOST_TEST(quiet.second != noisy.second);
}
