// SPDX-License-Identifier: BSL-1.0
// What holds for every system: the force is minus the gradient of the potential, modes diagonalise the
// quadratic part, frequencies lie in the bands, references conserve the energy; and mistakes are found.
// Systems that cannot be are refused with a sentence; what systems say of themselves. In a bath, or with a
// quadratic part split off, a system is what it was. With the time as a coordinate, which drifts carry,
// driven motion has its order, is symplectic and reversible, and is learned.
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/in_time.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/logistic_regression.hpp"
#include "nysalt/systems/textbook.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

struct refusal {
  std::function<void()> made;
  std::vector<std::string> words;
};

std::vector<refusal> refusals() {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2, 2);
  const Eigen::MatrixXd rows = Eigen::MatrixXd::Ones(2, 1);
  const Eigen::Vector2d labels(0.0, 1.0);
  const auto chain = [](const Eigen::MatrixXd& k) { return [=] { linear_chain{k}; }; };
  const auto logistic = [](const Eigen::MatrixXd& x, const Eigen::VectorXd& y, double variance) {
    return [=] { logistic_regression(x, y, variance); };
  };
  std::vector<refusal> all{
      {[] { fpu_chain<>(0, 1.0); }, {"pairs must be", "got 0"}},
      {[] { fpu_chain<3>(2, 1.0); }, {"pairs must be", "got 2"}},
      {[] { phi4_chain<>(0); }, {"masses must be", "got 0"}},
      {[] { phi4_chain<3>(2); }, {"masses must be", "got 2"}},
      {[] { lennard_jones<>(4, 7); }, {"dimension must be 2 or 3", "got 4"}},
      {[] { lennard_jones<2, 7>(3, 7); }, {"dimension", "3"}},
      {[] { lennard_jones<>(2, 1); }, {"atoms must be >= 2", "got 1"}},
      {[] { lennard_jones<2, 7>(2, 8); }, {"got 8"}},
      {chain(Eigen::MatrixXd(2, 3)), {"square", "2 x 3"}},
      {chain(Eigen::MatrixXd(0, 0)), {"square"}},
      {chain(Eigen::Matrix2d{{1.0, 0.5}, {0.4, 1.0}}), {"symmetric"}},
      {chain(Eigen::Matrix2d{{1.0, not_a_number}, {not_a_number, 1.0}}), {"must be finite"}},
      {chain(Eigen::Matrix2d{{1.0, 2.0}, {2.0, 1.0}}), {"must be >= 0, got -"}},
      {[=] { linear_chain(one, Eigen::Vector3d::Ones()); }, {"positive and finite, 2 of them"}},
      {[] { gaussian{Eigen::VectorXd()}; }, {"frequencies", "got 0"}},
      {logistic(rows, Eigen::Vector3d(0.0, 1.0, 1.0), 1.0), {"logistic_regression"}},
      {logistic(Eigen::MatrixXd(), Eigen::VectorXd(), 1.0), {"logistic_regression"}},
      {logistic(rows * not_a_number, labels, 1.0), {"logistic_regression"}},
      {logistic(rows, Eigen::Vector2d(0.0, 2.0), 1.0), {"logistic_regression"}},
  };
  for (const Eigen::Index masses : {0, -1, -1'000'000}) {
    all.push_back(
        {[=] { linear_chain::between_walls(masses, 1.0); }, {"at least one mass", std::to_string(masses)}});
  }
  for (const double bad : {0.0, -1.0, infinite, not_a_number}) {
    all.push_back({[=] { harmonic_oscillator{bad}; }, {"omega", "positive"}});
    all.push_back({[=] { fpu_chain<3>{bad}; }, {"omega", "positive"}});
    all.push_back(
        {[=] { linear_chain(one, Eigen::Vector2d(1.0, bad)); }, {"positive and finite, 2 of them"}});
    all.push_back({[=] { linear_chain::between_walls(3, bad); }, {"spring and mass", "positive"}});
    all.push_back({[=] { linear_chain::between_walls(3, 1.0, bad); }, {"spring and mass", "positive"}});
    all.push_back({[=] { gaussian(Eigen::Vector2d(1.0, bad)); }, {"positive and finite"}});
    all.push_back({logistic(rows, labels, bad), {"logistic_regression"}});
  }
  return all;
}

