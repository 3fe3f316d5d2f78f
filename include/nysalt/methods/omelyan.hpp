// SPDX-License-Identifier: BSL-1.0
// Optimised methods of Omelyan, Mryglod and Folk; their PEFRL is in pefrl.hpp.
#pragma once

#include <array>
#include <string>

#include "nysalt/flows/drift.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/kick.hpp"
#include "nysalt/methods/palindromic.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Velocity-extended Forest-Ruth-like: B(xi) A((1 - 2 lambda)/2) B(chi) A(lambda) B(1 - 2(chi + xi)) ...,
/// order 4, four evaluations [omelyan_mryglod_folk_2002].
struct vefrl : palindromic<kick, drift, 9> {
  static constexpr int order = 4;
  static std::string name() { return "vefrl"; }
  static constexpr std::array<double, 9> coefficients() {
    constexpr double xi = 0.1644986515575760;
    constexpr double lambda = -0.02094333910398989;
    constexpr double chi = 1.235692651138917;
    return palindrome<9>({xi, 0.5 - lambda, chi});
  }
};

/// B A B A B A B A B A B of order 4 with the least norm of the error's leading coefficients, five evaluations
/// [omelyan_mryglod_folk_2003, equation (71)]; 4MN5FV or OMF4 in lattice field theory.
struct omelyan5v : palindromic<kick, drift, 11> {
  static constexpr int order = 4;
  static std::string name() { return "omelyan5v"; }
  static constexpr std::array<double, 11> coefficients() {
    constexpr double theta = 0.08398315262876693;
    constexpr double rho = 0.2539785108410595;
    constexpr double lambda = 0.6822365335719091;
    constexpr double mu = -0.03230286765269967;
    return palindrome<11>({theta, rho, lambda, mu});
  }
};

/// A B A B A B A B A B A of order 4 with the least norm of the error's leading coefficients, five evaluations
/// [omelyan_mryglod_folk_2003, equation (80)]; 4MN5FP in lattice field theory.
struct omelyan5p : palindromic<drift, kick, 11> {
  static constexpr int order = 4;
  static std::string name() { return "omelyan5p"; }
  static constexpr std::array<double, 11> coefficients() {
    constexpr double rho = 0.2750081212332419;
    constexpr double theta = -0.08442961950707149;
    constexpr double mu = -0.1347950099106792;
    constexpr double lambda = 0.3549000571574260;
    return palindrome<11>({rho, theta, mu, lambda});
  }
};

/// A(a) B(b) A(1/2 - a) G(1 - 2 b, c) A(1/2 - a) B(b) A(a) with the least norm of the error's leading
/// coefficients: order 4, four evaluations [omelyan_mryglod_folk_2003, equation (44)]; 4MN3F1GP in lattice
/// field theory. a = 1/2 - 1/sqrt(24 b) and c = (1 - (1 - b) sqrt(6 b))/12.
struct omelyan_fg4 {
  using word = nysalt::word<drift, kick, drift, gradient_kick, drift, kick, drift>;
  static constexpr int order = 4;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "omelyan_fg4"; }
  static constexpr std::array<double, 8> coefficients() {
    constexpr double b = 0.2470939580390842;
    constexpr double a = 0.5 - 1.0 / 2.43521148833895344696;                 // sqrt(24 b)
    constexpr double c = (1.0 - (1.0 - b) * 1.21760574416947672348) / 12.0;  // sqrt(6 b)
    return {a, b, 0.5 - a, 1.0 - 2.0 * b, c, 0.5 - a, b, a};
  }
};

}  // namespace nysalt
