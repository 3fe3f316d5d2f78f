// SPDX-License-Identifier: BSL-1.0
// A system's own kick is that of its force, and is used where the force is not needed again.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../laws/run_laws.hpp"
#include "../laws/system_laws.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/scalars/pack.hpp"

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

template <System S>
bool kick_is_force_over_all(const S& system, const phase_point<double, S::dimension>& x) {
  using D = dual<double, 1>;
  return kick_is_force(system, x, 0.3) && kick_is_force(system, dressed<D>(x), 0.3) &&
         kick_is_force(system, dressed<D>(x), D::variable(0.3, 0)) &&
         kick_is_force(system, dressed<pack<double, 8>>(x), 0.3);
}

/// What a kick of its own could change: a run, stopped and gone on with, and a plain step.
template <Method M, SeparableSystem S>
bool runs_alike(const S& system, const M& method, double step, const phase_point<double, S::dimension>& x) {
  const without_kick<S> other(system);
  auto y = x;
  auto z = x;
  make_stepper(system, method, step).step(y);
  make_stepper(other, method, step).step(z);
  return same_bits(y, z) &&
         same_bits(cut_finish(system, method, step, x, 50, 20), integrate(other, method, step, x, 50).finish);
}

using with_kick = std::tuple<an_fpu_chain, a_dynamic_fpu>;

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(a_kick_is_that_of_the_force, Model, systems) {
  const auto system = Model::make();
  using S = system_of<Model>;
  if constexpr (HasKick<S, double>) {
    draws random;
    for (int n = 0; n < 20; ++n) {
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << describe(system) << ", draw " << n) {
        BOOST_TEST(kick_is_force_over_all(system, random.state(system, 1.0)));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_wrong_kick_is_found) {
  draws random;
  const wrong_kick system;
  const auto x = random.state(system, 1.0);
  BOOST_TEST(!kick_is_force(system, x, 0.3));
  BOOST_TEST(!runs_alike(system, verlet(), 0.1, x));
}

BOOST_AUTO_TEST_CASE_TEMPLATE(runs_do_not_depend_on_it, Model, with_kick) {
  draws random;
  const auto system = Model::make();
  const auto x = random.state(system, Model::reach);
  for (const auto& method : methods_as_data(random)) {
    if (!suits(system, method)) continue;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
      BOOST_TEST(runs_alike(system, method, 0.01, x));
    }
  }
  BOOST_TEST(runs_alike(system, verlet(), 0.01, x));  // by their types
  BOOST_TEST(runs_alike(system, srkn6b(), 0.01, x));
}

BOOST_AUTO_TEST_CASE_TEMPLATE(it_counts_as_an_evaluation, Model, with_kick) {
  draws random;
  const auto system = Model::make();
  const auto x = random.state(system, Model::reach);
  const auto counts = [&](const auto& method, int to_open, int per_step, int plain) {
    using word = typename std::decay_t<decltype(method)>::word;
    static_assert(HasKick<counted<system_of<Model>>, double>);
    BOOST_TEST(evaluations_of_run(system, method, 0.01, x, 10) == to_open + 10 * per_step);
    BOOST_TEST(evaluations_of_run(system, tabulated(method), 0.01, x, 10) == to_open + 10 * per_step);
    BOOST_TEST(evaluations_of_step(system, method, 0.01, x) == plain);
    BOOST_TEST(word::evaluations_per_step == per_step);
  };
  counts(verlet(), 1, 1, 2);
  counts(verlet_aba(), 0, 1, 1);
  counts(srkn6b(), 1, 6, 7);
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
