// SPDX-License-Identifier: BSL-1.0
#include <cmath>

#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt::program {

system_declaration declare_kepler() {
  system_declaration result{.name = "kepler",
                            .title = "p^2/2 - 1/|q| in the plane, ellipses of semi-major axis 1"};
  result.parameters = {{.name = "eccentricity",
                        .usual = 0.6,
                        .meaning = "eccentricity of the ellipses",
                        .least = 0.0,
                        .below = 1.0}};
  result.make = [](const parameter_values& values, const bath& in, double) {
    const double eccentricity = values.real("eccentricity");
    // V'' = 2/r^3 at the pericentre, r = 1 - e.
    const double fastest = std::sqrt(2.0 / std::pow(1.0 - eccentricity, 3));
    return detail::made_of(kepler(), in, kepler_law(eccentricity), fastest);
  };
  result.has_spread = false;
  result.source = "hairer_lubich_wanner_2006";
  return result;
}

}  // namespace nysalt::program
