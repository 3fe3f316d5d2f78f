// SPDX-License-Identifier: BSL-1.0
// Words with kicks of parts on the linearised motion: known tongues of resonance, and what the guard says
// there and beside them.
#include "nysalt/derivatives/word_on_parts.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/derivatives/strong_stability.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/methods/r_respa.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/bonded_chain.hpp"
#include "nysalt/trial_run.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <int N>
struct springs {
  static constexpr int dimension = N;
  Eigen::Matrix<double, N, N> stiffness;
  template <class T>
  T potential(const vector<T, N>& q) const {
    T sum(0.0);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) sum += q[i] * q[j] * (0.5 * stiffness(i, j));
    }
    return sum;
  }
  std::string description() const { return "springs"; }
};
using two_springs = sum_of_parts<springs<2>, springs<2>>;

constexpr int inner = 16;
using respa = r_respa<0, 1, inner>;
constexpr double first_omega = 10.0;
constexpr double second_omega = 6.0;

two_springs pair_coupled_by(double coupling) {
  const Eigen::Vector2d squares(first_omega * first_omega, second_omega * second_omega);
  return two_springs(springs<2>{squares.asDiagonal()},
                     springs<2>{coupling * Eigen::Matrix2d{{1.0, 1.0}, {1.0, 1.0}}});
}

/// n steps of velocity Verlet on an oscillator turn it by an angle, in coordinates scaled by a frequency.
struct verlet_turn {
  double angle;
  double frequency;
};
verlet_turn turn_of(double omega, double step) {
  const double z = omega * step / inner;
  return {inner * std::acos(1.0 - 0.5 * z * z), omega * std::sqrt(1.0 - 0.25 * z * z)};
}

/// First-order theory of the slow kicks: they turn mode i by h k_ii/(2 omega_i) more, and couple the two by h
/// k_12/(2 sqrt(omega_1 omega_2)) [hairer_lubich_wanner_2006, section XIII].
struct sum_resonance_theory {
  double angle;     // sum of both angles, less a whole turn
  double coupling;  // unstable where |angle| < 2 coupling; at angle 0 the growth in a step
};
sum_resonance_theory theory(double coupling, double step) {
  const auto one = turn_of(first_omega, step);
  const auto two = turn_of(second_omega, step);
  const double more = 0.5 * step * coupling * (1.0 / one.frequency + 1.0 / two.frequency);
  return {one.angle + two.angle + more - 2.0 * std::numbers::pi,
          0.5 * step * coupling / std::sqrt(one.frequency * two.frequency)};
}
/// The step at which omega_1 h + omega_2 h, shifted by the coupling, exceeds 2 pi by `couplings` half widths
/// of the resonance tongue.
double step_at(double coupling, double couplings) {
  double low = 0.35;
  double high = 0.45;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const auto at = theory(coupling, middle);
    (at.angle < couplings * at.coupling ? low : high) = middle;
  }
  return low;
}

template <int N>
phase_points states_of(std::initializer_list<phase_point<double, N>> all) {
  phase_points result;
  for (const auto& x : all) result.push_back(phase_point<double, Eigen::Dynamic>{x.q, x.p});
  return result;
}
const phase_points of_two = states_of<2>({{{0.1, -0.1}, {0.5, 0.2}}, {{-0.05, 0.1}, {-0.3, 0.6}}});

std::vector<double> coefficients_of_respa() {
  const auto all = respa::coefficients();
  return {all.begin(), all.end()};
}

constexpr std::int64_t steps = 20'000;

}  // namespace

