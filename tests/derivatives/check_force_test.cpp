// SPDX-License-Identifier: BSL-1.0
// The checks find what people get wrong in a force or in a letter, say where, and do not cry wolf.
#include "nysalt/derivatives/check_force.hpp"

#include "../laws/models.hpp"
#include "../support/local_systems.hpp"
#include "../support/refusal.hpp"
#include "../support/systems_with_letters.hpp"
#include "nysalt/derivatives/check_letter.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

force_check check(const specimen& one) {
  draws random;
  std::vector<Eigen::VectorXd> at;
  for (int n = 0; n < 5; ++n) at.emplace_back(one.at_random(random).q);
  return check_force(one.system, at);
}
force_check check(const model& system) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  return check({system, {zero, zero, 0.5}});
}
bool says(const force_check& result, const std::string& words) {
  return result.report().find(words) != std::string::npos;
}
/// Each is refused, and its report has these words.
void all_say(const std::vector<force_check>& results, const std::string& words) {
  for (const auto& result : results) {
    BOOST_TEST(!result.passed(), result.report());
    BOOST_TEST(says(result, words), result.report());
  }
}

/// The galaxy with mistakes in the second coordinate.
struct mistaken : henon_heiles {
  double factor = 1.0;               // of the force
  double added = 0.0;                // a constant of the force
  double of_kick = 1.0;              // a factor of the kick
  double of_soft = 1.0;              // a factor of the soft force
  bool forgets_coefficient = false;  // of the kick
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    henon_heiles::force(q, f);
    f[1] = f[1] * factor + added;
  }
  template <class T, class C>
  void kick(const vector<T, 2>& q, vector<T, 2>& p, const C& c) const {
    vector<T, 2> f;
    force(q, f);
    f[1] = f[1] * of_kick;
    for (Eigen::Index i = 0; i < 2; ++i) p[i] += forgets_coefficient ? f[i] * C(1.0) : f[i] * c;
  }
  template <class T>
  void soft_force(const vector<T, 2>& q, vector<T, 2>& f) const {
    henon_heiles::soft_force(q, f);
    f[1] = f[1] * of_soft;
  }
};

/// A force without potential that turns states around: conservative only without the twist.
struct twisted {
  static constexpr int dimension = 2;
  double twist = 0.0;
  template <class T>
  void force(const vector<T, 2>& q, vector<T, 2>& f) const {
    f[0] = -q[0] - q[1] * twist;
    f[1] = -q[1] + q[0] * twist;
  }
};

/// The same for double only.
struct twisted_box {
  static constexpr int dimension = 2;
  double twist = 0.0;
  void force(const vector<double, 2>& q, vector<double, 2>& f) const { twisted{twist}.force(q, f); }
};

/// A black box whose potential is one, too.
struct double_only {
  static constexpr int dimension = 2;
  double factor = 1.0;
  double potential(const vector<double, 2>& q) const { return henon_heiles().potential(q); }
  void force(const vector<double, 2>& q, vector<double, 2>& f) const {
    henon_heiles().force(q, f);
    f[0] *= factor;
  }
};

/// A black box that can be differentiated, in one entry wrongly.
struct with_derivative {
  static constexpr int dimension = 2;
  double factor = 1.0;  // of the derivative
  double added = 0.0;   // off the diagonal, on both sides
  void force(const vector<double, 2>& q, vector<double, 2>& f) const { f = -q; }
  void force_derivative(const vector<double, 2>&, const vector<double, 2>& v, vector<double, 2>& g) const {
    g = vector<double, 2>(-v[0] + added * v[1], -v[1] + added * v[0]) * factor;
  }
};

/// K = sqrt(1 + p^2) with a velocity that may have a mistake, over any scalar.
struct fast : henon_heiles {
  double factor = 1.0;  // of the second coordinate
  double twist = 0.0;
  template <class T>
  void velocity(const vector<T, 2>& p, vector<T, 2>& v) const {
    using std::sqrt;
    const T energy = sqrt(p[0] * p[0] + p[1] * p[1] + 1.0);
    v[0] = p[0] / energy - p[1] * twist;
    v[1] = p[1] / energy * factor + p[0] * twist;
  }
};
struct fast_with_energy : fast {
  template <class T>
  T kinetic_energy(const vector<T, 2>& p) const {
    using std::sqrt;
    return sqrt(p[0] * p[0] + p[1] * p[1] + 1.0);
  }
};

/// The same for double only.
struct fast_box : henon_heiles {
  double twist = 0.0;
  void velocity(const vector<double, 2>& p, vector<double, 2>& v) const {
    fast mine;
    mine.twist = twist;
    mine.velocity(p, v);
  }
};
struct fast_box_with_energy : fast_box {
  double kinetic_energy(const vector<double, 2>& p) const { return fast_with_energy().kinetic_energy(p); }
};

