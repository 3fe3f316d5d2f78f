// SPDX-License-Identifier: BSL-1.0
// A learned method knows where it is valid.
#include <boost/test/unit_test.hpp>

#include "laws/models.hpp"
#include "nysalt/integrate.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
const fpu_chain<3> learned_for(50.0);
const tuned_method<nystrom> tuned(member<nystrom>({0.5, 0.41}), 0.02, describe(learned_for));

}  // namespace

BOOST_AUTO_TEST_CASE(a_tuned_method_runs_where_it_was_learned) {
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.02));
  BOOST_CHECK_NO_THROW(make_stepper(learned_for, tuned, 0.1 * 0.2));  // as typed, not to the bit
  const fpu_chain<> same_of_another_type(3, 50.0);
  BOOST_CHECK_NO_THROW(make_stepper(same_of_another_type, tuned, 0.02));
  BOOST_TEST(tuned.name() == "learned:nystrom");
  BOOST_TEST(tuned.step() == 0.02);
  BOOST_TEST(tuned.system() == describe(learned_for));
  BOOST_TEST((tuned.parameters() == std::array{0.5, 0.41}));
}

BOOST_AUTO_TEST_CASE(it_refuses_a_foreign_step) {
  for (const double step : {0.01, 0.0200001, -0.02}) {
    BOOST_TEST(refuses<wrong>([&] { make_stepper(learned_for, tuned, step); },
                              {"learned:nystrom", "learned at the step 0.02", "anywhere()"}));
  }
  BOOST_CHECK_THROW(make_stepper(learned_for, tuned, std::numeric_limits<double>::quiet_NaN()), wrong);
}

BOOST_AUTO_TEST_CASE(it_refuses_a_foreign_system) {
  const fpu_chain<3> stiffer(51.0);
  const fpu_chain<> longer(4, 50.0);
  const pendulum other;
  const auto refused = [](const auto& system) {
    return refuses<wrong>([&] { make_stepper(system, tuned, 0.02); },
                          {"learned for fpu_chain(pairs=3, omega=50)", describe(system), "anywhere()"});
  };
  BOOST_TEST(refused(stiffer));
  BOOST_TEST(refused(longer));
  BOOST_TEST(refused(other));
}

BOOST_AUTO_TEST_CASE(the_refusal_reaches_those_who_integrate) {
  const pendulum other;
  const phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(refuses<wrong>([&] { integrate(other, tuned, 0.02, x, 10); }, {"anywhere()"}));
}

BOOST_AUTO_TEST_CASE(anywhere_is_for_those_who_ask) {
  const pendulum other;
  BOOST_CHECK_NO_THROW(make_stepper(other, tuned.anywhere(), 0.5));
  BOOST_TEST((tuned.anywhere().coefficients() == tuned.coefficients()));
}
