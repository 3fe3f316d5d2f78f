// SPDX-License-Identifier: BSL-1.0
// A free particle in a bath is an Ornstein-Uhlenbeck process, which letters O solve exactly: at any time,
// at steps or not, the momenta have the stationary distribution, and a word whose halves meet is no
// exception.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <vector>

#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// No force; a light mass and one of 4.
struct free_particles {
  static constexpr int dimension = 2;
  double inverse_mass(Eigen::Index i) const { return i == 0 ? 1.0 : 0.25; }
  template <class T>
  void force(const vector<T, 2>&, vector<T, 2>& f) const {
    f[0] = f[1] = T(0.0);
  }
};

constexpr double step = 0.4;
constexpr std::int64_t steps = 6;
constexpr int trajectories = 8000;

/// The momenta of one particle at each step, over M^{1/2}, of many trajectories that start at 1.
using momenta = std::vector<std::vector<double>>;

template <class M>
momenta seen(const in_bath<free_particles>& system, const M& method, Eigen::Index particle,
             std::int64_t every = 1) {
  using T = pack<double, 16>;
  const double root = std::sqrt(system.inverse_mass(particle));
  const auto fixed = make_stepper(system, method, step, counter_noise(seed(11)));
  momenta p(static_cast<std::size_t>(steps + 1));
  for (int first = 0; first < trajectories; first += 16) {
    auto run = fixed.open(phase_point<T, 2>{{T(0.0), T(0.0)}, {T(1.0 / root), T(1.0 / root)}},
                          static_cast<std::uint64_t>(first));
    fixed.advance(run, steps, every, [&](std::int64_t n, const auto& x) {
      for (int k = 0; k < 16; ++k) {
        p[static_cast<std::size_t>(n)].push_back(lane(x.p[particle], k) * root);
      }
    });
  }
  return p;
}

/// How far means, variances and covariances of all steps are from those of the process, in standard errors.
/// With a = e^{-gamma h}: <p_n> = a^n, <p_m p_n> - <p_m><p_n> = a^(n - m) v_m, v_m = deviation(m h)^2.
double off(const momenta& p, const bath& heat_bath) {
  double worst = 0.0;
  for (std::size_t m = 1; m < p.size(); ++m) {
    const double time = static_cast<double>(m) * step;
    const double sd = heat_bath.deviation(time);
    worst = std::max({worst, mean_off(p[m], heat_bath.decay(time), sd), deviation_off(p[m], sd)});
    for (std::size_t n = m + 1; n < p.size(); ++n) {
      const double later = heat_bath.deviation(static_cast<double>(n) * step);
      const double expected = heat_bath.decay(static_cast<double>(n - m) * step) * sd * sd;
      // A covariance c of normal numbers has the error sqrt((v_m v_n + c^2)/count).
      const double error =
          std::sqrt((sd * sd * later * later + expected * expected) / static_cast<double>(p[m].size()));
      worst = std::max(worst, std::abs(covariance(p[m], p[n]) - expected) / error);
    }
  }
  return worst;
}

const bath warm = bath::of_sigma(0.5, 0.8);
const in_bath system_in_bath(free_particles(), warm);

// The worst of 27 numbers, of eight runs.
const double allowed = standard_errors(false_alarms / (8 * 27));

}  // namespace

BOOST_AUTO_TEST_CASE(momenta_at_the_steps_have_the_law_of_the_process) {
  for (const Eigen::Index particle : {0, 1}) {
    BOOST_TEST(off(seen(system_in_bath, obabo(), particle), warm) < allowed);
    BOOST_TEST(off(seen(system_in_bath, tabulated(obabo{}), particle), warm) < allowed);
    BOOST_TEST(off(seen(system_in_bath, baoab(), particle), warm) < allowed);
    BOOST_TEST(off(seen(system_in_bath, baoab_2x(), particle), warm) < allowed);
  }
}

BOOST_AUTO_TEST_CASE(also_without_friction) {
  const bath heating = bath::of_sigma(0.0, 0.8);
  BOOST_TEST(off(seen(in_bath(free_particles(), heating), obabo(), 0), heating) < allowed);
}

// Looked at every third step: the same momenta there, to the bit.
BOOST_AUTO_TEST_CASE(what_is_seen_does_not_depend_on_how_often_one_looks) {
  const auto each = seen(system_in_bath, obabo(), 0);
  const auto third = seen(system_in_bath, obabo(), 0, 3);
  BOOST_TEST((third[3] == each[3]));
  BOOST_TEST((third[6] == each[6]));
  BOOST_TEST(third[1].empty());
}

BOOST_AUTO_TEST_CASE(another_bath_would_be_found_out) {
  const auto p = seen(system_in_bath, obabo(), 0);
  BOOST_TEST(off(p, bath::of_sigma(0.65, 0.8)) > 2.0 * allowed);
  BOOST_TEST(off(p, bath::of_sigma(0.5, 0.9)) > 2.0 * allowed);
  // Momenta that are taken for those of the next step.
  auto late = p;
  std::rotate(late.begin() + 1, late.begin() + 2, late.end());
  BOOST_TEST(off(late, warm) > 2.0 * allowed);
}
