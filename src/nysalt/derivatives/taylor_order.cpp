// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/taylor_order.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/stepper.hpp"

namespace nysalt {

namespace {

/// A number between 1/4 and 1.
double next(std::mt19937_64& bits) { return 0.25 + 0.75 * detail::uniform_by_bits(bits()); }

}  // namespace

detail::generic_gradient::generic_gradient(std::mt19937_64& bits) {
  for (auto& [direction, polynomial] : ridges_) {
    for (double& a : direction) a = next(bits);
    double factorial = 1.0;
    for (std::size_t m = 0; m < polynomial.size(); ++m) {
      if (m > 0) factorial *= static_cast<double>(m);
      polynomial[m] = next(bits) / factorial;
    }
  }
}

detail::order_probe::order_probe(bool quadratic_kinetic) : quadratic_kinetic_(quadratic_kinetic) {
  for (double& q : start_.q) q = next(bits_);
  for (double& p : start_.p) p = next(bits_);
}

phase_point<detail::taylor, 3> detail::order_probe::flow() const {
  const auto integrate = [](const vector<detail::taylor, 3>& rate, vector<detail::taylor, 3>& x) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (std::size_t k = 1; k < detail::taylor::terms; ++k) {
        x[i].coefficient[k] = rate[i].coefficient[k] / static_cast<double>(k);
      }
    }
  };
  auto x = start();
  auto v = x.p;
  auto f = x.q;
  for (int sweep = 0; sweep < detail::highest_taylor_order; ++sweep) {
    velocity(x.p, v);
    force(x.q, f);
    integrate(v, x.q);
    integrate(f, x.p);
  }
  return x;
}

namespace {

/// |x - y| coordinate by coordinate, power by power.
std::array<detail::taylor, 6> distances(const phase_point<detail::taylor, 3>& x,
                                        const phase_point<detail::taylor, 3>& y) {
  std::array<detail::taylor, 6> result{x.q[0] - y.q[0], x.q[1] - y.q[1], x.q[2] - y.q[2],
                                       x.p[0] - y.p[0], x.p[1] - y.p[1], x.p[2] - y.p[2]};
  for (detail::taylor& distance : result) {
    for (double& c : distance.coefficient) c = std::abs(c);
  }
  return result;
}

/// Tables are printed to ten digits or more. Hence a power of h agrees if errors of 1e-10 in the coefficients
/// of the letters, at their worst, explain the difference: sum_i |dx/dc_i| 1e-10. This is sharp where large
/// terms cancel, and rounding stays far below: it acts like errors of some 1e-16.
int order_on(const detail::order_probe& system, std::vector<double> coefficients,
             const detail::composition_step& one_step, const phase_point<detail::taylor, 3>& exact) {
  const auto x = one_step(system, coefficients);
  const auto error = distances(x, exact);
  std::array<detail::taylor, 6> tolerance;
  for (double& c : coefficients) {
    const double as_given = c;
    c += 1e-10;
    const auto change = distances(one_step(system, coefficients), x);
    for (std::size_t i = 0; i < 6; ++i) tolerance[i] += change[i];
    c = as_given;
  }
  for (std::size_t k = 1; k < detail::taylor::terms; ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      const bool agrees = error[i].coefficient[k] <= tolerance[i].coefficient[k];
      if (!agrees) return static_cast<int>(k) - 1;  // nor does what is not a number
    }
  }
  return detail::highest_taylor_order;
}

/// x after a step of length 1.
void advance(const detail::order_probe& system, const nysalt::word& word,
             const std::vector<double>& coefficients, phase_point<detail::taylor, 3>& x) {
  stepper<detail::order_probe>(system, word, coefficients, 1.0).step(x);
}

/// To which powers of h the processor of a word is even, so that P(-h) P(h)^-1 is the identity.
taylor_orders order_of_processor(const nysalt::word& word, const std::vector<double>& coefficients) {
  const auto there_and_back = [&](const detail::order_probe& system, const std::vector<double>& c) {
    auto x = system.start();
    advance(system, detail::pre_processor(word), detail::pre_processor_coefficients(word, c), x);
    advance(system, detail::post_processor(word), detail::post_processor_coefficients(word, c), x);
    return x;
  };
  const detail::order_probe quadratic(true);
  const detail::order_probe any(false);
  return {order_on(quadratic, coefficients, there_and_back, quadratic.start()),
          order_on(any, coefficients, there_and_back, any.start())};
}

}  // namespace

taylor_orders detail::taylor_order_of(const std::vector<double>& coefficients,
                                      const detail::composition_step& one_step) {
  const detail::order_probe quadratic(true);
  const detail::order_probe any(false);
  return {order_on(quadratic, coefficients, one_step, quadratic.flow()),
          order_on(any, coefficients, one_step, any.flow())};
}

taylor_orders taylor_order(const nysalt::word& word, const std::vector<double>& coefficients) {
  std::string letters = word.letters();
  for (char& letter : letters) {
    detail::with_letter(letter, detail::known_letters{},
                        [&](auto flow) { letter = decltype(flow)::same_order_as::letter; });
  }
  const nysalt::word split(letters);
  const auto of_step = detail::taylor_order_of(
      coefficients, [&](const detail::order_probe& system, const std::vector<double>& c) {
        auto x = system.start();
        advance(system, split, c, x);
        return x;
      });
  if (!split.is_processed()) return of_step;
  const auto of_none = order_of_processor(split, coefficients);
  return {std::min(of_step.quadratic_kinetic, of_none.quadratic_kinetic),
          std::min(of_step.any_kinetic, of_none.any_kinetic)};
}

}  // namespace nysalt
