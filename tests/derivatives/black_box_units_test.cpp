// SPDX-License-Identifier: BSL-1.0
// Derivatives of a black box are as good in one unit as in another, and so is the check of its force.
#include "../support/black_box_in_units.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/spectrum.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// The same wells as a black box and over any scalar, and states of them.
template <int N>
struct in_both {
  boxed_wells<N> boxed;
  open_wells<N> open;
  std::vector<phase_point<double, N>> states;
  std::vector<Eigen::VectorXd> points;

  explicit in_both(const units& scales) {
    boxed.scales = scales;
    open.scales = scales;
    const starts_in_units<N> starts(boxed);
    for (std::uint64_t n = 0; n < 12; ++n) {
      states.push_back(starts(1, n));
      points.emplace_back(states.back().q);
    }
  }
  /// The largest coordinate, each times the length of it.
  double largest(const vector<double, N>& x) const {
    double result = 0.0;
    for (Eigen::Index i = 0; i < N; ++i) result = std::max(result, std::abs(x[i]) * boxed.length(i));
    return result;
  }
  /// The largest difference relative to the largest entry.
  double relative(const vector<double, N>& found, const vector<double, N>& exact) const {
    return largest(found - exact) / largest(exact);
  }
};

/// f'(q) v by differences over the absolute length 6e-6 max(1, |q|), as a twin that must fail.
template <int N>
vector<double, N> by_absolute_step(const boxed_wells<N>& system, const vector<double, N>& q,
                                   const vector<double, N>& v) {
  const double s = std::cbrt(eps) * std::max(1.0, q.cwiseAbs().maxCoeff()) / v.cwiseAbs().maxCoeff();
  vector<double, N> ahead;
  vector<double, N> behind;
  system.force(vector<double, N>(q + s * v), ahead);
  system.force(vector<double, N>(q - s * v), behind);
  return (ahead - behind) / (2.0 * s);
}

template <int N>
void check_derivatives(const units& scales) {
  const in_both<N> wells(scales);
  detail::lifted_room<double, N> room(N);
  for (std::size_t n = 0; n < wells.states.size(); ++n) {
    const auto& x = wells.states[n];
    vector<double, N> v;
    for (Eigen::Index i = 0; i < N; ++i) v[i] = 0.3 * x.p[i] * wells.boxed.inverse_mass(i) * scales.time;
    vector<double, N> found;
    vector<double, N> exact;
    detail::force_along<field::whole, double>(wells.boxed, x.q, v, found, room);
    detail::force_along<field::whole, double>(wells.open, x.q, v, exact, room);
    BOOST_TEST(wells.relative(found, exact) < 1e-7);
    if (scales.length * scales.mixed == 1e-6 && scales.length == 1e-6 && scales.offset == 0.0) {
      BOOST_TEST(wells.relative(by_absolute_step(wells.boxed, x.q, v), exact) > 1e-2);
    }
    using D = dual<double, 1>;
    vector<D, N> q;
    vector<D, N> f;
    for (Eigen::Index i = 0; i < N; ++i) q[i] = D::variable(x.q[i], 0) * 1.0;
    for (const double times : {1.0, 1e-6, 1e8}) {  // displacements that do not fit are found out
      for (Eigen::Index i = 0; i < N; ++i) q[i].derivative[0] = times * v[i];
      force<D>(wells.boxed, q, f);
      for (Eigen::Index i = 0; i < N; ++i) found[i] = f[i].derivative[0] / times;
      BOOST_TEST_CONTEXT(times << " times, start " << n) {
        BOOST_TEST(wells.relative(found, exact) < 1e-5);
        BOOST_TEST((times != 1.0 || wells.relative(found, exact) < 1e-7));
      }
    }
  }
}