template <int N>
struct unnamed {
  static constexpr int dimension = N;
  template <class T>
  T potential(const vector<T, N>& q) const {
    return q[0] * q[0];
  }
};
struct unnamed_in_time {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q, const T& t) const {
    return q[0] * t;
  }
};

const auto some_bath = bath::of_sigma(0.01, 0.05);

/// What the concepts say of S is true of S in a bath, and force, energy, masses, modes and kick are the same.
template <System S>
void check_in_bath(const S& alone) {
  using W = in_bath<S>;
  static_assert(NystromSystem<W> && HasBath<W> && W::dimension == S::dimension);
  static_assert(HasEnergy<W> == HasEnergy<S> && HasModes<W> == HasModes<S>);
  static_assert(HasFrequencyBands<W> == HasFrequencyBands<S> && HasInverseMass<W> == HasInverseMass<S>);
  static_assert(HasForceDerivative<W> == HasForceDerivative<S> && BlackBoxForce<W> == BlackBoxForce<S>);
  static_assert(HasKick<W, double> == HasKick<S, double>);
  static_assert(HasKick<counted<W>, double> == HasKick<counted<S>, double>);
  static_assert(detail::lanes_of<W> == detail::lanes_of<S>);
  draws random;
  const W system(alone, some_bath);
  const auto x = random.state(alone, 0.5);
  auto f = detail::make_vector<double>(alone);
  auto g = detail::make_vector<double>(system);
  force<double>(alone, x.q, f);
  force<double>(system, x.q, g);
  BOOST_TEST((f == g));
  if constexpr (HasEnergy<S>) BOOST_TEST(energy<double>(system, x) == energy<double>(alone, x));
  if constexpr (HasModes<S>) BOOST_TEST((system.modes().frequencies == alone.modes().frequencies));
  if constexpr (HasInverseMass<S>) BOOST_TEST(system.inverse_mass(1) == alone.inverse_mass(1));
  if constexpr (HasKick<S, double>) {
    auto p = x.p;
    auto r = x.p;
    alone.kick(x.q, p, 0.3);
    system.kick(x.q, r, 0.3);
    BOOST_TEST((p == r));
  }
}

const in_time<driven_pendulum> pendulum_in_time(driven_pendulum(0.4, 1.7));
const auto start = pendulum_in_time.state({vector<double, 1>(0.5), vector<double, 1>(-0.2)}, 0.3);

template <class M>
phase_point<double, 2> after(const M& method, double step, int steps) {
  return integrate(pendulum_in_time, method, step, start, steps).finish;
}

/// q'' = -q + cos(w t) from rest at q = 0 at the time 0: (cos w t - cos t)/(1 - w^2).
struct driven_oscillator {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q, const T& t) const {
    using std::cos;
    return q[0] * q[0] * 0.5 - q[0] * cos(t * 0.6);
  }
};
/// Unequal masses, each of which counts.
struct driven_pair {
  static constexpr int dimension = 2;
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  template <class T>
  T potential(const vector<T, 2>& q, const T& t) const {
    return (q[0] - q[1]) * (q[0] - q[1]) * 0.5 + q[0] * t;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(force_is_minus_the_gradient_of_the_potential) {
  draws random;
  int tried = 0;
  for (const auto& one : specimens_with([](const model& s) { return s.facts().has_potential_over_slopes; })) {
    ++tried;
    for (int n = 0; n < 20; ++n) {
      BOOST_TEST_CONTEXT(describe(one.system) << ", draw " << n) {
        BOOST_TEST(gradient_defect(one.system, one.at_random(random).q) <= 1.0);
      }
    }
  }
  BOOST_TEST(tried >= 20);
  const model too_strong{wrong_force()};  // by one percent
  BOOST_TEST(gradient_defect(too_strong, random.state(too_strong, 1.0).q) > 1e6);
}

BOOST_AUTO_TEST_CASE(velocity_is_the_gradient_of_the_kinetic_energy) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const vector<double, 1> p(random.uniform(-3.0, 3.0));
    vector<double, 1> by_autodiff;
    vector<double, 1> own;
    velocity<double>(relativistic(), p, by_autodiff);
    velocity<double>(relativistic_with_velocity(), p, own);
    BOOST_TEST(std::abs(by_autodiff[0] - own[0]) <= 4.0 * eps);  // |v| < 1, four operations
  }
  const auto x = random.state(two_masses(), 1.0);
  vector<double, 2> v;
  velocity<double>(two_masses(), x.p, v);
  BOOST_TEST(v[0] == x.p[0]);
  BOOST_TEST(v[1] == 0.25 * x.p[1]);
}

