// SPDX-License-Identifier: BSL-1.0
// f'(q) v by dual numbers, by the system's own word, and by differences; and its own derivatives. A system's
// own kick is that of its force, and is used where the force is not needed again.
#include "../laws/models.hpp"
#include "../support/local_systems.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/kernels/kernels.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/lennard_jones.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <field F, Scalar T, System S>
vector<T, S::dimension> along(const S& system, const vector<T, S::dimension>& q,
                              const vector<T, S::dimension>& v) {
  detail::lifted_room<T, S::dimension> room(q.size());
  auto g = detail::make_vector<T>(system);
  detail::force_along<F, T>(system, q, v, g, room);
  return g;
}

/// One that gives f'(q) v over any scalar, and says so by a factor.
struct by_itself : potential_only {
  template <class T>
  void force_derivative(const vector<T, 2>&, const vector<T, 2>& v, vector<T, 2>& g) const {
    for (Eigen::Index i = 0; i < 2; ++i) g[i] = v[i] * 7.0;
  }
};

/// f = -sin q: f'(q) v, and its derivative along dq and dv, -cos(q) dv + sin(q) dq v.
template <System S>
void check_pendulum(const S& system, double tolerance, double tolerance_of_slope) {
  using D = dual<double, 2>;
  draws random;
  for (int n = 0; n < 10; ++n) {
    const double q = random.uniform(-1.0, 1.0);
    const double v = random.uniform(-1.0, 1.0);
    const vector<double, 1> g =
        along<field::whole, double>(system, vector<double, 1>(q), vector<double, 1>(v));
    BOOST_TEST(std::abs(g[0] + std::cos(q) * v) <= tolerance);
    BOOST_TEST(std::abs(test::hessian(system, vector<double, 1>(q))(0, 0) - std::cos(q)) <= tolerance);
    D lifted_q(q);
    D lifted_v(v);
    lifted_q.derivative = {0.3, 0.0};
    lifted_v.derivative = {0.2, -1.1};
    const auto lifted = along<field::whole, D>(system, vector<D, 1>(lifted_q), vector<D, 1>(lifted_v))[0];
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", q = " << q << ", v = " << v) {
      BOOST_TEST(std::abs(lifted.value + std::cos(q) * v) <= tolerance);
      const double first = -std::cos(q) * 0.2 + std::sin(q) * 0.3 * v;
      BOOST_TEST(std::abs(lifted.derivative[0] - first) <= tolerance_of_slope);
      BOOST_TEST(std::abs(lifted.derivative[1] - std::cos(q) * 1.1) <= tolerance_of_slope);
    }
  }
}

/// N masses between walls on springs of 1, the first of another stiffness.
template <int N>
struct springs {
  static constexpr int dimension = N;
  double first = 1.0;
  template <class T>
  T potential(const vector<T, N>& q) const {
    T sum = q[0] * q[0] * (0.5 * first) + q[N - 1] * q[N - 1] * 0.5;
    for (int i = 1; i < N; ++i) sum += (q[i] - q[i - 1]) * (q[i] - q[i - 1]) * 0.5;
    return sum;
  }
};

/// By how much the force of springs, and its derivatives, in lanes, differs from that of equal springs.
template <int N>
double off_springs(const springs<N>& system) {
  using T = nysalt::detail::lanes_with_slopes;
  vector<T, N> q;
  vector<T, N> f;
  for (int i = 0; i < N; ++i) q[i] = T::variable(nysalt::detail::lanes(std::sin(i + 1.0)), 0);
  for (int i = 0; i < N; ++i) q[i].derivative[1] = nysalt::detail::lanes(std::cos(i + 1.0));
  nysalt::force<T>(system, q, f);
  double off = 0.0;
  for (int i = 0; i < N; ++i) {
    const T before = i > 0 ? q[i - 1] : T(0.0);
    const T behind = i + 1 < N ? q[i + 1] : T(0.0);
    const T difference = f[i] - (before - q[i] * 2.0 + behind);
    for (int k = 0; k < pack<double>::lanes; ++k) {
      off = std::max({off, std::abs(lane(difference.value, k)), std::abs(lane(difference.derivative[0], k)),
                      std::abs(lane(difference.derivative[1], k))});
    }
  }
  return off;
}

/// Without the derivative by hand.
template <class S>
struct automatic {
  static constexpr int dimension = S::dimension;
  S system;
  Eigen::Index size() const { return system.size(); }
  template <class T>
  void force(const vector<T, dimension>& q, vector<T, dimension>& f) const {
    system.force(q, f);
  }
};

