// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 12 s at -O0, 1.6 s at -O1.
// Strong stability of a step, and words with kicks of parts on the linearised motion: known tongues of
// resonance, and what the guard says there and beside them.
#include "../support/dense.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems_with_letters.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/flows/sum_of_parts.hpp"
#include "nysalt/learning/stability_guard.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double pi = std::numbers::pi;

/// Two oscillators that a step turns by these angles, in coordinates (q_1, q_2, p_1, p_2).
Eigen::Matrix4d turned_by(double first, double second) {
  const Eigen::Vector2d cosines(std::cos(first), std::cos(second));
  const Eigen::Vector2d sines(std::sin(first), std::sin(second));
  Eigen::Matrix4d m;
  m << Eigen::Matrix2d(cosines.asDiagonal()), Eigen::Matrix2d(sines.asDiagonal()),
      Eigen::Matrix2d((-sines).asDiagonal()), Eigen::Matrix2d(cosines.asDiagonal());
  return m;
}

/// A kick that couples the two: p -= by K q with a symmetric K of chance.
Eigen::Matrix4d kick_of_chance(std::uint64_t seed, double by) {
  std::mt19937_64 bits(seed);
  std::normal_distribution<double> normal;
  Eigen::Matrix2d k;
  k(0, 0) = normal(bits);
  k(1, 1) = normal(bits);
  k(0, 1) = k(1, 0) = 1.0 + std::abs(normal(bits));  // coupled
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.bottomLeftCorner<2, 2>() = -by * k;
  return m;
}

/// V = q K q/2 + w sum q_i^4/4.
struct springs {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::MatrixXd stiffness;
  double quartic = 0.0;
  Eigen::Index size() const { return stiffness.rows(); }
  template <class T>
  T potential(const vector<T, dimension>& q) const {
    T sum(0.0);
    for (Eigen::Index i = 0; i < size(); ++i) {
      sum += q[i] * q[i] * q[i] * q[i] * (0.25 * quartic);
      for (Eigen::Index j = 0; j < size(); ++j) sum += q[i] * q[j] * (0.5 * stiffness(i, j));
    }
    return sum;
  }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < size(); ++i) {
      f[i] = q[i] * q[i] * q[i] * -quartic;
      for (Eigen::Index j = 0; j < size(); ++j) f[i] -= q[j] * stiffness(i, j);
    }
  }
  std::string description() const { return "springs"; }
};
using two_parts = sum_of_parts<springs, springs>;

constexpr int inner = 16;
const r_respa<0, 1, inner> respa;
constexpr double first_omega = 10.0;
constexpr double second_omega = 6.0;
/// With the first its sum and its difference are whole turns at steps where neither is half a turn alone.
constexpr double of_other_ratio = 5.5;

two_parts pair_coupled_by(double coupling, double second = second_omega) {
  const Eigen::Vector2d squares(first_omega * first_omega, second * second);
  return two_parts(springs{squares.asDiagonal()},
                   springs{coupling * Eigen::Matrix2d{{1.0, 1.0}, {1.0, 1.0}}});
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
  return {one.angle + two.angle + more - 2.0 * pi,
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

using state = phase_point<double, Eigen::Dynamic>;
phase_points points_of(std::initializer_list<state> all) {
  phase_points result;
  for (const state& x : all) result.push_back(x);
  return result;
}
const phase_points of_two = points_of({{Eigen::Vector2d(0.1, -0.1), Eigen::Vector2d(0.5, 0.2)},
                                       {Eigen::Vector2d(-0.05, 0.1), Eigen::Vector2d(-0.3, 0.6)}});

const std::vector<double> coefficients = respa.coefficients();
constexpr std::int64_t steps = 20'000;

/// The guard of r-RESPA's word on a system.
struct examined {
  two_parts system;
  nysalt::word word = respa.letters();
  detail::stability_guard guard;
  explicit examined(const two_parts& of, std::int64_t plan = steps, const phase_points& states = of_two)
      : system(of), guard(system, states, word, plan) {
    BOOST_REQUIRE(guard.parts() != nullptr);
  }
  std::string objection(double h) const { return guard.objection(word, coefficients, h); }
  Eigen::MatrixXd step(double h) const {
    return guard.parts()->step(coefficients, h, guard.parts()->states());
  }
};

/// The step in a range at which the two modes, each a block of M but for the coupling, turn by angles of the
/// same cosine.
double step_where_cosines_meet(const examined& pair, double low, double high) {
  const auto apart = [&](double h) {
    const Eigen::MatrixXd m = pair.step(h);
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
  double closest = pi;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j)
      closest = std::min(closest, std::abs(std::arg(values[i] / values[j])));
  }
  return closest;
}

}  // namespace

