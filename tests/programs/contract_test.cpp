// SPDX-License-Identifier: BSL-1.0
// What scripts rely on.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/program.hpp"
#include "../support/rounding.hpp"
#include "../support/table.hpp"

using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(contract) { run_table("contract"); }

BOOST_AUTO_TEST_CASE(equal_cost_takes_steps_of_an_evaluation) {
  const scratch folder("contract_cost");
  std::filesystem::copy_file(NYSALT_SOURCE_DIR "/tests/programs/inputs/scheme.json", folder / "scheme.json");
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
  for (const auto& fit : all["fits"])
    BOOST_TEST(fit["seconds"].get<double>() ==
               fit["data_seconds"].get<double>() + fit["fit_seconds"].get<double>());
}
