// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/families/nested_kicks.hpp"

namespace nysalt {

/// r-RESPA, the impulse method: a half kick of Slow, Inner steps of velocity Verlet with Fast, a half kick of
/// Slow. Order 2, symmetric, Inner evaluations of Fast and one of Slow; where Slow times the step meets half
/// a period of a fast mode it is unstable. Source: [tuckerman_berne_martyna_1992].
template <std::size_t Fast, std::size_t Slow, int Inner>
  requires(Inner >= 1)
struct r_respa {
  using word = nested_word<Fast, Slow, static_cast<std::size_t>(Inner)>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return sentence("r_respa({})", Inner); }
  static typename word::template coefficients<double> coefficients() {
    typename word::template coefficients<double> all{};
    all.fill(1.0 / Inner);
    all.front() = all[all.size() - 2] = 0.5 / Inner;
    all[1] = all.back() = 0.5;
    return all;
  }
};

}  // namespace nysalt
