// SPDX-License-Identifier: BSL-1.0
// What letters claim is tried, and what is not so is named.
#include "nysalt/derivatives/check_letter.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;

namespace {

const std::vector<phase_point<double, 2>> points{{{0.1, -0.2}, {0.3, 0.1}}, {{-0.3, 0.25}, {0.05, -0.2}}};

template <class L>
std::string report(double h = 0.7) {
  const letter_check found = check_letter<L>(henon_heiles(), points, h);
  BOOST_TEST(found.passed() == found.report().ends_with("is what it states"));
  return found.report();
}

struct turn : exact_flow<'t'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto q = x.q[i];
      x.q[i] = q * cos(t) + x.p[i] * sin(t);
      x.p[i] = x.p[i] * cos(t) - q * sin(t);
    }
  }
};
/// The new q goes into the new p.
struct slip : turn {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] = x.q[i] * cos(t) + x.p[i] * sin(t);
      x.p[i] = x.p[i] * cos(t) - x.q[i] * sin(t);
    }
  }
};
/// Symplectic, but x(-c) is not its inverse: the middle of a shear and a kick in turn.
struct no_inverse : exact_flow<'n'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] += x.p[i] * t;
      x.p[i] -= x.q[i] * t;
    }
  }
};
/// Symplectic and taken back, but of order two in t: not additive.
struct leapfrog : exact_flow<'l'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] += x.p[i] * t * 0.5;
      x.p[i] -= x.q[i] * t;
      x.q[i] += x.p[i] * t * 0.5;
    }
  }
};
struct honest_leapfrog : leapfrog {
  static constexpr bool additive = false;
};
/// The flow of q_1 p_2 - q_2 p_1: with -p it turns the other way.
struct spin : exact_flow<'s'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    for (auto* z : {&x.q, &x.p}) {
      const auto first = (*z)[0];
      (*z)[0] = first * cos(t) - (*z)[1] * sin(t);
      (*z)[1] = (*z)[1] * cos(t) + first * sin(t);
    }
  }
};
struct honest_spin : spin {
  static constexpr bool reversible = false;
};
struct moves_in_secret : turn {
  static constexpr bool moves_q = false;
};
/// Its value is right, and its derivative is lost.
struct without_slope : exact_flow<'w'> {
  static constexpr bool moves_q = false;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    double value = 0.0;
    if constexpr (requires { t.value; }) {
      value = t.value;
    } else {
      value = t;
    }
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] -= x.q[i] * value;
  }
};
struct not_a_number : turn {
  template <System S, class State, class C>
  static void apply(const S&, const C&, State& x, auto&) {
    x.q[0] = x.q[0] * std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_so_passes) {
  BOOST_TEST(report<turn>() == "the letter t is what it states");
  BOOST_TEST(report<honest_leapfrog>() == "the letter l is what it states");
  BOOST_TEST(report<honest_spin>() == "the letter s is what it states");
  BOOST_TEST(report<turn>(-30.0) == "the letter t is what it states");
}

BOOST_AUTO_TEST_CASE(letters_of_the_library_pass) {
  BOOST_TEST(report<drift>() == "the letter A is what it states");
  BOOST_TEST(report<kick>() == "the letter B is what it states");
  BOOST_TEST(report<gradient_kick>() == "the letter G is what it states");
  BOOST_TEST(report<displaced_kick>() == "the letter D is what it states");
  BOOST_TEST(report<rotation>() == "the letter R is what it states");
  BOOST_TEST(report<soft_kick>() == "the letter S is what it states");
}

BOOST_AUTO_TEST_CASE(what_is_not_so_is_refused_by_name) {
  BOOST_TEST(report<slip>().starts_with("the letter t is not symplectic: it is off by "));
  BOOST_TEST(report<no_inverse>().starts_with(
      "the letter n is not taken back by negated coefficients: it is off by "));
  BOOST_TEST(report<leapfrog>().starts_with("the letter l is not additive: it is off by "));
  BOOST_TEST(report<spin>().starts_with("the letter s is not reversible: it is off by "));
  BOOST_TEST(report<moves_in_secret>() == "the letter t moves q, but states moves_q = false; say true");
  BOOST_TEST(
      report<without_slope>().starts_with("the letter w has a derivative by its coefficients that is off"));
  BOOST_TEST(report<not_a_number>() ==
             "the letter t is not finite, or has no finite derivatives, at a point");
}

namespace {
struct claims_more : displaced_kick {
  static constexpr bool symplectic = true;
};
}  // namespace

BOOST_AUTO_TEST_CASE(the_displaced_kick_is_not_symplectic_as_it_says) {
  BOOST_TEST(report<claims_more>().starts_with("the letter D is not symplectic"));
}

// A slip of one part in ten thousand is far above the tolerance, whatever the units.
namespace {
struct slightly_off : turn {
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, t, x, room);
    x.p[0] = x.p[0] * 1.0001;
  }
};
}  // namespace

BOOST_AUTO_TEST_CASE(units_do_not_matter) {
  std::vector<phase_point<double, 2>> tiny = points;
  for (auto& x : tiny) {
    x.q *= 1e-30;
    x.p *= 1e-30;
  }
  BOOST_TEST(check_letter<turn>(henon_heiles(), tiny, 0.7).passed());
  BOOST_TEST(!check_letter<slightly_off>(henon_heiles(), tiny, 0.7).passed());
  BOOST_TEST(!check_letter<slightly_off>(henon_heiles(), points, 0.7).passed());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_tried_is_refused) {
  BOOST_CHECK_THROW(check_letter<turn>(henon_heiles(), {}, 0.7), std::invalid_argument);
  BOOST_CHECK_THROW(check_letter<turn>(henon_heiles(), points, 0.7, {1.0, 2.0}), std::invalid_argument);
}
