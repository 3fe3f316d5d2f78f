// SPDX-License-Identifier: BSL-1.0
// Export to hosts that take a list of drifts and kicks: Boost.Odeint, SUNDIALS, BlackJAX and Mici.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "comparison/refusal.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::program {

namespace {

/// Whether it reads the same from both ends, to rounding: the coefficients of schemes are sums.
bool is_palindrome(const exported_letters& word) {
  constexpr double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const std::size_t n = word.letters.size();
  for (std::size_t i = 0; i < n / 2; ++i) {
    if (word.letters[i] != word.letters[n - 1 - i]) return false;
    if (std::abs(word.coefficients[i] - word.coefficients[n - 1 - i]) > rounding) return false;
  }
  return n % 2 == 1;
}

/// What a Python file of a list is filled with.
std::vector<std::pair<std::string, std::string>> values_of_list(const exported_method& method,
                                                                const std::vector<double>& list) {
  return {{"NAME", method.name},
          {"HEADER", header(method, "#")},
          {"LIST", digits(list)},
          {"Q", digits(self_test_of(method).q)},
          {"P", digits(self_test_of(method).p)}};
}

/// Drifts and kicks as stages of two letters, zero where a stage has one alone; the letters that are `first`
/// in a stage, and the others.
std::pair<std::vector<double>, std::vector<double>> in_stages(const exported_letters& word, char first) {
  std::vector<double> firsts, seconds;
  for (std::size_t i = 0; i < word.letters.size(); ++i) {
    const bool is_first = word.letters[i] == first;
    if (is_first || i == 0) {
      firsts.push_back(0.0);
      seconds.push_back(0.0);
    }
    (is_first ? firsts : seconds).back() = word.coefficients[i];
  }
  return {firsts, seconds};
}

}  // namespace

std::string export_to_odeint(const exported_method& method) {
  const exported_letters word = composition_of(method, "Boost.Odeint");
  const auto [a, b] = in_stages(word, 'A');
  const self_test end = self_test_of(method);
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
              {{"NAME", method.name},
               {"HEADER", header(method, "//")},
               {"STAGES", std::to_string(a.size())},
               {"A", digits(a)},
               {"B", digits(b)},
               {"Q", digits(end.q)},
               {"P", digits(end.p)}});
}

std::string export_to_sundials(const exported_method& method) {
  const exported_letters word = composition_of(method, "SUNDIALS");
  const auto [kicks, drifts] = in_stages(word, 'B');
  const self_test end = self_test_of(method);
  return fill(R"(@HEADER@//
// The table of SPRKStep, since SUNDIALS 6.6: stage i is p += ahat[i] h f1(q), then q += a[i] h f2(p). It evaluates f1 in
// each of its @STAGES@ stages, also where ahat[i] is zero.
//   SPRKStepSetMethod(memory, @NAME@_table()); SPRKStepSetFixedStep(memory, h);
// Test, of a stand-in with the loop of SPRKStep: cc -DNYSALT_SELF_TEST FILE -lm && ./a.out
static const double @NAME@_a[] = {@A@};
static const double @NAME@_ahat[] = {@AHAT@};

#ifndef NYSALT_SELF_TEST
#include <arkode/arkode_sprk.h>

// Null where there is no memory; freed by ARKodeSPRKTable_Free.
ARKodeSPRKTable @NAME@_table(void) { return ARKodeSPRKTable_Create(@STAGES@, @ORDER@, @NAME@_a, @NAME@_ahat); }
#else
#include <math.h>
#include <stdio.h>

// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int main(void) {
  const double end_q[2] = {@Q@}, end_p[2] = {@P@}, inverse_mass[2] = {1.0, 0.5}, h = 0.1;
  double q[2] = {0.3, 0.2}, p[2] = {0.1, -0.25}, off = 0;
  for (int k = 0; k < 10; ++k) {
    for (int i = 0; i < @STAGES@; ++i) {
      const double f[2] = {-q[0] - 2 * q[0] * q[1], -q[1] - q[0] * q[0] + q[1] * q[1]};
      for (int j = 0; j < 2; ++j) p[j] += @NAME@_ahat[i] * h * f[j];
      for (int j = 0; j < 2; ++j) q[j] += @NAME@_a[i] * h * inverse_mass[j] * p[j];
    }
  }
  for (int j = 0; j < 2; ++j) off = fmax(off, fmax(fabs(q[j] - end_q[j]), fabs(p[j] - end_p[j])));
  printf("@NAME@: off by %.1e\n", off);
  return !(off < 1e-13);
}
#endif
)",
              {{"NAME", method.name},
               {"HEADER", header(method, "//")},
               {"STAGES", std::to_string(kicks.size())},
               {"ORDER", std::to_string(method.method.order)},
               {"A", digits(drifts)},
               {"AHAT", digits(kicks)},
               {"Q", digits(end.q)},
               {"P", digits(end.p)}});
}

