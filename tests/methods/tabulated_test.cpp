// SPDX-License-Identifier: BSL-1.0
// A method as data is what its type says, and refuses what cannot be. (Its steps: see as_data_*.)
#include "nysalt/methods/tabulated.hpp"

#include <boost/test/unit_test.hpp>

#include <limits>
#include <string>

#include "../laws/run_laws.hpp"
#include "../laws/stability_law.hpp"
#include "../laws/trials.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/symplecticity.hpp"

using namespace nysalt;
using namespace nysalt::test;

static_assert(Method<tabulated>);

using a_few = std::tuple<mclachlan_atela4, chin4a, member<nystrom>>;

BOOST_AUTO_TEST_CASE_TEMPLATE(it_has_the_same_windows, M, a_few) {
  draws random;
  const auto method = any_method<M>(random);
  const auto windows = stability_windows(method);
  const auto of_table = stability_windows(tabulated(method));
  BOOST_REQUIRE(of_table.size() == windows.size());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    // The polynomial is the same; its roots come from companion matrices that may differ in size.
    BOOST_TEST(std::abs(of_table[i].low - windows[i].low) <= 1e-12 * windows[i].high);
    BOOST_TEST(std::abs(of_table[i].high - windows[i].high) <= 1e-12 * windows[i].high);
  }
}

BOOST_AUTO_TEST_CASE(derivatives_flow_through_it) {
  const pendulum system;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.5)};
  // Some ten products of matrices with entries of order one.
  BOOST_TEST(symplecticity_defect(system, tabulated(srkn6b{}), 0.3, x) < 100.0 * eps);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const method_properties nothing{1, false, false};
  const auto table = [&](const std::string& letters, const std::vector<double>& c) {
    return [=] { tabulated("mine", run_time_word(letters), c, nothing); };
  };
  using error = std::invalid_argument;
  BOOST_TEST(refuses<error>(table("ABA", {0.5, 1.0}), {"2 coefficients for the 3 letters ABA"}));
  BOOST_TEST(refuses<error>(table("AGA", {0.5, 1.0, 0.5}), {"3 coefficients", "G and H take two"}));
  BOOST_TEST(refuses<error>(table("AB", {std::numeric_limits<double>::quiet_NaN(), 1.0}),
                            {"coefficient 1 must be finite, got nan"}));
  BOOST_TEST(!refuses<error>(table("AB", {1.0, 1.0}), {}));
  // The order of srkn11b needs a quadratic kinetic energy; as data it can only say so when it is run.
  const auto fast = a_fast_one::make();
  const tabulated needs_quadratic(srkn11b{});
  BOOST_TEST(refuses<error>([&] { make_stepper(fast, needs_quadratic, 0.1); },
                            {"kinetic energy must be quadratic"}));
  BOOST_CHECK_NO_THROW(make_stepper(fast, tabulated(srkn6b{}), 0.1));
  std::string letters;
  for (int n = 0; n < 65; ++n) letters += "BA";
  const tabulated too_long("long", run_time_word(letters), std::vector<double>(130, 1.0 / 65.0), nothing);
  BOOST_TEST(refuses<error>([&] { stability_windows(too_long); }, {"<= 64"}));
}
