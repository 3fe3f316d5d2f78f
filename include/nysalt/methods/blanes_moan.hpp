// SPDX-License-Identifier: BSL-1.0
// Optimised methods of Blanes and Moan.
#pragma once

#include <string>

#include "nysalt/methods/palindromic.hpp"

namespace nysalt {

/// S6: order 4 for any separable Hamiltonian, six evaluations [blanes_moan_2002, table 2, S_6].
struct blanes_moan_s6 : palindromic<kick, drift, 13> {
  static constexpr int order = 4;
  static std::string name() { return "blanes_moan_s6"; }
  static constexpr std::array<double, 13> coefficients() {
    return palindrome<13>({0.0792036964311957, 0.209515106613362,  //
                           0.353172906049774, -0.143851773179818,  //
                           -0.0420650803577195});
  }
};

/// SRKN6b: order 4, six evaluations [blanes_moan_2002, table 3, SRKN_6^b]. Its order holds for any K(p): what
/// a quadratic K removes is a term of fourth order, which a symmetric method lacks anyway. Its small error
/// constant is for quadratic K.
struct srkn6b : palindromic<kick, drift, 13> {
  static constexpr int order = 4;
  static std::string name() { return "srkn6b"; }
  static constexpr std::array<double, 13> coefficients() {
    return palindrome<13>({0.0829844064174052, 0.245298957184271,  //
                           0.396309801498368, 0.604872665711080,   //
                           -0.0390563049223486});
  }
};

/// SRKN11b: order 6 for quadratic K(p), else 4; eleven evaluations [blanes_moan_2002, table 3, SRKN_11^b].
struct srkn11b : palindromic<kick, drift, 23> {
  static constexpr int order = 6;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "srkn11b"; }
  static constexpr std::array<double, 23> coefficients() {
    return palindrome<23>({0.0414649985182624, 0.123229775946271,    //
                           0.198128671918067, 0.290553797799558,     //
                           -0.0400061921041533, -0.127049212625417,  //
                           0.0752539843015807, -0.246331761062075,   //
                           -0.0115113874206879, 0.357208872795928});
  }
};

/// SRKN14a: order 6 for quadratic K(p), else 4; fourteen evaluations [blanes_moan_2002, table 3, SRKN_14^a].
struct srkn14a : palindromic<drift, kick, 29> {
  static constexpr int order = 6;
  static constexpr bool requires_quadratic_kinetic = true;
  static std::string name() { return "srkn14a"; }
  static constexpr std::array<double, 29> coefficients() {
    return palindrome<29>({0.0378593198406116, 0.09171915262446165,    //
                           0.102635633102435, 0.183983170005006,       //
                           -0.0258678882665587, -0.05653436583288827,  //
                           0.314241403071447, 0.004914688774712854,    //
                           -0.130144459517415, 0.143761127168358,      //
                           0.106417700369543, 0.328567693746804,       //
                           -0.00879424312851058});
  }
};

}  // namespace nysalt
