// SPDX-License-Identifier: BSL-1.0
// Hybrid Monte Carlo in the program: what it draws, what it tells, what it refuses, and learning from its
// draws.
#include <boost/test/unit_test.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "../support/bad_input.hpp"
#include "../support/document.hpp"
#include "../support/program.hpp"

using namespace nysalt::test;
using json = nlohmann::ordered_json;

namespace {
const std::string gaussian = "sample --system linear_chain --masses 3 --spring 4 --method bcss3 --length 1 ";
}  // namespace

// Springs k between walls: V = k/2 q.(2 on the diagonal, -1 beside it).q, so that <q_2^2> = kT (1/k).
BOOST_AUTO_TEST_CASE(draws_have_the_law_and_chains_agree) {
  const scratch folder("sample");
  const json found = json_of(run(folder, gaussian + "--draws 2000 --json --output draws.csv"));
  BOOST_TEST(found["converged"] == true);
  BOOST_TEST(std::abs(found["acceptance"].get<double>() - 0.9) < 0.1);
  BOOST_TEST(found["diverged"] == 0);
  const json& scalars = found["scalars"];
  BOOST_TEST_REQUIRE(scalars.size() == 4U);
  const double mean = scalars[0]["mean"];
  // <V> = 3 kT/2, by equipartition; 4 standard errors.
  BOOST_TEST(std::abs(mean - 1.5) <= 4.0 * scalars[0]["standard_error"].get<double>());
  const double deviation = scalars[2]["deviation"];
  BOOST_TEST(std::abs(deviation * deviation - 0.25) < 0.02);
  const std::string draws = contents(folder / "draws.csv");
  BOOST_TEST(draws.starts_with("chain,draw,potential,q1,q2,q3\n0,0,"));
  BOOST_TEST(std::count(draws.begin(), draws.end(), '\n') == 1 + 4 * 2000);
  BOOST_TEST(contents(folder / "draws.csv.manifest.json").find("sample") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(threads_change_no_byte) {
  const scratch folder("sample_threads");
  const auto of_threads = [&](int threads) {
    const std::string file = fmt::format("{}.csv", threads);
    const auto done =
        run(folder, gaussian + fmt::format("--chains 40 --draws 20 --threads {} --output {}", threads, file));
    BOOST_TEST_REQUIRE(done.code == 0, done.err);
    return contents(folder / file);
  };
  BOOST_TEST(of_threads(1) == of_threads(3));
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_is_learned_from_draws_for_sampling_alone) {
  const scratch folder("sample_learn");
  const std::string lattice = "--system phi4_lattice --side 4 --coupling 4 ";
  const auto drawn =
      run(folder, "sample " + lattice + "--length 0.5 --chains 16 --draws 20 --output draws.csv");
  BOOST_TEST_REQUIRE(drawn.code == 0, drawn.err);
  const std::string learn =
      "learn " + lattice + "--start draws.csv --family fd_chin --step 0.2 --horizon 1 --effort quick ";
  const json fit = json_of(run(folder, learn + "--loss acceptance --json"));
  BOOST_TEST(fit["usable"] == true);
  BOOST_TEST(fit["held_out_loss"].get<double>() < fit["rival_loss"].get<double>());
  all_refused(folder, {{learn, {"it is for sampling"}}});
}

BOOST_AUTO_TEST_CASE(what_cannot_be_sampled_is_one_line) {
  const scratch folder("sample_bad");
  std::ofstream(folder / "positions.csv") << "q1\n0.5\nx\n";
  all_refused(
      folder,
      after("sample",
            {
                {"--system pendulum", {"--length"}},
                {"--system pendulum --length 1 --method aba3_free", {"unknown method"}},
                {"--system pendulum --length 1 --method learned:fg4", {"must be learned first"}},
                {"--system pendulum --length 0", {"--length must be"}},
                {"--system pendulum --length 1 --chains 0", {"--chains must be"}},
                {"--system pendulum --length 1 --acceptance 1.2", {"acceptance must be between 0 and 1"}},
                {"--system pendulum --length 1 --friction 1 --temperature 1", {"leave the bath away"}},
                {"--system pendulum --length 1 --step 0.1 --acceptance 0.9 --burn-in 3",
                 {"burn_in must be at least 100"}},
                {"--system pendulum --length 1 --draws 100000000", {"would not fit into memory"}},
                {"--system pendulum --length 1 --start positions.csv", {"line 3"}},
                {"--system henon_heiles --length 1 --start positions.csv", {"q2 is not there"}},
                {"--system pendulum --length 1 --start missing.csv", {"cannot be read"}},
                {"--system pendulum --length 1 --start positions.csv --spread 2", {"--spread"}},
            }));
}
