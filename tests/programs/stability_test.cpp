// SPDX-License-Identifier: BSL-1.0
// Runs below the steps that `stability` calls safe and stable are bounded, and above them they diverge. What
// is known in closed form, and what runs are warned of: cases/stability.txt.
#include <fmt/format.h>
#include <boost/test/unit_test.hpp>

#include <string>

#include "../support/program.hpp"

using namespace nysalt::test;

namespace {

/// Whether all of 8 trajectories of that many steps stayed bounded.
bool is_bounded(const std::string& what, double step, int steps) {
  const auto done =
      run(fmt::format("run {} --step {:.17g} --trajectories 8 --sample-every 100000 --json --horizon {:.17g}",
                      what, step, (steps + 0.5) * step));
  BOOST_TEST((done.code == 0 || done.code == 3), done.err);
  return json_of(done)["diverged"].empty();
}

}  // namespace

// Of the chain the highest mode is at the band's end, and grows by acosh(trace/2) = 0.2 a step there.
BOOST_AUTO_TEST_CASE(runs_just_below_the_limit_are_bounded_and_above_diverge) {
  for (const std::string what :
       {"--system fpu --method verlet", "--system linear_chain --method mclachlan2"}) {
    const auto all = document("stability --step 0.01 " + what);
    const double largest = all["stable_steps"][0][1];
    const double safe = all["safe_step"];
    BOOST_TEST_CONTEXT(what) {
      BOOST_TEST(safe < largest);
      BOOST_TEST(is_bounded(what, safe, 10'000));
      BOOST_TEST(is_bounded(what, 0.99 * largest, 10'000));
      BOOST_TEST(!is_bounded(what, 1.01 * largest, 10'000));
    }
  }
}

// phi^4 declares its band for the usual law of starts; with twice the spread a start has more energy. Above
// the safe step they diverge that the declared band still calls stable.
BOOST_AUTO_TEST_CASE(rare_starts_count) {
  const std::string what = "--system phi4 --spread 2 --method verlet";
  const auto all = document("stability --step 0.3 " + what);
  BOOST_TEST(all["bands"][0]["high"].get<double>() * 0.3 < 2.0);
  BOOST_TEST(all["judgement"]["verdict"] != "good");
  BOOST_TEST(is_bounded(what, all["safe_step"], 2000));
  BOOST_TEST(!is_bounded(what, 0.3, 2000));
}