template <int N>
void check_kicks(const units& scales) {
  const in_both<N> wells(scales);
  for (const double h : {0.1, 0.3, 0.5}) {  // wells that are bound to others have frequencies up to some 4
    for (const auto& x : wells.states) {
      auto found = x;
      auto exact = x;
      const auto kick = [&](const auto& system, auto& y) {
        using S = std::decay_t<decltype(system)>;
        stepper<S>(system, word("G"), {0.0, 1.0}, h * scales.time).step(y);
      };
      kick(wells.boxed, found);
      kick(wells.open, exact);
      const vector<double, N> kicked = exact.p - x.p;
      // eps of p, of what the kick adds; and eps of q, of the displacement along which the difference goes.
      vector<double, N> f;
      wells.open.force(x.q, f);
      const double reached = detail::part_of_displacement * h * h * wells.largest(f) / wells.open.energy();
      const double rounding = 4.0 * eps * wells.largest(x.p) / wells.largest(kicked) +
                              4.0 * eps * (1.0 + std::abs(scales.offset)) / reached;
      BOOST_TEST_CONTEXT("h = " << h) {
        BOOST_TEST(wells.relative(vector<double, N>(found.p - x.p), kicked) < 1e-7 + rounding);
      }
    }
  }
}

template <int N>
void check_checks(const units& scales) {
  const in_both<N> wells(scales);
  const auto& points = wells.points;
  const auto right = check_force(wells.boxed, points);
  BOOST_TEST(right.passed(), right.report());
  for (const double factor : {-1.0, 0.0, 1.001, 0.999}) {
    auto wrong = wells.boxed;
    wrong.first_factor = factor;
    BOOST_TEST(!check_force(wrong, points).passed(), "first coordinate times " << factor);
  }
  for (const double factor : {0.0, 1.01}) {
    auto wrong = wells.boxed;
    wrong.bond_factor = factor;
    BOOST_TEST((N == 1 || !check_force(wrong, points).passed()), "bonds times " << factor);
  }
  const auto boxed = hessian_spectrum(wells.boxed, wells.states);
  const auto open = hessian_spectrum(wells.open, wells.states);
  BOOST_TEST(std::abs(boxed.highest / open.highest - 1.0) < 1e-6);
  BOOST_TEST(open.highest_frequency() * scales.time > 0.5);
}

template <int N>
void check_all(const units& scales) {
  BOOST_TEST_CONTEXT(N << " wells, length " << scales.length << ", mixed " << scales.mixed << ", time "
                       << scales.time << ", offset " << scales.offset) {
    check_derivatives<N>(scales);
    check_kicks<N>(scales);
    check_checks<N>(scales);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(all_units_are_alike) {
  for (const units& scales : some_units()) {
    check_all<1>(scales);
    check_all<2>(scales);
    check_all<7>(scales);
  }
}

// Differences of a part of h^2 M^-1 f depend on q alone: a step of Chin's method is as reversible as with
// exact derivatives.
BOOST_AUTO_TEST_CASE(gradient_kicks_of_a_black_box_are_reversible) {
  for (const units& scales : some_units()) {
    const in_both<2> wells(scales);
    for (const auto& x : wells.states) {
      auto y = x;
      const auto stepper = make_stepper(wells.boxed, chin4a(), 0.3 * scales.time);
      stepper.step(y);
      y.p = -y.p;
      stepper.step(y);
      for (Eigen::Index i = 0; i < 2; ++i) {  // some hundred operations, of q as large as it is
        const double size = wells.boxed.length(i) * (2.0 + std::abs(scales.offset));
        BOOST_TEST(std::abs(y.q[i] - x.q[i]) < 1e3 * eps * size);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(one_point_is_looked_at_as_far_as_it_is_from_the_origin) {
  for (const double length : {1e-10, 1e-4, 1.0, 1e10}) {
    const in_both<2> wells({.length = length});
    for (const auto& q : wells.points) {
      BOOST_TEST(check_force(wells.boxed, {q}).passed());
      auto wrong = wells.boxed;
      wrong.first_factor = 1.01;
      BOOST_TEST(!check_force(wrong, {q}).passed());
    }
  }
}