BOOST_AUTO_TEST_CASE(references_conserve_energy) {
  draws random;
  const method srkn{srkn11b()};
  for (const auto& one : specimens_with([](const model& s) { return has_energy(s); })) {
    const auto x = one.at_random(random);
    BOOST_TEST_CONTEXT(describe(one.system)) {
      // 13 evaluations make a step of an error within the tolerance; a rejected one only adds to the count.
      const double tolerance = 1e-12;
      const double error = tolerance * size_of(x) / 13.0 + 8.0 * eps * size_of(x);
      const auto [end, evaluations] = by_odeint(one.system, x, 2.0, tolerance);
      BOOST_TEST(evaluations > 0);
      BOOST_TEST(energy_defect(one.system, x, end, evaluations, error) <= 1.0);
      if (!has_quadratic_kinetic(one.system)) continue;
      // SRKN11b at w h = 5e-3 errs by (w h)^7 < 1e-16 a step; each evaluation rounds q and p.
      const double steps = std::ceil(400.0 * shears_at(one.system, x).frequency());
      const double rounding = 2.0 * eps * size_of(x);
      const auto fine = run_of{one.system, srkn, 2.0 / steps}.finish(x, static_cast<std::int64_t>(steps));
      BOOST_TEST(energy_defect(one.system, x, fine, static_cast<std::int64_t>(11.0 * steps) + 1, rounding) <=
                 1.0);
      const auto coarse =
          run_of{one.system, method(verlet()), 100.0 / steps}.finish(x, 4);  // an honest failure
      BOOST_TEST(energy_defect(one.system, x, coarse, 5, rounding) > 1e3);
    }
  }
}

BOOST_AUTO_TEST_CASE(modes_diagonalise_the_quadratic_part_and_leave_the_soft_force) {
  draws random;
  int tried = 0;
  for (const auto& one : specimens_with([](const model& s) { return has_modes(s); })) {
    const model& system = one.system;
    BOOST_TEST_CONTEXT(describe(system)) {
      if (describe(system).find("with a quadratic part") == std::string::npos) {  // else not V''(0)
        BOOST_TEST(modes_defect(system, system.modes()) <= 1.0);
        auto wrong = system.modes();
        wrong.frequencies.tail(1) *= 1.0 + 1e-6;
        BOOST_TEST(modes_defect(system, wrong) > 10.0);
        wrong = system.modes();
        wrong.basis(0, 0) *= 1.0 + 1e-6;
        BOOST_TEST(modes_defect(system, wrong) > 10.0);
      }
      if (!system.facts().has_quadratic_part) continue;
      ++tried;
      for (int n = 0; n < 20; ++n) {
        const auto q = one.at_random(random).q;
        BOOST_TEST(soft_force_defect(system, q) <= 1.0);
        Eigen::VectorXd soft = q;
        system.soft_force(q, soft);
        if (soft.norm() > 0.0) BOOST_TEST(soft_force_defect(system, q, 1.0 + 1e-6) > 10.0);
      }
    }
  }
  BOOST_TEST(tried >= 8);  // with masses, too
}