template <Scalar T, class S>
void check_by_hand(const S& system, const Eigen::VectorXd& q) {
  static_assert(HasForceDerivative<S, T> && !HasForceDerivative<automatic<S>, T>);
  draws random;
  auto at = detail::make_vector<T>(system);
  auto v = at;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    at[i] = T(q[i] + random.uniform(-0.02, 0.02));
    v[i] = T(random.uniform(-1.0, 1.0));
  }
  const auto found = along<field::whole, T>(system, at, v);
  const auto expected = along<field::whole, T>(automatic<S>{system}, at, v);
  double size = 0.0;
  for (Eigen::Index i = 0; i < at.size(); ++i) size = std::max(size, std::abs(lane(expected[i], 0)));
  for (Eigen::Index i = 0; i < at.size(); ++i) {  // sums of some terms that cancel
    BOOST_TEST(std::abs(lane(found[i] - expected[i], 0)) <= 100.0 * eps * size);
  }
  BOOST_TEST(size > 0.1);
}

/// A chain with another force, whose inherited kick and derivative are not of that force.
struct softer : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  template <class T>
  void force(const vector<T, 6>& q, vector<T, 6>& f) const {
    fpu_chain<3>::force(q, f);
    for (auto& entry : f) entry = entry * 0.5;
  }
};
struct softer_for_double : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  void force(const vector<double, 6>& q, vector<double, 6>& f) const { f = -q; }
};
struct renamed : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
};
/// Forces of which it is unknown where they are written, or that are written elsewhere.
struct softer_by_auto : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  void force(const auto& q, auto& f) const { f = -q; }
};
struct softer_and_static : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  template <class T>
  static void force(const vector<T, 6>& q, vector<T, 6>& f) {
    f = -q;
  }
};
struct well {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0] * 0.5;
  }
  template <class T, class C>
  void kick(const vector<T, 1>& q, vector<T, 1>& p, const C& c) const {
    p[0] -= q[0] * c;
  }
};
struct deeper_well : well {
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};
/// A kick for a chain that has a force.
struct kicked : fpu_chain<3> {
  using fpu_chain<3>::fpu_chain;
  template <class T, class C>
  void kick(const vector<T, 6>& q, vector<T, 6>& p, const C& c) const {
    fpu_chain<3>::kick(q, p, c);
  }
};
static_assert(HasKick<kicked, double> && HasKick<counted<kicked>, double>);
static_assert(!HasKick<softer_by_auto, double> && !HasKick<softer_and_static, double>);
static_assert(HasKick<well, double> && !HasKick<deeper_well, double>);
static_assert(HasKick<fpu_chain<3>, double> && HasKick<renamed, double> && HasKick<counted<renamed>, double>);
static_assert(!HasKick<softer, double> && !HasKick<softer_for_double, double>);
static_assert(!HasKick<counted<softer>, double>);
static_assert(HasForceDerivative<fpu_chain<3>> && !HasForceDerivative<softer>);

/// The same of a local system, which inherits the ranges of the old force.
struct stronger : fpu_chain<> {
  using fpu_chain<>::fpu_chain;
  template <class T>
  void force(const vector<T, Eigen::Dynamic>& q, vector<T, Eigen::Dynamic>& f) const {
    fpu_chain<>::force(q, f);
    for (auto& entry : f) entry = entry * 2.0;
  }
};
static_assert(LocalSystem<fpu_chain<>> && LocalSystem<phi4_chain<>> && LocalSystem<phi4_lattice>);
static_assert(LocalSystem<far_springs> && !detail::HasKickInRange<far_springs> && !LocalSystem<stronger>);
static_assert(LocalSystem<deaf_to_the_left> && !detail::HasKickInRange<deaf_to_the_left>);

/// x in the first lane, or with derivatives along the first coordinate, and other numbers elsewhere.
template <Scalar T, int N>
phase_point<T, N> dressed(const phase_point<double, N>& x) {
  auto y = x.template cast<T>();
  if constexpr (detail::is_pack<T>) {
    for (int lane = 1; lane < T::lanes; ++lane) {
      for (Eigen::Index i = 0; i < x.size(); ++i) y.q[i].set(lane, x.q[i] + 0.1 * lane);
    }
  } else if constexpr (detail::is_dual<T>) {
    y.q[0].derivative[0] = 1.0;
  }
  return y;
}

