// SPDX-License-Identifier: BSL-1.0
// Our methods within Boost.Odeint's loops give our states.
#include <boost/test/unit_test.hpp>

#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>

#include <vector>

#include "laws/laws.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/references/odeint_stepper.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;
namespace odeint = boost::numeric::odeint;

namespace {

constexpr double h = 0.1;
constexpr std::int64_t steps = 100;
using states = std::vector<phase_point<double, 2>>;

struct setting {
  henon_heiles system;
  phase_point<double, 2> start;
  states ours;

  template <Method M>
  explicit setting(const M& method) {
    draws random;
    start = random.state(system, 0.25);
    integrate(system, method, h, start, steps,
              [&](std::int64_t, double, const auto& x) { ours.push_back(x); });
  }
};

/// Each letter rounds twice in each of the steps; on a bounded regular orbit |J| grows with t, to some 2 t.
template <Method M>
void agrees(const states& theirs, const states& ours, const M& method) {
  BOOST_REQUIRE(theirs.size() == ours.size());
  const double magnified = 2.0 * h * static_cast<double>(steps);
  const double rounding = static_cast<double>(steps) * 4.0 * roundings(method, 2) * eps * magnified;
  for (std::size_t n = 0; n < ours.size(); ++n) BOOST_TEST(distance(theirs[n], ours[n]) <= rounding);
}

/// By integrate_const and by integrate_n_steps.
template <Method M>
void check_integrations(const M& method) {
  const setting s(method);
  states theirs;
  std::vector<double> times;
  const auto observe = [&](const phase_point<double, 2>& x, double t) {
    theirs.push_back(x);
    times.push_back(t);
  };
  BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
    auto x = s.start;
    odeint::integrate_const(odeint_stepper(method), s.system, x, 0.0, h * static_cast<double>(steps), h,
                            observe);
    agrees(theirs, s.ours, method);
    BOOST_TEST(same_bits(theirs.back(), x));
    BOOST_TEST(std::abs(times.back() - 10.0) <= 10.0 * eps);  // the last point is there

    theirs.clear();
    x = s.start;
    odeint::integrate_n_steps(odeint_stepper(method), s.system, x, 0.0, h, static_cast<std::size_t>(steps),
                              observe);
    agrees(theirs, s.ours, method);
    BOOST_TEST(distance(x, s.ours.front()) > 1e-3);  // it moved
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(integrate_const_and_n_steps_see_our_states) {
  draws random;
  for (const auto& method : methods_as_data(random)) {
    if (suits(henon_heiles(), method)) check_integrations(method);
  }
  check_integrations(srkn6b());  // a method by its type
}

BOOST_AUTO_TEST_CASE(a_stepper_tells_its_order) {
  BOOST_TEST(odeint_stepper<verlet>().order() == 2);
  BOOST_TEST(odeint_stepper<srkn11b>().order() == 6);
}