// Hessians of the parts do not commute; of a linear system the letters' product is the step itself.
BOOST_AUTO_TEST_CASE(the_product_of_linearised_letters_has_the_eigenvalues_of_a_step) {
  const two_springs system(springs<2>{Eigen::Matrix2d{{100.0, 30.0}, {30.0, 40.0}}},
                           springs<2>{Eigen::Matrix2d{{1.0, 0.6}, {0.6, 3.0}}});
  const run_time_word word(respa::word{}, system);
  const word_on_parts parts(system, of_two, word);
  BOOST_TEST(parts.is_known());
  BOOST_TEST(parts.has_mean());
  for (const double h : {0.1, 0.31, 0.47}) {
    const Eigen::MatrixXd step =
        jacobian(step_map(system, respa{}, h), phase_point<double, 2>{{0.1, 0.2}, {0.3, 0.4}});
    const auto exact = spectrum_of(step);
    const auto found = spectrum_of(parts.step(coefficients_of_respa(), h, parts.states()));
    // Rounding of 2 * 16 letters, by the condition of the eigenvalues, some 10.
    BOOST_TEST(std::abs(found.growth - exact.growth) <= 1e4 * eps);
    BOOST_TEST(std::abs(found.krein_distance - exact.krein_distance) <= 1e5 * eps);
  }
}

BOOST_AUTO_TEST_CASE(a_sum_resonance_has_the_growth_and_the_width_of_the_theory) {
  constexpr double coupling = 0.5;
  const auto system = pair_coupled_by(coupling);
  const word_on_parts parts(system, of_two, run_time_word(respa::word{}, system));
  const auto growth_at = [&](double couplings) {
    return spectrum_of(parts.step(coefficients_of_respa(), step_at(coupling, couplings), parts.states()))
        .growth;
  };
  const double centre = step_at(coupling, 0.0);
  // Of second order in h k/omega = 0.03: a tenth of the width is more.
  BOOST_TEST(std::abs(growth_at(0.0) / theory(coupling, centre).coupling - 1.0) <= 0.1);
  for (const double inside : {-1.8, 1.8}) BOOST_TEST(growth_at(inside) > 0.1 * growth_at(0.0));
  for (const double outside : {-2.2, 2.2}) BOOST_TEST(growth_at(outside) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(the_guard_refuses_a_tongue_and_what_grows_beside_it_and_admits_what_is_far) {
  constexpr double coupling = 0.5;
  const auto system = pair_coupled_by(coupling);
  const run_time_word word(respa::word{}, system);
  const stability_guard guard(system, of_two, word, steps);
  BOOST_REQUIRE(guard.parts() != nullptr);
  const auto c = coefficients_of_respa();
  const auto objection_at = [&](double couplings) {
    return guard.objection(word, c, step_at(coupling, couplings));
  };
  BOOST_TEST(objection_at(0.0).find("without bound") != std::string::npos, objection_at(0.0));
  // Stable, but powers of the step magnify energies by (a + 2)/(a - 2) at a couplings beside the centre.
  BOOST_TEST(!objection_at(2.3).empty());
  BOOST_TEST(objection_at(8.0).empty(), objection_at(8.0));
  BOOST_TEST(objection_at(-8.0).empty(), objection_at(-8.0));
}

// All modes turn by less than a hundredth of a radian and are left out: M has no rows.
BOOST_AUTO_TEST_CASE(the_guard_admits_a_step_in_which_no_mode_turns) {
  const auto system = pair_coupled_by(0.5);
  const run_time_word word(respa::word{}, system);
  const stability_guard guard(system, of_two, word, steps);
  for (const double h : {1e-4, 1e-8, 0.0}) {
    BOOST_TEST(guard.parts()->step(coefficients_of_respa(), h, guard.parts()->states()).rows() == 0);
    BOOST_TEST(guard.objection(word, coefficients_of_respa(), h).empty());
  }
  BOOST_TEST(!guard.objection(word, coefficients_of_respa(), step_at(0.5, 0.0)).empty());
}

namespace {
/// Two frequencies whose sum and difference are whole turns at steps where neither is half a turn alone.
two_springs pair_of_other_ratio(double coupling) {
  const Eigen::Vector2d squares(10.0 * 10.0, 5.5 * 5.5);
  return two_springs(springs<2>{squares.asDiagonal()},
                     springs<2>{coupling * Eigen::Matrix2d{{1.0, 1.0}, {1.0, 1.0}}});
}

/// The step in a range at which the two modes, each a block of M but for the coupling, turn by angles of the
/// same cosine.
double step_where_cosines_meet(const word_on_parts& parts, double low, double high) {
  const auto apart = [&](double h) {
    const Eigen::MatrixXd m = parts.step(coefficients_of_respa(), h, parts.states());
    return m(0, 0) + m(2, 2) - m(1, 1) - m(3, 3);
  };
  const bool rises = apart(low) < 0.0;
  BOOST_REQUIRE(rises != (apart(high) < 0.0));
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((apart(middle) < 0.0) == rises ? low : high) = middle;
  }
  return low;
}

/// The least difference in phase of any two eigenvalues, whatever their signatures.
double closest_phases(const Eigen::MatrixXd& m) {
  const Eigen::VectorXcd values = eigenvalues(m);
  double closest = std::numbers::pi;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j)
      closest = std::min(closest, std::abs(std::arg(values[i] / values[j])));
  }
  return closest;
}
}  // namespace

