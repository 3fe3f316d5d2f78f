// SPDX-License-Identifier: BSL-1.0
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "../support/statistics.hpp"

namespace nysalt::test {

double standard_errors(double probability, double degrees) {
  return quantile(complement(boost::math::students_t(degrees), 0.5 * probability));
}

int most_of(int n, double p, double probability) {
  return static_cast<int>(quantile(complement(boost::math::binomial(n, p), probability)));
}

}  // namespace nysalt::test