BOOST_AUTO_TEST_CASE(opposite_signatures_meet_where_the_sum_of_two_angles_is_a_whole_turn) {
  const auto met = detail::spectrum_of(turned_by(1.0, 2.0 * pi - 1.0));
  BOOST_TEST(met.growth <= 16.0 * eps);
  BOOST_TEST(met.krein_distance <= 16.0 * eps);
  // The first turns by 1.0, the second by 1.0 short of a whole turn and 0.01 more.
  const auto near = detail::spectrum_of(turned_by(1.0, 2.0 * pi - 0.99));
  BOOST_TEST(std::abs(near.krein_distance - 0.01) <= 64.0 * eps);
  // The difference of angles is a whole turn: of like signature. Of opposite signature are +-1, 2 apart.
  const auto like = detail::spectrum_of(turned_by(1.0, 1.0));
  BOOST_TEST(like.growth <= 16.0 * eps);
  BOOST_TEST(std::abs(like.krein_distance - 2.0) <= 64.0 * eps);
}

BOOST_AUTO_TEST_CASE(a_step_off_the_circle_has_its_growth_and_no_distance) {
  const Eigen::Matrix2d stretched{{2.0, 0.0}, {0.0, 0.5}};
  const auto spectrum = detail::spectrum_of(stretched);
  BOOST_TEST(std::abs(spectrum.growth - std::log(2.0)) <= 4.0 * eps);
  BOOST_TEST(spectrum.krein_distance == 0.0);
  BOOST_TEST(!spectrum.is_on_circle());
  const auto turned = detail::spectrum_of(-stretched);  // the phase is that of the multiplier
  BOOST_TEST(std::abs(std::abs(turned.first) - pi) <= 4.0 * eps);
  BOOST_TEST(turned.second == turned.first);
  BOOST_TEST(detail::spectrum_of(turned_by(1.0, 2.0)).is_on_circle());
  const Eigen::Matrix2d shear{{1.0, 1.0}, {0.0, 1.0}};  // both eigenvalues 1, with one vector
  BOOST_TEST(detail::spectrum_of(shear).krein_distance <= 1e-6);
  BOOST_TEST(!(detail::spectrum_of(turned_by(1.0, 2.0)).krein_distance <= 1e-6));
  const auto none = detail::spectrum_of(Eigen::MatrixXd(0, 0));  // a step so small that no mode turns
  BOOST_TEST((none.growth == 0.0 && none.krein_distance == pi));
  BOOST_TEST(refuses([] { detail::spectrum_of(Eigen::MatrixXd::Identity(3, 3)); },
                     {"even number of rows", "got 3 rows"}));
}