// Angles that differ by a whole turn meet too, but with like signatures: a coupling of any small size parts
// them along the circle. Where angles sum up to a whole turn the same coupling moves them off it.
BOOST_AUTO_TEST_CASE(the_guard_admits_a_difference_resonance) {
  const auto system = pair_of_other_ratio(1e-5);
  const run_time_word word(respa::word{}, system);
  const stability_guard guard(system, of_two, word, steps);
  const auto c = coefficients_of_respa();
  const auto& parts = *guard.parts();
  const auto at = [&](double h) { return parts.step(c, h, parts.states()); };
  // Nearer than a guard that ignores signatures would admit.
  constexpr double met = 1e-5;
  static_assert(met < 2.0 / steps && met < word_on_parts::least_turn);
  // h (omega_1 - omega_2) = 2 pi at 1.396, moved by less than 6 % by the phases of Verlet.
  const double difference = step_where_cosines_meet(parts, 1.30, 1.42);
  BOOST_TEST(closest_phases(at(difference)) <= met);
  BOOST_TEST(spectrum_of(at(difference)).is_on_circle());
  BOOST_TEST(spectrum_of(at(difference)).krein_distance > 0.1);
  BOOST_TEST(guard.objection(word, c, difference).empty(), guard.objection(word, c, difference));
  // h (omega_1 + omega_2) = 2 pi at .405: phases as near, of opposite signature.
  const double sum = step_where_cosines_meet(parts, 0.39, 0.42);
  BOOST_TEST(closest_phases(at(sum)) <= met);
  BOOST_TEST(guard.objection(word, c, sum).find("not strongly stable") != std::string::npos,
             guard.objection(word, c, sum));
}

// A plan of ten steps: eigenvalues of opposite signature that perturbations may bring together in ten steps
// may be .2 apart, but so are those of a slow mode and its conjugate, and those of two slow modes.
BOOST_AUTO_TEST_CASE(a_short_plan_refuses_resonances_and_no_slow_modes) {
  constexpr std::int64_t few = 10;
  const auto c = coefficients_of_respa();
  int slower = 0;
  for (const double slow : {0.1, 0.3, 0.7}) {
    for (const double other : {0.12, 0.5, 10.0}) {
      const Eigen::Vector2d squares(slow * slow, other * other);
      const two_springs system(springs<2>{squares.asDiagonal()},
                               springs<2>{0.1 * slow * slow * Eigen::Matrix2d{{1.0, 0.1}, {0.1, 1.0}}});
      const run_time_word word(respa::word{}, system);
      const stability_guard guard(system, of_two, word, few);
      constexpr double h = 0.12;
      const auto spectrum = spectrum_of(guard.parts()->step(c, h, guard.parts()->states()));
      slower += spectrum.krein_distance < 2.0 / few ? 1 : 0;
      BOOST_TEST(guard.objection(word, c, h).empty(), guard.objection(word, c, h));
    }
  }
  BOOST_TEST(slower == 9);
  // Half a period of the first mode between kicks: a pair at -1. Its growth in ten steps is small.
  const auto system = pair_of_other_ratio(0.1);
  const run_time_word word(respa::word{}, system);
  const stability_guard guard(system, of_two, word, few);
  int refused = 0;
  for (int k = 0; k <= 400; ++k) {
    const double h = 0.30 + 0.02 * k / 400;  // pi/10, less the phase of Verlet
    const auto spectrum = spectrum_of(guard.parts()->step(c, h, guard.parts()->states()));
    const std::string objection = guard.objection(word, c, h);
    if (spectrum.is_on_circle()) continue;
    ++refused;
    BOOST_TEST(objection.find("at the phase") != std::string::npos, objection);
    BOOST_TEST(std::abs(std::abs(spectrum.first) - std::numbers::pi) <= 1e-6);
  }
  BOOST_TEST(refused > 0);
}

