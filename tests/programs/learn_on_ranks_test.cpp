// SPDX-License-Identifier: BSL-1.0
// `mpirun -n N nysalt learn` learns what one process does, to the last bit, and speaks with one voice.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <string>

#include "../support/mpirun.hpp"
#include "../support/without_times.hpp"

using namespace nysalt::test;

namespace {

/// Data for twenty leaves and a bit, and what is told of them.
const std::string common = " --fine-step 0.00025 --horizon 0.3 --trajectories 330 --json ";

std::int64_t count(const std::string& text, const std::string& part) {
  std::int64_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

struct outcome {
  std::string told;
  std::string scheme;
  bool operator==(const outcome&) const = default;
};

/// Of one process where there are no ranks.
outcome learned(int ranks, const std::string& arguments) {
  const scratch folder("learn_on_ranks");
  const std::string all = "learn --family nystrom --output scheme.json " + arguments;
  const finished done = ranks == 0 ? run(folder, all) : run_on(ranks, folder, all);
  BOOST_TEST_REQUIRE(done.code == 0, done.err);
  BOOST_TEST(done.err == "");
  BOOST_TEST(!json_of(done).is_discarded());  // one document, not one a rank
  return {without_times(done.out), without_times(contents(folder / "scheme.json"))};
}

}  // namespace

BOOST_AUTO_TEST_CASE(of_errors_only_those_of_the_launcher_are_left_out) {
  const std::string launcher =
      "[hwloc/linux] failed to find sysfs cpu topology directory\n*****\n* hwloc has found\n*****\n";
  BOOST_TEST(without_launcher(launcher) == "");
  BOOST_TEST(without_launcher(launcher + "nysalt: no\n" + launcher) == "nysalt: no\n");
}

BOOST_AUTO_TEST_CASE(ranks_and_threads_change_no_bit_of_what_is_learned) {
  for (const std::string& system :
       {std::string("--system fpu --step 0.03"),
        std::string("--system fpu --step 0.03 --friction 1 --temperature 1 --start law")}) {
    const std::string arguments = system + common;
    const outcome expected = learned(0, arguments + "--threads 1");
    BOOST_TEST(learned(0, arguments + "--seed 2").scheme != expected.scheme);  // so the test can tell
    for (const int ranks : {1, 2, 3}) {
      for (const char* threads : {"1", "2"}) {
        BOOST_TEST_CONTEXT(system << " on " << ranks << " ranks of " << threads << " threads") {
          const outcome found = learned(ranks, arguments + "--threads " + threads);
          BOOST_TEST(found.told == expected.told);
          BOOST_TEST(found.scheme == expected.scheme);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(data_that_grow_until_they_are_enough_are_shared_too) {
  const std::string arguments = "--step 0.03 --fine-step 0.001 --horizon 0.3 --enough 5e-5 --json";
  BOOST_TEST((learned(3, arguments) == learned(0, arguments)));
}

BOOST_AUTO_TEST_CASE(bad_input_is_told_once) {
  const scratch folder("learn_on_ranks");
  for (const std::string& arguments :
       {std::string("learn --family nystrom --step -1"),
        std::string("learn --family nystrom --step 0.03 --output missing/scheme.json"),
        std::string("learn --stepp 1"), std::string("learn --step 0.03 --horizon 0.01")}) {
    const finished alone = run(folder, arguments);
    const finished together = run_on(3, folder, arguments);
    BOOST_TEST_CONTEXT(arguments << ": " << together.err) {
      BOOST_TEST(alone.code == 2);
      BOOST_TEST(together.code == 2);
      BOOST_TEST(count(together.err, "nysalt: ") == 1);
      BOOST_TEST(together.err.find(alone.err) != std::string::npos);
      BOOST_TEST(together.out == "");
    }
  }
}