BOOST_AUTO_TEST_CASE(powers_of_two_show_the_largest_power) {
  constexpr std::int64_t steps = 4096;
  int large = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double apart = 0.05 * static_cast<double>(seed) / 20.0;
    const Eigen::Matrix4d m = kick_of_chance(seed, 0.005) * turned_by(1.0, 2.0 * pi - 1.0 + apart);
    double largest = 1.0;
    Eigen::Matrix4d power = m;
    for (std::int64_t n = 1; n <= steps; ++n) {
      largest = std::max(largest, spectral_norm(power));
      power = (power * m).eval();
    }
    const double found = detail::largest_power(m, steps);
    if (largest >= 1e6) {
      BOOST_TEST(std::isinf(found));
      continue;
    }
    BOOST_TEST(found <= largest * (1.0 + 1e-9));
    BOOST_TEST(found >= largest * 0.5 * std::numbers::sqrt3 * 0.95);  // single phases beside the difference
    large += largest > 2.0 ? 1 : 0;
  }
  BOOST_TEST(large >= 2);
  // Fewer steps than the difference of phases needs do not show it.
  const Eigen::Matrix4d slow = kick_of_chance(1, 1e-3) * turned_by(1.0, 2.0 * pi - 1.0 + 0.0002);
  BOOST_TEST(detail::largest_power(slow, 4) < 1.05);
}

// Hessians of the parts do not commute; of a linear system the letters' product is the step itself.
BOOST_AUTO_TEST_CASE(the_product_of_linearised_letters_has_the_eigenvalues_of_a_step) {
  const examined one(two_parts(springs{Eigen::Matrix2d{{100.0, 30.0}, {30.0, 40.0}}},
                               springs{Eigen::Matrix2d{{1.0, 0.6}, {0.6, 3.0}}}));
  BOOST_TEST(one.guard.parts()->is_known());
  BOOST_TEST(one.guard.parts()->has_mean());
  for (const double h : {0.1, 0.31, 0.47}) {
    const Eigen::MatrixXd step = detail::jacobian(
        detail::step_map(one.system, respa, h), state{Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.3, 0.4)});
    const auto exact = detail::spectrum_of(step);
    const auto found = detail::spectrum_of(one.step(h));
    // Rounding of 2 * 16 letters, by the condition of the eigenvalues, some 10.
    BOOST_TEST(std::abs(found.growth - exact.growth) <= 1e4 * eps);
    BOOST_TEST(std::abs(found.krein_distance - exact.krein_distance) <= 1e5 * eps);
  }
}