// Neither diverges, nor does its energy drift after the first tenth: the trial run compares with early steps.
BOOST_AUTO_TEST_CASE(a_trial_run_finds_what_grows_beside_a_tongue) {
  constexpr double coupling = 0.5;
  const auto system = pair_coupled_by(coupling);
  const tabulated method("respa", run_time_word(respa::word{}, system), coefficients_of_respa(),
                         {2, true, false});
  const auto at = [&](double couplings, bool watches) {
    return trial_run(system, method, step_at(coupling, couplings), of_two,
                     {.steps = steps, .watches_growth = watches});
  };
  const auto beside = at(2.1, true);
  BOOST_TEST(!beside.lost.has_value());
  BOOST_TEST(!beside.energy_wanders(), beside.report());
  BOOST_TEST(beside.energy_grows(), beside.report());
  BOOST_TEST(beside.objection().find("first 64 steps") != std::string::npos);
  BOOST_TEST(at(2.1, false).passed());
  BOOST_TEST(at(30.0, true).passed(), at(30.0, true).report());
}

// Half a period and one period of the fastest mode between slow kicks [schlick_mandziuk_skeel_srinivas_1998].
BOOST_AUTO_TEST_CASE(the_guard_knows_the_resonances_of_r_respa_before_any_run) {
  const bonded_chain<4> chain(stiff_bonds<4>(20.0), soft_charges<4>(2.0));
  const phase_points states = states_of<4>(
      {{{0.01, -0.02, 0.0, 0.03}, {0.3, -0.1, 0.2, 0.4}}, {{-0.01, 0.02, 0.01, 0.0}, {0.1, 0.3, -0.3, 0.1}}});
  using fine = r_respa<0, 1, 32>;
  const run_time_word word(fine::word{}, chain);
  const auto all = fine::coefficients();
  const std::vector<double> c(all.begin(), all.end());
  const stability_guard guard(chain, states, word, steps);
  BOOST_REQUIRE(guard.parts() != nullptr);
  const double fastest = 40.0 * std::sin(3.0 * std::numbers::pi / 8.0);
  const double period = 2.0 * std::numbers::pi / fastest;
  // Charges and Verlet's phase move a resonance by less than 1 %.
  for (const double resonant : {0.5 * period, period}) {
    bool is_refused = false;
    for (int k = -20; k <= 20; ++k) {
      is_refused = is_refused || !guard.objection(word, c, resonant * (1.0 + 0.0005 * k)).empty();
    }
    BOOST_TEST(is_refused, "at " << resonant);
  }
  for (const double free : {0.75 * period, 1.1 * period}) {
    BOOST_TEST(guard.objection(word, c, free).empty(), guard.objection(word, c, free));
  }
}