/// A chain of quartic wells whose force is wrong at one site, and may turn states around there.
struct long_chain : dynamic_potential {
  double factor = 1.0;
  double twist = 0.0;
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    for (Eigen::Index i = 0; i < masses; ++i) {
      f[i] = q[(i + 1) % masses] + q[(i + masses - 1) % masses] - q[i] * 2.0 - q[i] * q[i] * q[i];
    }
    f[5] = f[5] * factor + q[6] * twist;
    f[6] = f[6] - q[5] * twist;
  }
};
struct long_twisted : long_chain {
  void potential() const = delete;
};
/// V = |q|, and the force 0 at the kink.
struct kinked {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return select(q[0] < 0.0, q[0] * -1.0, q[0]);
  }
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = select(q[0] < 0.0, T(1.0), select(q[0] > 0.0, T(-1.0), T(0.0)));
  }
};

template <class System>
System with(auto member, auto value) {
  System system;
  system.*member = value;
  return system;
}

const std::vector<phase_point<double, Eigen::Dynamic>> points{
    {Eigen::Vector2d(0.1, -0.2), Eigen::Vector2d(0.3, 0.1)},
    {Eigen::Vector2d(-0.3, 0.25), Eigen::Vector2d(0.05, -0.2)}};

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
  static constexpr char letter = 'h';
  static constexpr bool additive = false;
};
/// The flow of q_1 p_2 - q_2 p_1: with -p it turns the other way.
struct spin : exact_flow<'p'> {
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
  static constexpr char letter = 'o';
  static constexpr bool reversible = false;
};
/// Its value is right, and its derivative is lost.
struct without_slope : exact_flow<'w'> {
  static constexpr bool moves_q = false;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    const C value = [&] {
      if constexpr (requires { t.value; })
        return C(t.value);
      else
        return t;
    }();
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] -= x.q[i] * value;
  }
};
struct not_a_number : lettered::turn {
  static constexpr char letter = 'n';
  template <System S, class State, class C>
  static void apply(const S&, const C&, State& x, auto&) {
    x.q[0] = x.q[0] * std::nan("");
  }
};
/// A slip of one part in ten thousand is far above the tolerance, whatever the units.
struct slightly_off : lettered::turn {
  static constexpr char letter = '1';
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    turn::apply(system, t, x, room);
    x.p[0] = x.p[0] * 1.0001;
  }
};
const model galaxy_with_letters(
    with_letters<henon_heiles, lettered::turn, lettered::slipped_turn, lettered::even_turn,
                 lettered::moving_kick, leapfrog, honest_leapfrog, spin, honest_spin, without_slope,
                 not_a_number, slightly_off>{});

std::string report(char letter, double h = 0.7) {
  const letter_check found = check_letter(galaxy_with_letters, letter, points, h);
  BOOST_TEST(found.passed() == found.report().ends_with("is what it states"));
  return found.report();
}

}  // namespace

BOOST_AUTO_TEST_CASE(right_forces_pass) {
  for (const auto& one : specimens()) {
    const auto result = check(one);
    BOOST_TEST(result.passed(), describe(one.system) << ": " << result.report());
    BOOST_TEST(says(result, result.has_potential ? "the force is -grad V" : "the force is conservative"));
    if (!has_exact_derivatives(one.system)) continue;
    // Derivatives of some hundred operations.
    BOOST_TEST(std::max(result.gradient_defect, result.asymmetry) <= 100.0 * eps, describe(one.system));
  }
}

BOOST_AUTO_TEST_CASE(mistakes_are_found_and_the_coordinate_named) {
  for (const auto& result :
       {check(with<mistaken>(&mistaken::factor, -1.0)), check(with<mistaken>(&mistaken::factor, 1.0001)),
        check(with<mistaken>(&mistaken::added, 1e-5))}) {
    all_say({result}, "not -grad V: coordinate 2");
    BOOST_TEST(result.coordinate == 1);
  }
  // The second coordinate of the force is often the largest, and then off by one part in 101 of it.
  const double by_one_percent = check(with<mistaken>(&mistaken::factor, 1.01)).gradient_defect;
  BOOST_TEST((by_one_percent <= 0.01 && by_one_percent > 0.001), by_one_percent);
  all_say({check(double_only{1.001})}, "coordinate 1");
}

