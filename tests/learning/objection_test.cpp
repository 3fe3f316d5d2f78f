// SPDX-License-Identifier: BSL-1.0
// On data that it has not seen a fit may be worse than its start by chance, not by more.
#include "nysalt/learning/objection.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

using namespace nysalt;

BOOST_AUTO_TEST_CASE(worse_than_the_start_by_chance_is_no_objection) {
  fit_summary fit;
  fit.step = 0.1;
  fit.coordinates_used = 2;
  fit.held_out_start_loss = 1.00e-6;
  fit.held_out_loss = 1.05e-6;
  const auto objection = [&](double noise) {
    fit.held_out_noise = noise;
    return detail::objection(fit, true, "");
  };
  BOOST_TEST(objection(0.0).find("worse than the parameters") != std::string::npos);
  BOOST_TEST(objection(0.016e-6).find("worse than the parameters") != std::string::npos);
  BOOST_TEST(objection(0.017e-6) == "");  // three of these make .051
  fit.held_out_loss = 1.51e-6;
  BOOST_TEST(objection(1.0e-6).find("worse than the parameters") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_noise_is_that_of_paired_differences) {
  // Differences 1, 2, 3: their sum scatters by sqrt(3) times their deviation, 1.
  const std::vector<double> b{10.0, 200.0, 3000.0};
  const std::vector<double> a{11.0, 202.0, 3003.0};
  BOOST_TEST(std::abs(detail::noise_of_difference(a, b, shard(std::ssize(a))) - std::sqrt(3.0)) < 1e-15);
  BOOST_TEST(detail::noise_of_difference(b, b, shard(std::ssize(b))) == 0.0);
  BOOST_TEST(std::isinf(detail::noise_of_difference({1.0}, {2.0}, shard(1))));  // of one nothing is known
}