/// kick is p += c force(q), to the bit: then a run does not depend on where the word may use it.
template <Scalar T, Scalar C, System S>
bool kick_is_force(const S& system, const phase_point<T, S::dimension>& x, const C& c) {
  auto f = detail::make_vector<T>(system);
  force<T>(system, x.q, f);
  auto expected = x.p;
  for (Eigen::Index i = 0; i < f.size(); ++i) expected[i] += f[i] * c;
  auto kicked = x.p;
  system.kick(x.q, kicked, c);
  for (Eigen::Index i = 0; i < f.size(); ++i) {
    if (std::memcmp(&kicked[i], &expected[i], sizeof(T)) != 0) return false;
  }
  return true;
}

template <System S>
void check_kick(const S& system) {
  static_assert(HasKick<S, double>);
  using D = dual<double, 1>;
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto x = random.state(system, 1.0);
    BOOST_TEST_CONTEXT(describe(system) << ", draw " << n) {
      BOOST_TEST(kick_is_force(system, x, 0.3));
      BOOST_TEST(kick_is_force(system, dressed<D>(x), 0.3));
      BOOST_TEST(kick_is_force(system, dressed<D>(x), D::variable(0.3, 0)));
      BOOST_TEST(kick_is_force(system, dressed<pack<double, 8>>(x), 0.3));
    }
  }
}

/// What a kick of its own could change: a run, stopped and continued, and a plain step.
bool runs_alike(const model& system, const model& other, const method& method, double step,
                const any_state& x) {
  const run_of one{system, method, step};
  const run_of another{other, method, step};
  return same_bits(one.plain(x, 1), another.plain(x, 1)) &&
         same_bits(one.cut(x, 50, 20), another.finish(x, 50));
}

}  // namespace

// Eigen's own vectors on the stack end at 128 KB, which 13 dual numbers of 13 derivatives in lanes exceed.
BOOST_AUTO_TEST_CASE(a_fixed_dimension_may_be_large) {
  constexpr double rounding = 1e-14;  // of some sums of numbers up to 4
  BOOST_TEST(off_springs(springs<12>()) < rounding);
  BOOST_TEST(off_springs(springs<13>()) < rounding);
  BOOST_TEST(off_springs(springs<14>()) < rounding);
  BOOST_TEST(off_springs(springs<16>()) < rounding);
  BOOST_TEST(off_springs(springs<64>()) < rounding);
  BOOST_TEST(off_springs(springs<64>{1.0 + 1e-6}) > 1e-7);
}

BOOST_AUTO_TEST_CASE(by_dual_numbers_the_derivative_is_the_hessians) {
  draws random;
  const auto check = [&](const auto& system) {
    const auto [q, v] = random.state(system, 1.0);
    const Eigen::VectorXd expected = -test::hessian(system, q) * v;
    // Some ten products of numbers below 4 a coordinate.
    const Eigen::VectorXd found = along<field::whole, double>(system, q, v);
    BOOST_TEST((found - expected).norm() <= 40.0 * static_cast<double>(q.size()) * eps);
    BOOST_TEST(expected.norm() > 1e-3);
  };
  check(potential_only());
  check(dynamic_potential());
  check(two_masses());
  check_pendulum(pendulum(), 4.0 * eps, 8.0 * eps);
}

BOOST_AUTO_TEST_CASE(a_derivative_of_ones_own_goes_first) {
  const vector<double, 2> q(0.3, 0.2);
  const vector<double, 2> v(1.0, -2.0);
  BOOST_TEST((along<field::whole, double>(by_itself(), q, v) == 7.0 * v));
  BOOST_TEST((along<field::whole, double>(potential_only(), q, v) != 7.0 * v));
  using D = dual<double, 1>;
  const vector<D, 2> lifted(D::variable(1.0, 0), D(-2.0));
  const auto found = along<field::whole, D>(by_itself(), q.cast<D>(), lifted);
  BOOST_TEST(found[0].derivative[0] == 7.0);
  // Where it is known over double alone, its derivatives are differences of it: s^2/6, twice, and eps/s.
  constexpr double s = detail::part_of_displacement;
  check_pendulum(black_box_with_derivative(), 4.0 * eps, 2.0 * s * s / 6.0 + 8.0 * eps / s);
}

BOOST_AUTO_TEST_CASE(the_derivative_of_a_black_box_is_a_difference) {
  // s^2/6 and eps/s; and of differences of differences, 10 s along v and along dq, of length 1 and .3, whose
  // cosine terms are (10 s)^2/6 and eps/(100 s^2).
  constexpr double s = detail::part_of_displacement;
  check_pendulum(black_box(), s * s / 6.0 + 4.0 * eps / s,
                 100.0 * s * s / 6.0 * 2.0 + 8.0 * eps / (100.0 * s * s));
  const vector<double, 1> none(0.0);
  BOOST_TEST((along<field::whole, double>(black_box(), vector<double, 1>(0.4), none)[0] == 0.0));
  BOOST_TEST(detail::derivative_source<pendulum>() == "automatic differentiation");
  BOOST_TEST(detail::derivative_source<black_box>() == "central differences of the force");
  BOOST_TEST(detail::derivative_source<black_box_with_derivative>() == "the system's directional derivative");
}

