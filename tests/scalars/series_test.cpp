// SPDX-License-Identifier: BSL-1.0
// Truncated power series multiply and divide as polynomials do.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/stepper.hpp"

using namespace nysalt;
using nysalt::test::draws;

namespace {

using S = series<4>;

S random_series(draws& random) {
  S result;
  for (double& c : result.coefficient) c = random.uniform(-1.0, 1.0);
  result.coefficient[0] = random.uniform(1.0, 2.0);
  return result;
}

/// A spring whose stiffness is the variable.
struct spring {
  static constexpr int dimension = 1;
  void force(const vector<S, 1>& q, vector<S, 1>& f) const { f[0] = -(S::variable() * q[0]); }
};

}  // namespace

BOOST_AUTO_TEST_CASE(products_drop_what_lies_beyond) {
  const S x = S::variable();
  const S y = (1.0 + x) * (1.0 + x) * (1.0 - x);  // 1 + x - x^2 - x^3
  BOOST_TEST((y.coefficient == std::array{1.0, 1.0, -1.0, -1.0, 0.0}));
  BOOST_TEST((x * x * x * x * x).coefficient[4] == 0.0);
  BOOST_TEST((x * x * (x * x)).coefficient[4] == 1.0);
}

BOOST_AUTO_TEST_CASE(division_undoes_multiplication) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const S a = random_series(random);
    const S b = random_series(random);
    const S c = (a / b) * b;
    // 1/b has coefficients up to 2^4, and each of the 5 terms rounds a few times.
    for (std::size_t k = 0; k < S::terms; ++k) {
      BOOST_TEST(std::abs(c.coefficient[k] - a.coefficient[k]) <= 64.0 * 2.2e-16 * 16.0);
    }
  }
  const S geometric = S(1.0) / (1.0 - S::variable());
  BOOST_TEST((geometric.coefficient == std::array{1.0, 1.0, 1.0, 1.0, 1.0}));
}

BOOST_AUTO_TEST_CASE(sums_and_multiples_go_by_coefficient) {
  draws random;
  const S a = random_series(random);
  const S b = random_series(random);
  for (std::size_t k = 0; k < S::terms; ++k) {
    BOOST_TEST((a + b).coefficient[k] == a.coefficient[k] + b.coefficient[k]);
    BOOST_TEST((a - b).coefficient[k] == a.coefficient[k] - b.coefficient[k]);
    BOOST_TEST((-a).coefficient[k] == -a.coefficient[k]);
    BOOST_TEST((2.0 * a).coefficient[k] == (a * 2.0).coefficient[k]);
  }
}

BOOST_AUTO_TEST_CASE(a_step_over_series_is_its_taylor_expansion) {
  const spring system;
  const stepper<spring, verlet::word> one(system, verlet::coefficients(), 1.0);
  phase_point<S, 1> x{vector<S, 1>(S(1.0)), vector<S, 1>(S(0.0))};
  one.step(x);
  BOOST_TEST((x.q[0].coefficient == std::array{1.0, -0.5, 0.0, 0.0, 0.0}));
  BOOST_TEST((x.p[0].coefficient == std::array{0.0, -1.0, 0.25, 0.0, 0.0}));
}