BOOST_AUTO_TEST_CASE(linear_systems_have_their_frequencies_in_the_bands) {
  draws random;
  for (const auto& one : specimens_with([](const model& s) {
         const std::string name = describe(s);
         return name.starts_with("harmonic") || name.starts_with("linear_chain");
       })) {
    const auto q = one.at_random(random).q;
    BOOST_TEST(band_defect(one.system, one.system.frequency_bands(), q) <= 1.0);
    const double highest = one.system.frequency_bands().back().high;
    BOOST_TEST(band_defect(one.system, {{0.0, highest * (1.0 - 1e-6)}}, q) > 10.0);
  }
}

// Stated for soft bonds that hold up to 2 each, however far the stiff ones are stretched.
BOOST_AUTO_TEST_CASE(the_bands_of_the_fpu_chain_hold_while_soft_bonds_are_not_overloaded) {
  const fpu_chain<3> chain(10.0);
  const model system(chain);
  const double longest = std::pow(2.0, 0.25);
  draws random;
  int tried = 0;
  double outside = 0.0;
  double outside_half = 0.0;
  while (tried < 200) {
    const auto q = random.state(system, 3.0 * longest).q;
    const std::array bonds{q[0], q[2] - q[1], q[4] - q[3], q[5]};
    if (std::any_of(bonds.begin(), bonds.end(), [&](double u) { return std::abs(u) > longest; })) continue;
    ++tried;
    outside = std::max(outside, band_defect(system, chain.frequency_bands(), q));
    outside_half = std::max(outside_half, band_defect(system, chain.frequency_bands(0.5), q));
  }
  BOOST_TEST(outside <= 1.0);
  BOOST_TEST(outside_half > 10.0);  // bands for a quarter of the energy do not hold
}

// Of phi4 while wells are not overloaded, of the pendulum while it hangs, of Henon's and Heiles' on bounded
// orbits.
BOOST_AUTO_TEST_CASE(bands_hold_where_they_are_declared_for) {
  draws random;
  const auto check = [](const model& system, const std::vector<frequency_band>& narrow,
                        const Eigen::VectorXd& at, const std::function<Eigen::VectorXd()>& random_q) {
    BOOST_TEST_CONTEXT(describe(system)) {
      for (int n = 0; n < 50; ++n)
        BOOST_TEST(band_defect(system, system.frequency_bands(), random_q()) <= 1.0);
      BOOST_TEST(band_defect(system, narrow, at) > 10.0);
    }
  };
  const double pi = std::numbers::pi;
  const phi4_chain<> chain(8);
  const double farthest = std::pow(8.0, 0.25);  // q^4/4 = 2
  Eigen::VectorXd zigzag(8);
  for (int i = 0; i < 8; ++i) zigzag[i] = i % 2 == 0 ? farthest : -farthest;
  BOOST_TEST(band_defect(model(chain), chain.frequency_bands(), zigzag) <= 1.0);
  check(chain, chain.frequency_bands(1.99), zigzag,
        [&]() -> Eigen::VectorXd { return random.state(chain, farthest).q; });
  check(pendulum(), {{0.0, 0.5}}, Eigen::VectorXd::Constant(1, 0.1),
        [&]() -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, random.uniform(-pi, pi)); });
  check(henon_heiles(), henon_heiles().frequency_bands(), Eigen::Vector2d(1.1, 0.0),
        [&]() -> Eigen::VectorXd {
          const double r = random.uniform(0.0, 1.0);
          const double angle = random.uniform(0.0, 2.0 * pi);
          return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
        });
}

// Of many coordinates no full matrix of modes is made, and what is known of them is the same.