BOOST_AUTO_TEST_CASE(derivatives_by_hand_are_those_of_the_force) {
  const auto all = [](const auto& system, const Eigen::VectorXd& q) {
    check_by_hand<double>(system, q);
    check_by_hand<pack<double, 4>>(system, q);
  };
  const Eigen::VectorXd waves = Eigen::VectorXd::LinSpaced(256, 0.0, 40.0).array().sin();
  all(lennard_jones<2, 7>(), detail::cluster_at_rest(lennard_jones<2, 7>()));
  all(lennard_jones<>(3, 13), detail::cluster_at_rest(lennard_jones<>(3, 13)));
  all(fpu_chain<3>(50.0), waves.head(6));
  all(fpu_chain<>(100, 2.0), waves.head(200));
}

BOOST_AUTO_TEST_CASE(the_derivative_of_the_soft_part_is_that_of_the_soft_force) {
  const auto split = split_masses();
  draws random;
  const auto [q, v] = random.state(split, 1.0);
  const vector<double, 2> soft = along<field::soft, double>(split, q, v);
  for (Eigen::Index i = 0; i < 2; ++i) {
    BOOST_TEST(std::abs(soft[i] + 3.0 * q[i] * q[i] * v[i]) <= 16.0 * eps);  // of terms that cancel
  }
  BOOST_TEST((along<field::whole, double>(split, q, v) - soft).norm() > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_derivative_counts_what_is_called) {
  const auto evaluations = [](const auto& system) {
    using S = std::decay_t<decltype(system)>;
    const counted<S> watched(system);
    auto q = detail::make_vector<double>(system);
    q.setConstant(0.3);
    along<field::whole, double>(watched, q, q);
    return watched.evaluations;
  };
  BOOST_TEST(evaluations(potential_only()) == 1);
  BOOST_TEST(evaluations(dynamic_potential()) == 1);
  BOOST_TEST(evaluations(by_itself()) == 1);
  BOOST_TEST(evaluations(black_box()) == 2);  // a difference
  BOOST_TEST(evaluations(black_box_with_derivative()) == 1);
}

// All systems of the library that have a kick.
BOOST_AUTO_TEST_CASE(a_kick_is_that_of_the_force) {
  check_kick(fpu_chain<3>(10.0));
  check_kick(fpu_chain<>(2, 7.0));
  check_kick(gaussian(Eigen::Vector3d(0.3, 1.0, 2.5)));
  check_kick(phi4_lattice(3, -1.0, 2.0));
}

BOOST_AUTO_TEST_CASE(a_wrong_kick_is_found) {
  draws random;
  const wrong_kick system;
  const auto x = random.state(system, 1.0);
  BOOST_TEST(!kick_is_force(system, x, 0.3));
  BOOST_TEST(!runs_alike(system, without_kick(system), method(verlet()), 0.1, {x.q, x.p}));
}

BOOST_AUTO_TEST_CASE(runs_do_not_depend_on_a_kick_of_ones_own) {
  const fpu_chain<3> chain(10.0);
  const model other{without_kick(chain)};
  draws random;
  try_all({specimen_of(describe(chain))}, methods_as_data(random),
          [&](const model& system, const method& method, double, const any_state& x) {
            BOOST_TEST(runs_alike(system, other, method, 0.01, x));
          });
}

// Such a chain steps by its own force.
BOOST_AUTO_TEST_CASE(an_inherited_kick_or_derivative_of_another_force_is_left_aside) {
  const softer system(50.0);
  const fpu_chain<3> chain(50.0);
  draws random;
  const auto start = random.state(system, 0.5);
  auto x = start;
  auto y = start;
  make_stepper(system, verlet_aba(), 0.01).step(x);
  make_stepper(chain, verlet_aba(), 0.01).step(y);
  BOOST_TEST((x.p - y.p).norm() > 1e-3);
  BOOST_TEST(check_force(system, {x.q}).gradient_defect > 0.1);  // its potential is the stiffer one's
  const vector<double, 6> expected = 0.5 * along<field::whole, double>(chain, start.q, start.p);
  const vector<double, 6> found = along<field::whole, double>(system, start.q, start.p);
  BOOST_TEST((found - expected).norm() <= 10.0 * eps * expected.norm());
}
