// SPDX-License-Identifier: BSL-1.0
// A system's own kick is that of its force, and is used where the force is not needed again.
#include <boost/test/unit_test.hpp>

#include <cstring>

#include "../laws/laws.hpp"
#include "../support/systems.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/phi4_lattice.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// A chain with another force, whose inherited kick is not of that force.
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

/// x in the first lane, or with derivatives along the first coordinate, and other numbers elsewhere.
template <Scalar T, int N>
phase_point<T, N> dressed(const phase_point<double, N>& x) {
  auto y = x.template cast<T>();
  if constexpr (is_pack<T>) {
    for (int lane = 1; lane < T::lanes; ++lane) {
      for (Eigen::Index i = 0; i < x.size(); ++i) y.q[i].set(lane, x.q[i] + 0.1 * lane);
    }
  } else if constexpr (is_dual<T>) {
    y.q[0].derivative[0] = 1.0;
  }
  return y;
}

/// kick is p += c force(q), to the bit: then a run does not depend on where the word may use it.
template <Scalar T, Scalar C, System S>
bool kick_is_force(const S& system, const phase_point<T, S::dimension>& x, const C& c) {
  auto f = make_vector<T>(system);
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
bool runs_alike(const model& system, const model& other, const tabulated& method, double step,
                const any_state& x) {
  const run_of one{system, method, step};
  const run_of another{other, method, step};
  return same_bits(one.plain(x, 1), another.plain(x, 1)) &&
         same_bits(one.cut(x, 50, 20), another.finish(x, 50));
}

}  // namespace

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
  BOOST_TEST(!runs_alike(system, without_kick(system), tabulated(verlet()), 0.1, {x.q, x.p}));
}

BOOST_AUTO_TEST_CASE(runs_do_not_depend_on_it) {
  const fpu_chain<3> chain(10.0);
  const model other{without_kick(chain)};
  draws random;
  try_all({specimen_of(describe(chain))}, methods_as_data(random),
          [&](const model& system, const tabulated& method, double, const any_state& x) {
            BOOST_TEST(runs_alike(system, other, method, 0.01, x));
          });
  // By their types.
  const auto start = random.state(chain, 0.5);
  const without_kick plain(chain);
  const auto finish = [&](const auto& system) {
    const auto fixed = make_stepper(system, verlet(), 0.01);
    auto run = fixed.open(start);
    fixed.advance(run, 20);
    fixed.advance(run, 30);
    return fixed.synchronous(run);
  };
  BOOST_TEST(same_bits(finish(chain), finish(plain)));
}

// It steps by its own force.
BOOST_AUTO_TEST_CASE(an_inherited_kick_of_another_force_is_left_aside) {
  const softer system(50.0);
  const fpu_chain<3> chain(50.0);
  draws random;
  auto x = random.state(system, 0.5);
  auto y = x;
  make_stepper(system, verlet_aba(), 0.01).step(x);
  make_stepper(chain, verlet_aba(), 0.01).step(y);
  BOOST_TEST((x.p - y.p).norm() > 1e-3);
  BOOST_TEST(check_force(system, {x.q}).gradient_defect > 0.1);  // its potential is the stiffer one's
}