BOOST_AUTO_TEST_CASE(entries_of_a_long_chain_are_those_of_the_basis_of_a_short_one) {
  const fpu_chain<> shorter(detail::most_for_full_basis / 2, 50.0);
  const fpu_chain<> longer(detail::most_for_full_basis / 2 + 1, 50.0);
  BOOST_TEST(shorter.modes().entries.empty());
  BOOST_TEST(shorter.modes().basis.rows() == detail::most_for_full_basis);
  BOOST_TEST(longer.modes().basis.size() == 0);
  const auto few = detail::modal_coordinates::of(shorter);
  const auto many = detail::modal_coordinates::of(longer);
  BOOST_TEST(many->entries().size() == few->entries().size() + 4);
  BOOST_TEST(many->frequencies().size() == few->frequencies().size() + 2);
  const Eigen::Index pairs = shorter.pairs();
  for (std::size_t n = 0; n < few->entries().size(); ++n) {
    const auto& a = few->entries()[n];
    const auto& b = many->entries()[n];
    // Stiff modes come after all soft ones, of which the longer chain has one more.
    const Eigen::Index mode = a.mode < pairs ? a.mode : a.mode + 1;
    const bool is_same = a.coordinate == b.coordinate && mode == b.mode && a.heavy == b.heavy;
    if (!is_same) BOOST_ERROR("entry " << n << " differs");
  }
  BOOST_TEST(frequency_to_fit(longer) == 50.0);
}