BOOST_AUTO_TEST_CASE(forces_that_are_no_gradient_are_found) {
  for (const auto& right : {check(twisted()), check(twisted_box())}) {
    BOOST_TEST((right.passed() && !right.has_potential && says(right, "conservative")));
  }
  const auto of_potential = check(double_only());
  BOOST_TEST((of_potential.passed() && of_potential.has_potential && says(of_potential, "-grad V")));
  all_say({check(twisted{1e-3}), check(twisted_box{1e-2})}, "not conservative");
}

BOOST_AUTO_TEST_CASE(wrong_derivatives_of_right_forces_are_found) {
  BOOST_TEST(check(with_derivative()).passed());
  // The last is symmetric, so that nothing else could tell.
  all_say({check(with_derivative{-1.0}), check(with_derivative{0.0}), check(with_derivative{1.001}),
           check(with_derivative{1.0, 1e-3})},
          "force_derivative is not f'(q) v");
  // The difference of a linear force errs by rounding alone: eps/cbrt(eps).
  BOOST_TEST(std::abs(check(with_derivative{1.001}).derivative_defect - 0.001 / 1.001) <= 1e-9);
}

BOOST_AUTO_TEST_CASE(kicks_and_soft_forces_that_are_not_those_of_the_force_are_found) {
  BOOST_TEST(check(mistaken()).kick_defect <= 4.0 * eps);
  BOOST_TEST(check(mistaken()).soft_defect <= 100.0 * eps);
  BOOST_TEST(check(mistaken()).passed());
  const auto kick = check(with<mistaken>(&mistaken::of_kick, 1.01));
  all_say({kick}, "the kick is not p += c force(q): coordinate 2");
  BOOST_TEST(kick.kick_defect > 1e-3);
  BOOST_TEST(check(with<mistaken>(&mistaken::forgets_coefficient, true)).kick_defect > 0.1);
  const auto soft = check(with<mistaken>(&mistaken::of_soft, 1.01));
  all_say({soft}, "the soft_force is not the force without the quadratic part");
  BOOST_TEST(says(soft, "coordinate 2"));
}

BOOST_AUTO_TEST_CASE(ranges_that_are_not_of_the_force_are_found) {
  for (const model& system : {model(far_springs(17)), model(phi4_chain<>(13))}) {
    const auto result = check(system);
    BOOST_TEST(result.passed(), describe(system) << ": " << result.report());
    BOOST_TEST(result.range_defect <= 8.0 * eps);  // the same operations
  }
  BOOST_TEST(says(check(short_sighted(30)), "force_in_range reads sites beyond reach()"));
  BOOST_TEST(says(check(deaf_to_the_left(30)), "force_in_range or kick_in_range is not the force"));
}

BOOST_AUTO_TEST_CASE(wrong_velocities_are_found) {
  for (const auto& result : {check(fast()), check(fast_with_energy()), check(fast_box()),
                             check(fast_box_with_energy()), check(relativistic_with_velocity())}) {
    BOOST_TEST_CONTEXT(result.report()) BOOST_TEST(result.passed());
  }
  all_say({check(with<fast_with_energy>(&fast_with_energy::factor, 1.0001)),
           check(with<fast_with_energy>(&fast_with_energy::factor, -1.0)),
           check(with<fast_with_energy>(&fast_with_energy::twist, 1e-3)),
           check(with<fast_box_with_energy>(&fast_box_with_energy::twist, 1e-2))},
          "the velocity is not grad K: coordinate");
  BOOST_TEST(check(with<fast_with_energy>(&fast_with_energy::factor, 1.01)).velocity_coordinate == 1);
  all_say({check(with<fast>(&fast::twist, 1e-3)), check(with<fast>(&fast::factor, 1.1)),
           check(with<fast_box>(&fast_box::twist, 1e-2))},
          "the velocity is not the gradient of any K");
}

