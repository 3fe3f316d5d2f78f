// SPDX-License-Identifier: BSL-1.0
// Export to Grid.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_grid(const exported_method& method) {
  const exported_letters word = composition_of(method, "Grid");
  auto values = values_of_header(method, "//");
  values.emplace_back("LETTERS", word.letters);
  values.emplace_back("LIST", digits(word.coefficients));
  return fill(R"(@HEADER@//
@EXPLAINED@
// An integrator of Grid beside MinimumNorm2, with nested levels: a drift of one level is `multiplier` steps of the next.
// Kicks of one level are joined where no drift is between them.
//   typedef GenericHMCRunner<@NAME@_integrator> HMCWrapper;
// Test, of a stand-in for the base class: c++ -DNYSALT_SELF_TEST -x c++ FILE && ./a.out
#ifndef NYSALT_@NAME@_GRID_H
#define NYSALT_@NAME@_GRID_H

#include <string>
#include <vector>
#ifndef NYSALT_SELF_TEST
#include <Grid/Grid.h>
NAMESPACE_BEGIN(Grid);
#else
#include <algorithm>
#include <cmath>
#include <cstdio>

// What the class asks of Grid: two oscillators, all of whose force is of level 0; level 1 has none.
typedef double RealD;
template <class T>
struct Representations {};
struct FundamentalRepresentation {};
struct two_oscillators {
  struct Field {
    double q[2], p[2];
  };
};
template <class Implementation, class Smearing, class Representation>
class Integrator {
 public:
  typedef typename Implementation::Field Field;
  struct {
    RealD trajL;
    int MDsteps;
  } Params;
  struct action_level {
    int multiplier;
  };
  std::vector<action_level> as;
  void update_P(Field& x, int level, double c) {
    if (level == 1) return;
    const double f[] = {-x.q[0] - 2 * x.q[0] * x.q[1], -x.q[1] - x.q[0] * x.q[0] + x.q[1] * x.q[1]};
    for (int i = 0; i < 2; ++i) x.p[i] += c * f[i];
  }
  void update_U(Field& x, double c) {
    x.q[0] += c * x.p[0];
    x.q[1] += c * 0.5 * x.p[1];
  }
};
#endif

template <class FieldImplementation_, class SmearingPolicy,
          class RepresentationPolicy = Representations<FundamentalRepresentation> >
class @NAME@_integrator : public Integrator<FieldImplementation_, SmearingPolicy, RepresentationPolicy> {
 public:
#ifndef NYSALT_SELF_TEST
  typedef FieldImplementation_ FieldImplementation;
  INHERIT_FIELD_TYPES(FieldImplementation);

  @NAME@_integrator(GridBase* grid, IntegratorParameters Par, ActionSet<Field, RepresentationPolicy>& Aset,
                    SmearingPolicy& Sm, Metric<Field>& M)
      : Integrator<FieldImplementation, SmearingPolicy, RepresentationPolicy>(grid, Par, Aset, Sm, M) {}
#else
  typedef typename FieldImplementation_::Field Field;
#endif

  std::string integrator_name() { return "@NAME@"; }

  void step(Field& U, int level, int, int last) {
    kicks_.resize(this->as.size(), 0.0);
    over(U, level, this->Params.trajL / this->Params.MDsteps);
    if (last) kick(U);
  }

 private:
  // All steps of a level over a length of time.
  void over(Field& U, int level, RealD length) {
    static const char letters[] = "@LETTERS@";
    static const RealD coefficients[] = {@LIST@};
    const RealD h = length / this->as[level].multiplier;
    for (int e = 0; e < this->as[level].multiplier; ++e) {
      for (int k = 0; letters[k]; ++k) {
        const RealD c = coefficients[k] * h;
        if (letters[k] == 'B') {
          kicks_[level] += c;
        } else if (level + 1 < static_cast<int>(this->as.size())) {
          over(U, level + 1, c);
        } else {
          kick(U);
          this->update_U(U, c);
        }
      }
    }
  }
  // Kicks that have waited for a drift.
  void kick(Field& U) {
    for (int level = 0; level < static_cast<int>(kicks_.size()); ++level) {
      if (kicks_[level] != 0.0) this->update_P(U, level, kicks_[level]);
      kicks_[level] = 0.0;
    }
  }
  std::vector<RealD> kicks_;
};

#ifndef NYSALT_SELF_TEST
NAMESPACE_END(Grid);
#else
// 0 if ten steps of two oscillators end where nysalt's own do, on one level and with the force on the outer one of two
// whose inner steps do nothing; their rounding differs by less than 1e-13.
int main() {
  const double end_q[] = {@Q@}, end_p[] = {@P@};
  double off = 0;
  for (int levels = 1; levels <= 2; ++levels) {
    @NAME@_integrator<two_oscillators, int> run;
    run.Params = {1.0, 10};
    run.as.assign(levels, {1});
    two_oscillators::Field x = {{0.3, 0.2}, {0.1, -0.25}};
    for (int k = 0; k < 10; ++k) run.step(x, 0, k == 0, k == 9);
    for (int i = 0; i < 2; ++i) off = std::max({off, std::abs(x.q[i] - end_q[i]), std::abs(x.p[i] - end_p[i])});
  }
  std::printf("@NAME@: off by %.1e\n", off);
  return off < 1e-13 ? 0 : 1;
}
#endif

#endif
)",
              values);
}

}  // namespace nysalt::detail