BOOST_AUTO_TEST_CASE(entries_of_modes_that_are_not_there_are_refused) {
  const fpu_chain<> chain(800, 50.0);
  normal_modes wrong = chain.modes();
  wrong.entries[3].mode = chain.size();
  struct told : fpu_chain<> {
    explicit told(normal_modes given) : fpu_chain<>(800, 50.0), all(std::move(given)) {}
    normal_modes modes() const { return all; }
    normal_modes all;
  };
  BOOST_CHECK_THROW(detail::modal_coordinates::of(told(wrong)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_long_ring_has_no_modes_and_a_model_says_so) {
  BOOST_TEST(has_modes(phi4_chain<>(detail::most_for_full_basis)));
  BOOST_TEST(!has_modes(phi4_chain<>(detail::most_for_full_basis + 1)));
  BOOST_TEST(has_modes(model(phi4_chain<>(16))));
  BOOST_TEST(!has_modes(model(phi4_chain<>(detail::most_for_full_basis + 1))));
  BOOST_TEST(has_modes(model(fpu_chain<>(detail::most_for_full_basis, 50.0))));
}

BOOST_AUTO_TEST_CASE(systems_that_cannot_be_are_refused) {
  for (const auto& [made, words] : refusals()) {
    BOOST_TEST_CONTEXT("words " << words.front()) {
      BOOST_TEST(refuses(made, {words.front(), words.back()}));
    }
  }
  BOOST_TEST(linear_chain(Eigen::MatrixXd::Ones(2, 2)).modes().frequencies[0] == 0.0);  // singular is allowed
  BOOST_TEST(linear_chain::between_walls(1, 2.0).modes().frequencies[0] == 2.0);
  BOOST_CHECK_NO_THROW(logistic_regression(Eigen::MatrixXd::Ones(2, 1), Eigen::Vector2d(0.0, 1.0), 1.0));
}

BOOST_AUTO_TEST_CASE(a_chain_between_walls_has_the_known_frequencies) {
  const auto modes = linear_chain::between_walls(3, 2.0, 0.5).modes();
  for (int k = 0; k < 3; ++k) {  // w = 2 sqrt(spring/mass) sin(k pi/(2 (n + 1)))
    const double expected = 4.0 * std::sin((k + 1) * std::numbers::pi / 8.0);
    BOOST_TEST(std::abs(modes.frequencies[k] - expected) <= 8.0 * 3.0 * eps * 4.0);
  }
}

// The paper's formula, term by term, in the coordinates of the modes.
BOOST_AUTO_TEST_CASE(the_stiff_energy_is_that_of_the_stiff_modes) {
  const fpu_chain<3> chain(50.0);
  draws random;
  const auto x = random.state(chain, 1.0);
  const auto modes = chain.modes();
  double sum = 0.0;
  for (int j = 0; j < 3; ++j) {
    const double x1 = modes.basis.col(3 + j).dot(x.q);
    const double y1 = modes.basis.col(3 + j).dot(x.p);
    const double expected = 0.5 * (y1 * y1 + 2500.0 * x1 * x1);
    sum += expected;
    BOOST_TEST(chain.stiff_energy(x, j) == expected, tolerance(1e-14));  // 20 roundings
  }
  BOOST_TEST(chain.stiff_energy(x) == sum, tolerance(1e-14));
}

BOOST_AUTO_TEST_CASE(systems_say_what_they_are) {
  BOOST_TEST(describe(harmonic_oscillator(2.0)) == "harmonic_oscillator(omega=2)");
  BOOST_TEST(describe(fpu_chain<3>(50.0)) == "fpu_chain(pairs=3, omega=50)");
  BOOST_TEST(describe(fpu_chain<>(3, 50.0)) == describe(fpu_chain<3>(50.0)));
  BOOST_TEST(describe(kepler()) == "kepler()");
  BOOST_TEST(describe(phi4_chain<4>()) == "phi4_chain(masses=4)");
  BOOST_TEST(describe(lennard_jones<2, 7>()) == "lennard_jones(space=2, atoms=7)");
  BOOST_TEST(describe(lennard_jones<>(2, 7)) == describe(lennard_jones<2, 7>()));
  // FNV-1a as published, over the bytes of K and the inverse masses, by another program.
  BOOST_TEST(describe(linear_chain(Eigen::MatrixXd::Constant(1, 1, 4.0))) ==
             "linear_chain(masses=1, omega_max=2, fingerprint=2668491c07f49808)");
  const Eigen::MatrixXd k{{2.0, -1.0}, {-1.0, 2.0}};
  BOOST_TEST(describe(linear_chain(k, Eigen::Vector2d(1.0, 4.0))).find("fingerprint=84492e0f2b897ac5)") !=
             std::string::npos);
  // Without a description by the name of the type as it is written.
  BOOST_TEST(describe(dynamic_potential{4}) == "nysalt::test::dynamic_potential with 4 degrees of freedom");
  BOOST_TEST(describe(counted(dynamic_potential{4})) == describe(dynamic_potential{4}));
  BOOST_TEST(describe(unnamed<2>()).ends_with("unnamed<2> with 2 degrees of freedom"));
  BOOST_TEST(in_time<unnamed_in_time>().description().ends_with("unnamed_in_time in time"));
}

// Margins at which exp() would overflow, and descriptions that differ where the data differ.
BOOST_AUTO_TEST_CASE(a_logistic_regression_is_finite_far_out_and_known_by_its_data) {
  const Eigen::MatrixXd rows{{1.0, 0.5, -2.0}, {1.0, -1.5, 0.3}, {1.0, 2.0, 1.0}, {1.0, 0.1, -0.7}};
  const logistic_regression posterior(rows, Eigen::Vector4d(1.0, 0.0, 1.0, 0.0), 4.0);
  const Eigen::Vector3d far(3000.0, -2000.0, 1000.0);
  // log(1 + exp(m)) = m to rounding for the two rows that are on the wrong side.
  const auto tail = [](double margin) { return std::max(-margin, 0.0); };
  const double expected = tail(3000.0 - 1000.0 - 2000.0) + tail(-(3000.0 + 3000.0 + 300.0)) +
                          tail(3000.0 - 4000.0 + 1000.0) + tail(-(3000.0 - 200.0 - 700.0)) +
                          far.squaredNorm() / 8.0 + 2.0 * std::log(2.0);  // two margins are 0
  BOOST_TEST(posterior.potential<double>(far) == expected, tolerance(1e-12));
  Eigen::VectorXd f(3);
  posterior.force<double>(far, f);
  BOOST_TEST(f.allFinite());
  Eigen::MatrixXd others = Eigen::MatrixXd::Ones(4, 3);
  const Eigen::Vector4d labels(1.0, 0.0, 1.0, 0.0);
  const std::string first = logistic_regression(others, labels, 4.0).description();
  BOOST_TEST(logistic_regression(others, labels, 4.0).description() == first);
  BOOST_TEST(logistic_regression(others, 1.0 - labels.array(), 4.0).description() != first);
  BOOST_TEST(logistic_regression(others, labels, 5.0).description() != first);
  others(3, 2) = 1.5;
  BOOST_TEST(logistic_regression(others, labels, 4.0).description() != first);
}

static_assert(HasBath<in_bath<fpu_chain<3>>> && !HasBath<fpu_chain<3>>);
static_assert(HasBath<counted<in_bath<fpu_chain<3>>>> && HasBath<in_bath<counted<fpu_chain<3>>>>);
static_assert(detail::lanes_of<in_bath<black_box>> == 1 &&
              detail::lanes_of<in_bath<pendulum>> == pack<double>::lanes);

// With modes, masses, bands, kicks, a force alone; fixed and dynamic.
BOOST_AUTO_TEST_CASE(in_a_bath_it_is_what_the_system_is) {
  check_in_bath(free_chain());
  check_in_bath(fpu_chain<3>(10.0));
  check_in_bath(black_box_with_derivative());
}

BOOST_AUTO_TEST_CASE(a_system_names_its_bath_if_that_acts) {
  const fpu_chain<3> chain(50.0);
  const in_bath system(chain, some_bath);
  BOOST_TEST(system.bath().sigma() == 0.05);
  BOOST_TEST(system.bath().friction() == 0.01);
  BOOST_TEST(counted(system).bath().sigma() == 0.05);
  BOOST_TEST(describe(system) == "fpu_chain(pairs=3, omega=50) in bath(friction=0.01, sigma=0.05)");
  BOOST_TEST(describe(counted(system)) == describe(system));
  BOOST_TEST(describe(system.base()) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.0, 0.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_temperature(0.0, 1.0))) == describe(chain));
  BOOST_TEST(describe(in_bath(chain, bath::of_sigma(0.1, 0.0))) != describe(chain));
  // Another bath, another system: what was learned in one is not for the other.
  BOOST_TEST(describe(system) != describe(in_bath(chain, bath::of_sigma(0.01, 0.06))));
  const potential_only unnamed;
  BOOST_TEST(describe(in_bath(unnamed, some_bath)) == describe(unnamed) + " in " + some_bath.description());
}

