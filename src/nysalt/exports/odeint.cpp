// SPDX-License-Identifier: BSL-1.0
// Export to Boost.Odeint.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_odeint(const exported_method& method) {
  const exported_letters word = composition_of(method, "Boost.Odeint");
  const auto [a, b] = in_stages(word, 'A');
  auto values = values_of_header(method, "//");
  values.emplace_back("STAGES", std::to_string(a.size()));
  values.emplace_back("A", digits(a));
  values.emplace_back("B", digits(b));
  return fill(R"(@HEADER@//
// A stepper of Boost.Odeint: its stage i is q += a[i] h v(p), then p += b[i] h f(q). It evaluates the force in each of
// its @STAGES@ stages, also where b[i] is zero, and keeps none from step to step.
//   @NAME@_stepper<state> stepper;
//   boost::numeric::odeint::integrate_const(stepper, std::make_pair(velocity, force), std::make_pair(q, p), t0, t1, h);
// Test: c++ -DNYSALT_SELF_TEST -x c++ FILE && ./a.out
#ifndef NYSALT_@NAME@_ODEINT_HPP
#define NYSALT_@NAME@_ODEINT_HPP

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/stepper/base/symplectic_rkn_stepper_base.hpp>
#include <cmath>
#include <cstdio>
#include <utility>

template <class State>
class @NAME@_stepper
    : public boost::numeric::odeint::symplectic_nystroem_stepper_base<
          @STAGES@, 1, State, State, double, State, State, double,
          typename boost::numeric::odeint::algebra_dispatcher<State>::algebra_type,
          typename boost::numeric::odeint::operations_dispatcher<State>::operations_type,
          boost::numeric::odeint::initially_resizer> {
 public:
  @NAME@_stepper()
      : boost::numeric::odeint::symplectic_nystroem_stepper_base<
            @STAGES@, 1, State, State, double, State, State, double,
            typename boost::numeric::odeint::algebra_dispatcher<State>::algebra_type,
            typename boost::numeric::odeint::operations_dispatcher<State>::operations_type,
            boost::numeric::odeint::initially_resizer>(list({{@A@}}), list({{@B@}})) {}

 private:
  using numbers = std::array<double, @STAGES@>;
  static boost::array<double, @STAGES@> list(const numbers& from) {
    boost::array<double, @STAGES@> to;
    std::copy(from.begin(), from.end(), to.begin());
    return to;
  }
};

// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
inline int @NAME@_self_test() {
  using state = std::array<double, 2>;
  const state end_q{{@Q@}}, end_p{{@P@}};
  const auto velocity = [](const state& p, state& v) {
    v[0] = p[0];
    v[1] = 0.5 * p[1];
  };
  const auto force = [](const state& q, state& f) {
    f[0] = -q[0] - 2 * q[0] * q[1];
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  };
  std::pair<state, state> x(state{{0.3, 0.2}}, state{{0.1, -0.25}});
  @NAME@_stepper<state> stepper;
  for (int k = 0; k < 10; ++k) stepper.do_step(std::make_pair(velocity, force), x, 0.1 * k, 0.1);
  double off = 0;
  for (int i = 0; i < 2; ++i)
    off = std::max(off, std::max(std::abs(x.first[i] - end_q[i]), std::abs(x.second[i] - end_p[i])));
  std::printf("@NAME@: off by %.1e\n", off);
  return off < 1e-13 ? 0 : 1;
}

#ifdef NYSALT_SELF_TEST
int main() { return @NAME@_self_test(); }
#endif

#endif
)",
              values);
}

}  // namespace nysalt::detail