BOOST_AUTO_TEST_CASE(a_large_system_is_looked_at_along_a_few_directions) {
  for (const Eigen::Index masses : {64, 65, 10'000}) {
    BOOST_TEST(check(long_chain{{masses}}).passed());
    all_say({check(long_chain{{masses}, 1.001})},
            masses > 64 ? "along a direction at random" : "coordinate 6");
    BOOST_TEST(says(check(long_twisted{{{masses}}}), "is conservative"));
    all_say({check(long_twisted{{{masses}, 1.0, 1e-3}})}, "not conservative");
  }
}

BOOST_AUTO_TEST_CASE(a_kink_is_told_from_a_mistake) {
  const vector<double, 1> at_kink(0.0);
  const vector<double, 1> elsewhere(0.5);
  BOOST_TEST(check_force(kinked(), {elsewhere}).passed());
  const auto result = check_force(kinked(), {elsewhere, at_kink});
  all_say({result}, "not -grad V");
  BOOST_TEST(says(result, "where there is a kink"));
  BOOST_TEST(!says(check(with<mistaken>(&mistaken::factor, 1.01)), "kink"));
}

// Forces vanish there, and with them what their errors are relative to.
BOOST_AUTO_TEST_CASE(where_all_is_at_rest_rounding_is_no_mistake) {
  const linear_chain shifted = free_chain();
  const Eigen::VectorXd anywhere = Eigen::VectorXd::Constant(3, 0.3);  // no spring is stretched
  BOOST_TEST(check_force(shifted, {anywhere}).passed());
  BOOST_TEST(check_force(double_only(), {vector<double, 2>(0.0, 0.0)}).passed());
  BOOST_TEST(!check_force(twisted{1e-3}, {vector<double, 2>(0.0, 0.0)}).passed());
}

BOOST_AUTO_TEST_CASE(velocities_are_looked_at_where_the_momenta_are) {
  fast_with_energy twisted_far;
  twisted_far.twist = 1e-3;
  const vector<double, 2> q(0.1, 0.2);
  const vector<double, 2> at_rest(0.0, 0.0);
  BOOST_TEST(check_force(twisted_far, {q}, {at_rest}).passed());
  BOOST_TEST(!check_force(twisted_far, {q}, {q}).passed());
}

BOOST_AUTO_TEST_CASE(there_must_be_points_and_they_must_fit) {
  BOOST_TEST(refuses([] { check_force(twisted{1.0}, {}); }, {"check_force", "points must be one or more"}));
  const model& galaxy = galaxy_with_letters;
  BOOST_TEST(refuses([&] { check_letter(galaxy, 't', {}, 0.7); }, {"points must not be empty"}));
  BOOST_TEST(refuses([&] { check_letter(galaxy, 't', points, 0.7, {1.0, 2.0}); }, {"must be 1", "got 2"}));
  BOOST_TEST(refuses([&] { check_letter(galaxy, '7', points, 0.7); }, {"7 with the letter 7"}));
  BOOST_TEST(refuses([&] { check_letter(galaxy, 'O', points, 0.7); }, {"a letter other than O"}));
  BOOST_TEST(refuses([&] { check_letter(dynamic_potential(), 'A', points, 0.7); }, {"must fit the system"}));
  const std::vector<Eigen::VectorXd> unequal{Eigen::VectorXd::Ones(3), Eigen::VectorXd::Ones(2)};
  BOOST_TEST(refuses([&] { check_force(dynamic_potential(), unequal); },
                     {"point 2 must have 3 coordinates", "got 2"}));
  const vector<double, 2> q(0.1, 0.2);
  BOOST_TEST(refuses([&] { check_force(twisted(), {q, q}, {q}); }, {"2 points with 1 momenta"}));
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_does_not_pass) {
  const double nothing = std::nan("");
  all_say({check(with<mistaken>(&mistaken::factor, nothing)), check(twisted{nothing}),
           check(double_only{nothing}), check(with_derivative{nothing}),
           check(with<fast>(&fast::twist, nothing))},
          "not finite");
}

// Letters of the library: flows/letters_test.cpp.
BOOST_AUTO_TEST_CASE(what_is_so_passes) {
  for (const char letter : {'t', 'h', 'o'}) {
    BOOST_TEST(report(letter) == std::string("the letter ") + letter + " is what it states");
  }
  BOOST_TEST(report('t', -30.0) == report('t'));
}

BOOST_AUTO_TEST_CASE(what_is_not_so_is_refused_by_name) {
  const auto refused = [](char letter, const std::string& words) {
    const std::string said = report(letter);
    BOOST_TEST(said.starts_with(std::string("the letter ") + letter + words), said);
  };
  refused('s', " is not symplectic: it is off by ");
  refused('e', " is not taken back by negated coefficients: it is off by ");
  refused('l', " is not additive: it is off by ");
  refused('p', " is not reversible: it is off by ");
  refused('m', " moves q, but states moves_q = false; say true");
  refused('w', " has a derivative by its coefficients that is off");
  refused('n', " is not finite, or has no finite derivatives, at a point");
}

BOOST_AUTO_TEST_CASE(units_do_not_matter) {
  auto tiny = points;
  for (auto& x : tiny) {
    x.q *= 1e-30;
    x.p *= 1e-30;
  }
  BOOST_TEST(check_letter(galaxy_with_letters, 't', tiny, 0.7).passed());
  for (const auto& at : {tiny, points}) {
    BOOST_TEST(!check_letter(galaxy_with_letters, '1', at, 0.7).passed());
  }
}
