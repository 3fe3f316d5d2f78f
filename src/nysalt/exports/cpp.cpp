// SPDX-License-Identifier: BSL-1.0
// Export to C++11.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_cpp(const exported_method& method) {
  auto values = values_of(method, "//");
  add_bath(values, method,
           {{"BATH_SENTENCE", "\n// The temperature is kT; normal() is a standard normal number."},
            {"BATH_TEMPLATE", ", class Normal"},
            {"BATH_PARAMETER", ", double friction, double temperature, Normal normal"},
            {"BATH_HELD", ",\n        friction_(friction), temperature_(temperature), normal_(normal)"},
            {"BATH_BRANCH", R"(      if (*letters == 'O') {
        const double damping = *c * h_ * friction_, decay = std::exp(-damping);
        const double spread = std::sqrt(-std::expm1(-2 * damping) * temperature_);
        for (std::size_t i = 0; i < n; ++i) p[i] = decay * p[i] + spread / std::sqrt(inverse_mass_[i]) * normal_();
        c += 1;
        continue;
      }
)"},
            {"BATH_MEMBERS", "  double friction_, temperature_;\n  Normal normal_;\n"},
            {"BATH_PINNED", R"(struct sines {
  int k;
  double operator()() { return std::sin(static_cast<double>(++k)); }
};

)"},
            {"BATH_TYPE", ", sines"},
            {"BATH_TEST", ", 1.5, 0.7, sines{0}"}});
  return fill(R"(@HEADER@//
@EXPLAINED@
// A run is start once, steps, and finish on a copy of q and p that is observed; without a processor start and finish
// do nothing. A force that is known is not evaluated again, also from step to step.
// Test: c++ -DNYSALT_SELF_TEST -x c++ FILE && ./a.out
#ifndef NYSALT_@NAME@_HPP
#define NYSALT_@NAME@_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace nysalt_@NAME@ {

// force(q, f) writes the force at q; both are vectors of the length of inverse_mass.@BATH_SENTENCE@
template <class Force@BATH_TEMPLATE@>
class integrator {
 public:
  using vector = std::vector<double>;

  integrator(Force force, vector inverse_mass, double h@BATH_PARAMETER@)
      : force_(force), inverse_mass_(inverse_mass), h_(h), f_(inverse_mass), x_(inverse_mass), g_(inverse_mass)@BATH_HELD@ {}

  void start(vector& q, vector& p) {
    static const double c[] = {@START_COEFFICIENTS@};
    apply("@START@", c, false, q, p);
  }
  void steps(vector& q, vector& p, long count) {
    static const double c[] = {@KERNEL_COEFFICIENTS@};
    bool known = false;
    for (long k = 0; k < count; ++k) known = apply("@KERNEL@", c, known, q, p);
  }
  void finish(vector& q, vector& p) {
    static const double c[] = {@FINISH_COEFFICIENTS@};
    apply("@FINISH@", c, false, q, p);
  }

 private:
  bool apply(const char* letters, const double* c, bool known, vector& q, vector& p) {
    const std::size_t n = q.size();
    for (; *letters; ++letters) {
      if (*letters == 'A') {
        for (std::size_t i = 0; i < n; ++i) q[i] += *c * h_ * inverse_mass_[i] * p[i];
        known = false;
        c += 1;
        continue;
      }
@BATH_BRANCH@      if (!known) force_(q, f_);
      known = true;
      if (*letters == 'B') {
        for (std::size_t i = 0; i < n; ++i) p[i] += *c * h_ * f_[i];
        c += 1;
      } else {
        for (std::size_t i = 0; i < n; ++i) x_[i] = q[i] + c[1] * h_ * h_ * inverse_mass_[i] * f_[i];
        force_(x_, g_);
        for (std::size_t i = 0; i < n; ++i) p[i] += c[0] * h_ * g_[i];
        c += 2;
      }
    }
    return known;
  }

  Force force_;
  vector inverse_mass_;
  double h_;
  vector f_, x_, g_;
@BATH_MEMBERS@};

struct pinned_force {
  void operator()(const std::vector<double>& q, std::vector<double>& f) const {
    f[0] = -q[0] - 2 * q[0] * q[1];
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  }
};

@BATH_PINNED@// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
inline int self_test() {
  const double end_q[] = {@Q@}, end_p[] = {@P@};
  std::vector<double> q{0.3, 0.2}, p{0.1, -0.25};
  integrator<pinned_force@BATH_TYPE@> run(pinned_force(), {1.0, 0.5}, 0.1@BATH_TEST@);
  run.start(q, p);
  run.steps(q, p, 10);
  run.finish(q, p);
  double off = 0;
  for (int i = 0; i < 2; ++i) off = std::max(off, std::max(std::abs(q[i] - end_q[i]), std::abs(p[i] - end_p[i])));
  std::printf("@NAME@: off by %.1e\n", off);
  return off < 1e-13 ? 0 : 1;
}

}  // namespace nysalt_@NAME@

#ifdef NYSALT_SELF_TEST
int main() { return nysalt_@NAME@::self_test(); }
#endif

#endif
)",
              values);
}

}  // namespace nysalt::detail