std::string export_to_blackjax(const exported_method& method) {
  const exported_letters word = composition_of(method, "BlackJAX");
  if (!is_palindrome(word) || word.letters.front() != 'B') {
    refuse(
        "export: blackjax needs a symmetric word that begins with a kick, got {} with the letters {}: learn "
        "bab2 to "
        "bab6, or take mclachlan2v, bcss2v, bcss3 or bcss4",
        method.method.name(), word.letters);
  }
  return fill(R"(@HEADER@#
# Coefficients of kicks and drifts in turn; a kick first and last, so that BlackJAX evaluates one gradient a drift.
#   blackjax.hmc(log_density, step_size, inverse_mass_matrix, integration_steps, integrator=integrator())
# Test, of a stand-in with the loop of BlackJAX: python3 FILE
COEFFICIENTS = [@LIST@]


def integrator():
    """For states of position and momentum: hmc, nuts."""
    from blackjax.mcmc.integrators import generate_euclidean_integrator
    return generate_euclidean_integrator(COEFFICIENTS)


def isokinetic_integrator():
    """For momenta on a sphere: mclmc and adjusted_mclmc."""
    from blackjax.mcmc.integrators import generate_isokinetic_integrator
    return generate_isokinetic_integrator(COEFFICIENTS)


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    def force(q):
        return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]

    q, p, inverse_mass, h = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5], 0.1
    f = force(q)
    for _ in range(10):
        for i, c in enumerate(COEFFICIENTS):
            if i % 2 == 0:
                p = [p[k] + c * h * f[k] for k in range(2)]
            else:
                q = [q[k] + c * h * inverse_mass[k] * p[k] for k in range(2)]
                f = force(q)
    return max(abs(a - b) for a, b in zip(q + p, [@Q@, @P@]))


if __name__ == "__main__":
    off = self_test()
    print(f"@NAME@: off by {off:.1e}")
    raise SystemExit(not off < 1e-13)
)",
              values_of_list(method, word.coefficients));
}

std::string export_to_mici(const exported_method& method) {
  const exported_letters word = composition_of(method, "Mici");
  if (!is_palindrome(word) || word.letters.size() < 3) {
    refuse(
        "export: mici needs a symmetric word of drifts and kicks, got {} with the letters {}: learn a "
        "symmetric "
        "family, bab2 to bab6 or aba4 to aba6",
        method.method.name(), word.letters);
  }
  // Its list of free coefficients leaves out one of either kind at the centre, which follow from the sums.
  const std::size_t half = (word.letters.size() + 1) / 2;
  const std::vector<double> free(word.coefficients.begin(),
                                 word.coefficients.begin() + static_cast<std::ptrdiff_t>(half - 2));
  auto values = values_of_list(method, free);
  values[2].second += free.size() == 1 ? "," : "";
  values.emplace_back("FIRST", word.letters.front() == 'B' ? "True" : "False");
  return fill(R"(@HEADER@#
# The free coefficients of a symmetric composition: the others follow from symmetry and from sums of one.
# Test, of a stand-in with the loop of Mici: python3 FILE
FREE_COEFFICIENTS = (@LIST@)
BEGINS_WITH_KICK = @FIRST@


def integrator(system, step_size):
    from mici.integrators import SymmetricCompositionIntegrator
    return SymmetricCompositionIntegrator(system, FREE_COEFFICIENTS, step_size=step_size,
                                          initial_h1_flow_step=BEGINS_WITH_KICK)


def coefficients():
    """All of them, as Mici completes them: the kinds alternate, and each kind sums to one."""
    free, n = list(FREE_COEFFICIENTS), len(FREE_COEFFICIENTS)
    free.append(0.5 - sum(free[n % 2::2]))
    free.append(1.0 - 2.0 * sum(free[(n + 1) % 2:n + 1:2]))
    return free + free[-2::-1]


def self_test():
    """By how much ten steps of two oscillators end elsewhere than nysalt's own: below 1e-13 by rounding."""
    def force(q):
        return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]

    q, p, inverse_mass, h = [0.3, 0.2], [0.1, -0.25], [1.0, 0.5], 0.1
    for _ in range(10):
        for i, c in enumerate(coefficients()):
            if (i % 2 == 0) == BEGINS_WITH_KICK:
                f = force(q)
                p = [p[k] + c * h * f[k] for k in range(2)]
            else:
                q = [q[k] + c * h * inverse_mass[k] * p[k] for k in range(2)]
    return max(abs(a - b) for a, b in zip(q + p, [@Q@, @P@]))


if __name__ == "__main__":
    off = self_test()
    print(f"@NAME@: off by {off:.1e}")
    raise SystemExit(not off < 1e-13)
)",
              values);
}

}  // namespace nysalt::program