// Whatever the growth in the mean and over the states is, a refusal of either counts.
BOOST_AUTO_TEST_CASE(of_two_growths_a_refused_one_is_the_worse) {
  std::mt19937_64 bits(1);
  std::uniform_real_distribution<double> power(-3.0, 2.0);
  int smaller = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto drawn = [&] {
      const double a = std::pow(10.0, power(bits));
      const double b = std::pow(10.0, power(bits));
      return growth_of_energy{.early = std::min(a, b), .late = std::max(a, b)};
    };
    const auto one = drawn();
    const auto other = drawn();
    const auto& worse = one.is_worse_than(other) ? one : other;
    BOOST_TEST(worse.is_refused() == (one.is_refused() || other.is_refused()));
    if (one.is_refused() == other.is_refused()) BOOST_TEST(worse.late == std::max(one.late, other.late));
    smaller += worse.late < std::max(one.late, other.late) ? 1 : 0;
  }
  BOOST_TEST(smaller > 20);  // refused, and the smaller
}

namespace {
template <int N>
struct quartic_wells {
  static constexpr int dimension = N;
  template <class T>
  T potential(const vector<T, N>& q) const {
    T sum(0.0);
    for (int i = 0; i < N; ++i) sum += q[i] * q[i] * q[i] * q[i] * 0.25;
    return sum;
  }
  template <class T>
  void force(const vector<T, N>& q, vector<T, N>& f) const {
    for (int i = 0; i < N; ++i) f[i] = -q[i] * q[i] * q[i];
  }
  std::string description() const { return "quartic_wells"; }
};

/// Eight states of which one is elsewhere, so far that its Hessian, 6 q^2, is not near the mean of all.
template <int N>
bool has_mean_of(double elsewhere) {
  const sum_of_parts<quartic_wells<N>, quartic_wells<N>> system(quartic_wells<N>{}, quartic_wells<N>{});
  phase_points states;
  for (int k = 0; k < 8; ++k) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(N, k == 5 ? elsewhere : 1.0);
    states.push_back(phase_point<double, Eigen::Dynamic>{q, Eigen::VectorXd::Ones(N)});
  }
  return word_on_parts(system, states, run_time_word(respa::word{}, system)).has_mean();
}
}  // namespace

BOOST_AUTO_TEST_CASE(states_that_lie_far_apart_have_no_mean_of_however_many_coordinates) {
  BOOST_TEST(has_mean_of<2>(1.1));
  BOOST_TEST(!has_mean_of<2>(10.0));
  BOOST_TEST(has_mean_of<44>(1.1));
  BOOST_TEST(!has_mean_of<44>(10.0));
}

namespace {
/// A letter that is neither a drift nor a kick: half a turn of q_0 and p_0.
struct turn : exact_flow<'t'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    using std::cos;
    using std::sin;
    const auto q = x.q[0];
    x.q[0] = q * cos(t) + x.p[0] * sin(t);
    x.p[0] = x.p[0] * cos(t) - q * sin(t);
  }
};
}  // namespace

BOOST_AUTO_TEST_CASE(what_is_not_analysed_is_said_and_admitted) {
  const auto system = pair_coupled_by(0.5);
  const run_time_word word(nysalt::word<turn, kick_of_part<0>, turn>{}, system);
  const stability_guard guard(system, of_two, word, steps);
  BOOST_TEST(guard.parts() == nullptr);
  BOOST_TEST(guard.description().find("was not analysed, as the letter t is neither") != std::string::npos,
             guard.description());
  BOOST_TEST(guard.objection(word, {0.5, 1.0, 0.5}, 0.1).empty());
  // A word with kicks of parts is examined by the guard that was made for it.
  const run_time_word examined(respa::word{}, system);
  const stability_guard of_respa(system, of_two, examined, steps);
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        (void)of_respa.objection(word, {0.5, 1.0, 0.5}, 0.1);
      },
      {"for which the guard was made", "make a guard for this word"}));
  BOOST_TEST(of_respa.objection(examined, coefficients_of_respa(), 0.1).empty());
  // An ordinary word is examined as ever.
  const run_time_word ordinary("BAB");
  const stability_guard of_bands(system, of_two, ordinary, steps);
  BOOST_TEST(of_bands.description() == stability_guard(system, of_two, false, steps).description());
  BOOST_TEST(!of_bands.objection(ordinary, {0.5, 1.0, 0.5}, 0.3).empty());
}