// A quadratic part split off.

static_assert(HasQuadraticPart<with_quadratic_part<two_masses>>);
static_assert(HasQuadraticPart<with_quadratic_part<potential_only>>);
static_assert(!HasQuadraticPart<two_masses> && !HasQuadraticPart<potential_only>);

BOOST_AUTO_TEST_CASE(the_modes_are_those_of_the_matrix_and_the_masses) {
  const auto modes = split_masses().modes();
  BOOST_TEST(modes.frequencies[0] == 0.0);
  BOOST_TEST(std::abs(modes.frequencies[1] - std::sqrt(1.25)) <= 8.0 * eps);  // 1/m1 + 1/m2
  const with_quadratic_part split(henon_heiles(), Eigen::MatrixXd::Identity(2, 2) * 4.0);
  BOOST_TEST((split.modes().frequencies - Eigen::Vector2d(2.0, 2.0)).norm() <= 8.0 * eps);
  BOOST_TEST(describe(split) == describe(henon_heiles()) + " with a quadratic part of frequencies up to 2");
  BOOST_TEST(describe(split.base()) == describe(henon_heiles()));
  const auto made = [](const Eigen::MatrixXd& stiffness) {
    return [=] { with_quadratic_part(henon_heiles(), stiffness); };
  };
  BOOST_TEST(refuses(made(Eigen::MatrixXd::Identity(3, 3)), {"with_quadratic_part"}));
  BOOST_TEST(refuses(made(-Eigen::MatrixXd::Identity(2, 2)), {"with_quadratic_part", "must be >= 0"}));
  BOOST_TEST(refuses(made(Eigen::MatrixXd{{1.0, 2.0}, {0.0, 1.0}}), {"symmetric"}));
  BOOST_TEST(!refuses(made(Eigen::MatrixXd::Zero(2, 2)), {}));
}

