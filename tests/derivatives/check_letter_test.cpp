// SPDX-License-Identifier: BSL-1.0
// What letters claim is tried, and what is not so is named.
#include "nysalt/derivatives/check_letter.hpp"

#include "../support/systems_with_letters.hpp"

using namespace nysalt;

namespace {

const std::vector<phase_point<double, 2>> points{{{0.1, -0.2}, {0.3, 0.1}}, {{-0.3, 0.25}, {0.05, -0.2}}};

template <class L>
std::string report(double h = 0.7) {
  const letter_check found = check_letter<L>(henon_heiles(), points, h);
  BOOST_TEST(found.passed() == found.report().ends_with("is what it states"));
  return found.report();
}

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
    using std::cos, std::sin;
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
/// Its value is right, and its derivative is lost.
struct without_slope : exact_flow<'w'> {
  static constexpr bool moves_q = false;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    const double value = [&] {
      if constexpr (requires { t.value; })
        return t.value;
      else
        return t;
    }();
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] -= x.q[i] * value;
  }
};
struct not_a_number : lettered::turn {
  template <System S, class State, class C>
  static void apply(const S&, const C&, State& x, auto&) {
    x.q[0] = x.q[0] * std::nan("");
  }
};
struct claims_more : displaced_kick {
  static constexpr bool symplectic = true;
};
/// A slip of one part in ten thousand is far above the tolerance, whatever the units.
struct slightly_off : lettered::turn {
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, t, x, room);
    x.p[0] = x.p[0] * 1.0001;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_so_passes_as_do_letters_of_the_library) {
  const auto passes = [](const std::string& said, char letter) {
    BOOST_TEST(said == std::string("the letter ") + letter + " is what it states");
  };
  passes(report<lettered::turn>(), 't');
  passes(report<lettered::turn>(-30.0), 't');
  passes(report<honest_leapfrog>(), 'l');
  passes(report<honest_spin>(), 's');
  passes(report<drift>(), 'A');
  passes(report<kick>(), 'B');
  passes(report<gradient_kick>(), 'G');
  passes(report<displaced_kick>(), 'D');
  passes(report<rotation>(), 'R');
  passes(report<soft_kick>(), 'S');
}

BOOST_AUTO_TEST_CASE(what_is_not_so_is_refused_by_name) {
  const auto refused = [](const std::string& said, const std::string& words) {
    BOOST_TEST(said.starts_with("the letter " + words), said);
  };
  refused(report<lettered::slipped_turn>(), "s is not symplectic: it is off by ");
  refused(report<lettered::even_turn>(), "e is not taken back by negated coefficients: it is off by ");
  refused(report<leapfrog>(), "l is not additive: it is off by ");
  refused(report<spin>(), "s is not reversible: it is off by ");
  refused(report<lettered::moving_kick>(), "m moves q, but states moves_q = false; say true");
  refused(report<without_slope>(), "w has a derivative by its coefficients that is off");
  refused(report<not_a_number>(), "t is not finite, or has no finite derivatives, at a point");
  refused(report<claims_more>(), "D is not symplectic");
}

BOOST_AUTO_TEST_CASE(units_do_not_matter) {
  std::vector<phase_point<double, 2>> tiny = points;
  for (auto& x : tiny) {
    x.q *= 1e-30;
    x.p *= 1e-30;
  }
  BOOST_TEST(check_letter<lettered::turn>(henon_heiles(), tiny, 0.7).passed());
  for (const auto& at : {tiny, points}) {
    BOOST_TEST(!check_letter<slightly_off>(henon_heiles(), at, 0.7).passed());
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_tried_is_refused) {
  BOOST_CHECK_THROW(check_letter<lettered::turn>(henon_heiles(), {}, 0.7), std::invalid_argument);
  BOOST_CHECK_THROW(check_letter<lettered::turn>(henon_heiles(), points, 0.7, {1.0, 2.0}),
                    std::invalid_argument);
}
