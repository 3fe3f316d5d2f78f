// SPDX-License-Identifier: BSL-1.0
// Just inside the ends of its windows a method is stable, just outside it is not; and long runs keep that.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/stability_law.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(windows_end_where_the_spectral_radius_leaves_one) {
  draws random;
  for (int n = 0; n < 2; ++n) {
    for (const auto& method : methods_as_data(random)) {
      if (has_rotation(method.letters())) continue;
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << ", draw " << n) {
        BOOST_TEST(!stability_windows(method).empty());
        try_ends(
            method, 1e-3, 1e-3,
            [&](double z) { BOOST_TEST(spectral_radius(method, z) <= 1.0 + radius_rounding(method, z)); },
            [&](double z) { BOOST_TEST(spectral_radius(method, z) > 1.0 + radius_rounding(method, z)); });
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(long_runs_stay_bounded_inside_and_diverge_outside) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (has_rotation(method.letters())) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      try_ends(
          method, 1e-3, 0.5,  // in the middle of a narrow gap, where 100,000 steps suffice
          [&](double z) { BOOST_TEST(largest_in_long_run(method, z) <= bound_of_long_run(method, z)); },
          [&](double z) { BOOST_TEST(!(largest_in_long_run(method, z) <= 1e9)); });
    }
  }
}

// Between the windows: a claim that they are one must fail.
BOOST_AUTO_TEST_CASE(the_gap_between_windows_is_unstable) {
  const member<nystrom> method({0.5, 0.4});
  BOOST_TEST(spectral_radius(method, 2.5) <= 1.0 + radius_rounding(method, 2.5));
  BOOST_TEST(spectral_radius(method, 2.9) > 1.1);
  BOOST_TEST(spectral_radius(method, 3.5) <= 1.0 + radius_rounding(method, 3.5));
}

// n steps of symplectic Euler are stable up to z = 2 n, and trace/2 touches +-1 n - 1 times on the way: the
// worst case for finding extrema.
BOOST_AUTO_TEST_CASE(windows_that_touch_many_times_are_one) {
  for (const std::size_t n : {1U, 2U, 5U, 8U, 9U, 12U, 16U, 20U, 32U, 64U}) {
    std::string letters;
    for (std::size_t i = 0; i < n; ++i) letters += "AB";
    const std::vector<double> c(2 * n, 1.0 / static_cast<double>(n));
    const auto windows = stability_windows(run_time_word(letters), c);
    BOOST_TEST_CONTEXT(n << " steps") {
      BOOST_TEST(windows.size() == 1U);
      BOOST_TEST(std::abs(windows.back().high - 2.0 * static_cast<double>(n)) < 1e-6);
    }
  }
}