BOOST_AUTO_TEST_CASE(time_goes_as_it_does) {
  const auto end = after(verlet(), 0.125, 80);  // sums of eighths are exact
  BOOST_TEST(pendulum_in_time.time(start) == 0.3);
  BOOST_TEST(std::abs(pendulum_in_time.time(end) - 10.3) <= 80.0 * 10.0 * eps);
  BOOST_TEST(pendulum_in_time.at_its_time(start).q[0] == 0.5);
  BOOST_TEST(pendulum_in_time.at_its_time(start).p[0] == -0.2);
  BOOST_CHECK_THROW(driven_pendulum(not_a_number, 1.0), std::invalid_argument);
  BOOST_CHECK_THROW(pendulum_in_time.state({vector<double, 1>(0.0), vector<double, 1>(0.0)}, infinite),
                    std::invalid_argument);
  static_assert(!NystromSystem<in_time<driven_pendulum>> && SeparableSystem<in_time<driven_pendulum>>);
}

// S6 at a step of .01 errs by some 1e-13, and rounding of 1000 steps by as much.
BOOST_AUTO_TEST_CASE(a_driven_oscillator_goes_where_it_must) {
  const in_time<driven_oscillator> system;
  const auto from = system.state({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.0);
  const auto end = integrate(system, blanes_moan_s6(), 0.01, from, 1000).finish;
  const double exact = (std::cos(6.0) - std::cos(10.0)) / (1.0 - 0.36);
  BOOST_TEST(std::abs(end.q[0] - exact) <= 1e-11);
  BOOST_TEST(std::abs(end.q[0] - (std::cos(6.06) - std::cos(10.0)) / 0.64) > 1e-3);
}

BOOST_AUTO_TEST_CASE(masses_of_driven_systems_count) {
  const in_time<driven_pair> system;
  const auto x = system.state({{0.1, 0.2}, {1.0, 2.0}}, 0.5);
  vector<double, 3> v;
  system.velocity(x.p, v);
  BOOST_TEST(v[0] == 1.0);
  BOOST_TEST(v[1] == 0.5);
  BOOST_TEST(v[2] == 1.0);
  BOOST_TEST(std::abs(energy<double>(system, x)) <= 4.0 * eps);
  BOOST_TEST(check_force(system, {x.q}, {x.p}).passed());
}

// Four products a sum, of entries of order one, each off by some hundred roundings.
BOOST_AUTO_TEST_CASE(steps_are_symplectic_and_go_back) {
  BOOST_TEST(symplecticity_defect(pendulum_in_time, pefrl(), 0.2, start) <= 4.0 * 100.0 * eps);
  auto x = start;
  make_stepper(pendulum_in_time, pefrl(), 0.2).step(x);
  BOOST_TEST(distance(x, start) > 0.01);
  make_stepper(pendulum_in_time, pefrl(), -0.2).step(x);
  BOOST_TEST(distance(x, start) <= 100.0 * eps);
}

BOOST_AUTO_TEST_CASE(a_method_is_learned_on_driven_motion) {
  std::vector<phase_point<double, 2>> states;
  for (int k = 0; k < 32; ++k) {
    states.push_back(pendulum_in_time.state(
        {vector<double, 1>(0.05 * k - 0.8), vector<double, 1>(0.3 - 0.02 * k)}, 0.37 * k));
  }
  const auto data = [&](std::ptrdiff_t from) {
    const listed<2> starts({states.begin() + from, states.begin() + from + 16});
    return make_flow_map_data(pendulum_in_time, starts, fine_steps(0.01, blanes_moan_s6()),
                              {.step = 0.5, .horizon = 5.0, .trajectories = 16, .seed = 1});
  };
  const auto found = learn(aba<3>(), pendulum_in_time, data(0), data(16), {.random_starts = 4});
  BOOST_TEST(found.summary.usable, found.summary.reason);
  BOOST_TEST(found.summary.held_out_loss < 0.6 * found.summary.held_out_start_loss);
}