BOOST_AUTO_TEST_CASE(a_sum_resonance_has_the_growth_and_the_width_of_the_theory) {
  constexpr double coupling = 0.5;
  const examined pair(pair_coupled_by(coupling));
  const auto growth_at = [&](double couplings) {
    return detail::spectrum_of(pair.step(step_at(coupling, couplings))).growth;
  };
  // Of second order in h k/omega = 0.03: a tenth of the width is more.
  BOOST_TEST(std::abs(growth_at(0.0) / theory(coupling, step_at(coupling, 0.0)).coupling - 1.0) <= 0.1);
  for (const double inside : {-1.8, 1.8}) BOOST_TEST(growth_at(inside) > 0.1 * growth_at(0.0));
  for (const double outside : {-2.2, 2.2}) BOOST_TEST(growth_at(outside) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(the_guard_refuses_a_tongue_and_what_grows_beside_it_and_admits_what_is_far) {
  constexpr double coupling = 0.5;
  const examined pair(pair_coupled_by(coupling));
  const auto objection_at = [&](double couplings) { return pair.objection(step_at(coupling, couplings)); };
  BOOST_TEST(objection_at(0.0).find("without bound") != std::string::npos, objection_at(0.0));
  // Stable, but powers of the step magnify energies by (a + 2)/(a - 2) at a couplings beside the centre.
  BOOST_TEST(!objection_at(2.3).empty());
  BOOST_TEST(objection_at(8.0).empty(), objection_at(8.0));
  BOOST_TEST(objection_at(-8.0).empty(), objection_at(-8.0));
  // Where all modes turn by less than a hundredth of a radian they are left out: M has no rows.
  for (const double h : {1e-4, 1e-8, 0.0}) {
    BOOST_TEST(pair.step(h).rows() == 0);
    BOOST_TEST(pair.objection(h).empty());
  }
}

// Angles that differ by a whole turn meet too, but with like signatures: a coupling of any small size parts
// them along the circle. Where angles sum up to a whole turn the same coupling moves them off it.
BOOST_AUTO_TEST_CASE(the_guard_admits_a_difference_resonance) {
  const examined pair(pair_coupled_by(1e-5, of_other_ratio));
  // Nearer than a guard that ignores signatures would admit.
  constexpr double met = 1e-5;
  static_assert(met < 2.0 / steps && met < detail::word_on_parts::least_turn);
  // h (omega_1 - omega_2) = 2 pi at 1.396, moved by less than 6 % by the phases of Verlet.
  const double difference = step_where_cosines_meet(pair, 1.30, 1.42);
  BOOST_TEST(closest_phases(pair.step(difference)) <= met);
  BOOST_TEST(detail::spectrum_of(pair.step(difference)).is_on_circle());
  BOOST_TEST(detail::spectrum_of(pair.step(difference)).krein_distance > 0.1);
  BOOST_TEST(pair.objection(difference).empty(), pair.objection(difference));
  // h (omega_1 + omega_2) = 2 pi at .405: phases as near, of opposite signature.
  const double sum = step_where_cosines_meet(pair, 0.39, 0.42);
  BOOST_TEST(closest_phases(pair.step(sum)) <= met);
  BOOST_TEST(pair.objection(sum).find("not strongly stable") != std::string::npos, pair.objection(sum));
}

// A plan of ten steps: eigenvalues of opposite signature that perturbations may bring together in ten steps
// may be .2 apart, but so are those of a slow mode and its conjugate, and those of two slow modes.
BOOST_AUTO_TEST_CASE(a_short_plan_refuses_resonances_and_no_slow_modes) {
  constexpr std::int64_t few = 10;
  int slower = 0;
  for (const double slow : {0.1, 0.3, 0.7}) {
    for (const double other : {0.12, 0.5, 10.0}) {
      const Eigen::Vector2d squares(slow * slow, other * other);
      const examined pair(two_parts(springs{squares.asDiagonal()},
                                    springs{0.1 * slow * slow * Eigen::Matrix2d{{1.0, 0.1}, {0.1, 1.0}}}),
                          few);
      constexpr double h = 0.12;
      slower += detail::spectrum_of(pair.step(h)).krein_distance < 2.0 / few ? 1 : 0;
      BOOST_TEST(pair.objection(h).empty(), pair.objection(h));
    }
  }
  BOOST_TEST(slower == 9);
  // Half a period of the first mode between kicks: a pair at -1. Its growth in ten steps is small.
  const examined pair(pair_coupled_by(0.1, of_other_ratio), few);
  int refused = 0;
  for (int k = 0; k <= 400; ++k) {
    const double h = 0.30 + 0.02 * k / 400;  // pi/10, less the phase of Verlet
    const auto spectrum = detail::spectrum_of(pair.step(h));
    if (spectrum.is_on_circle()) continue;
    ++refused;
    BOOST_TEST(pair.objection(h).find("at the phase") != std::string::npos, pair.objection(h));
    BOOST_TEST(std::abs(std::abs(spectrum.first) - pi) <= 1e-6);
  }
  BOOST_TEST(refused > 0);
}

// Half a period and one period of the fastest mode between slow kicks [schlick_mandziuk_skeel_srinivas_1998].
BOOST_AUTO_TEST_CASE(the_guard_knows_the_resonances_of_r_respa_before_any_run) {
  constexpr double omega = 20.0;
  Eigen::Matrix4d bonds;  // of four masses in a row
  bonds << 1.0, -1.0, 0.0, 0.0, -1.0, 2.0, -1.0, 0.0, 0.0, -1.0, 2.0, -1.0, 0.0, 0.0, -1.0, 1.0;
  const two_parts chain(springs{omega * omega * bonds},
                        springs{Eigen::MatrixXd::Identity(4, 4) + 0.5 * bonds, 1.0});
  const phase_points states =
      points_of({{Eigen::Vector4d(0.01, -0.02, 0.0, 0.03), Eigen::Vector4d(0.3, -0.1, 0.2, 0.4)},
                 {Eigen::Vector4d(-0.01, 0.02, 0.01, 0.0), Eigen::Vector4d(0.1, 0.3, -0.3, 0.1)}});
  const examined whole(chain, steps, states);
  const double fastest = 2.0 * omega * std::sin(3.0 * pi / 8.0);
  const double period = 2.0 * pi / fastest;
  const auto objects_at = [&](double h) { return !whole.objection(h).empty(); };
  // The slow forces and Verlet's phase, of 16 steps in a period, move a resonance by less than 1 %.
  for (const double resonant : {0.5 * period, period}) {
    bool is_refused = false;
    for (int k = -20; k <= 20; ++k) is_refused = is_refused || objects_at(resonant * (1.0 + 0.0005 * k));
    BOOST_TEST(is_refused, "at " << resonant);
  }
  for (const double free : {0.75 * period, 1.1 * period}) BOOST_TEST(!objects_at(free), "at " << free);
}

// Whatever the growth in the mean and over the states is, a refusal of either counts.
BOOST_AUTO_TEST_CASE(of_two_growths_a_refused_one_is_the_worse) {
  std::mt19937_64 bits(1);
  std::uniform_real_distribution<double> power(-3.0, 2.0);
  int smaller = 0;
  for (int k = 0; k < 2000; ++k) {
    const auto drawn = [&] {
      const auto [low, high] = std::minmax({std::pow(10.0, power(bits)), std::pow(10.0, power(bits))});
      return detail::growth_of_energy{.early = low, .late = high};
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

BOOST_AUTO_TEST_CASE(states_that_lie_far_apart_have_no_mean_of_however_many_coordinates) {
  for (const Eigen::Index size : {2, 44}) {
    const springs wells{Eigen::MatrixXd::Zero(size, size), 1.0};
    for (const double elsewhere :
         {1.1, 10.0}) {  // of the second the Hessian, 6 q^2, is not near the mean of all
      phase_points states;
      for (int k = 0; k < 8; ++k) {
        states.push_back(
            state{Eigen::VectorXd::Constant(size, k == 5 ? elsewhere : 1.0), Eigen::VectorXd::Ones(size)});
      }
      const two_parts system(wells, wells);
      const detail::word_on_parts parts(system, states, respa.letters());
      BOOST_TEST(parts.has_mean() == (elsewhere < 2.0));
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_analysed_is_said_and_admitted) {
  const examined pair(pair_coupled_by(0.5));
  constexpr word with_turns = word_of<lettered::turn, kick_of_part<0>, lettered::turn>();
  const detail::stability_guard guard(with_letters<two_parts, lettered::turn>(pair.system), of_two,
                                      with_turns, steps);
  BOOST_TEST(guard.parts() == nullptr);
  BOOST_TEST(guard.description().find("was not analysed, as the letter t is neither") != std::string::npos,
             guard.description());
  BOOST_TEST(guard.objection(with_turns, {0.5, 1.0, 0.5}, 0.1).empty());
  // A word with kicks of parts is examined by the guard that was made for it.
  BOOST_TEST(refuses(
      [&] {
        (void)pair.guard.objection(with_turns, {0.5, 1.0, 0.5}, 0.1);
      },
      {"for which the guard was made", "make a guard for this word"}));
  BOOST_TEST(pair.objection(0.1).empty());
  // An ordinary word is examined as ever.
  const nysalt::word ordinary("BAB");
  const detail::stability_guard of_bands(pair.system, of_two, ordinary, steps);
  BOOST_TEST(of_bands.description() ==
             detail::stability_guard(pair.system, of_two, false, steps).description());
  BOOST_TEST(!of_bands.objection(ordinary, {0.5, 1.0, 0.5}, 0.3).empty());
}
