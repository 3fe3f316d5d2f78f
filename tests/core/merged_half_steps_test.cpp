// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 3 s at -O0, 0.1 s at -O1.
// Two letters O that meet between steps: one draw for the run, and two independent halves for who looks.
#include "nysalt/detail/merged_half_steps.hpp"

#include <cmath>
#include <vector>

#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "../support/systems.hpp"
#include "nysalt/noises/counter_noise.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using O = ornstein_uhlenbeck;
using cursor = noise_cursor<counter_noise, double, 2, no_room>;
using state = flow_state<double, 2>;

const counter_noise source(seed(1));
const potential_only system_of_unit_masses;

/// c and h are such that the two halves differ.
struct meeting {
  bath heat_bath;
  O::prepared<double> end = O::prepare(0.3, 0.5, heat_bath);
  O::prepared<double> begin = O::prepare(0.7, 0.5, heat_bath);
  merged_half_steps<double> seam{end, begin, heat_bath.sigma() > 0.0};
};

cursor at(std::uint64_t trajectory, std::int64_t step, bool bath_is_warm = true) {
  return {&source, trajectory, step, 2, bath_is_warm, {}, {}};
}
state moving(double p) { return {{{0.1, 0.2}, {p, p}}, {0.0, 0.0}}; }

/// Momenta of what is at rest before a letter: its noise.
vector<double, 2> end_of(const meeting& two, std::uint64_t trajectory, std::int64_t step) {
  auto x = moving(0.0);
  auto where = at(trajectory, step);
  two.seam.end(system_of_unit_masses, where, x);
  return x.p;
}
vector<double, 2> begin_of(const meeting& two, std::uint64_t trajectory, std::int64_t step) {
  auto x = moving(0.0);
  auto where = at(trajectory, step);
  two.seam.begin(system_of_unit_masses, where, x);
  return x.p;
}
vector<double, 2> across(const meeting& two, std::uint64_t trajectory, std::int64_t step) {
  auto x = moving(0.0);
  auto where = at(trajectory, step);
  two.seam.cross(system_of_unit_masses, where, x);
  return x.p;
}

struct samples {
  std::vector<double> first;   // should be xi_1
  std::vector<double> second;  // should be xi_2
};

/// How far the covariance is from the identity, in standard errors, which are sqrt(2/n) for variances and
/// sqrt(1/n) for the covariance.
double off_identity(const samples& s) {
  const auto n = static_cast<double>(s.first.size());
  return std::max({std::abs(covariance(s.first, s.first) - 1.0) * std::sqrt(n / 2.0),
                   std::abs(covariance(s.second, s.second) - 1.0) * std::sqrt(n / 2.0),
                   std::abs(covariance(s.first, s.second)) * std::sqrt(n)});
}

const std::vector<meeting> meetings{{bath::of_sigma(0.8, 0.6)}, {bath::of_sigma(0.0, 0.6)}};
constexpr std::uint64_t many = 20'000;

}  // namespace

BOOST_AUTO_TEST_CASE(the_halves_are_independent_and_standard_normal) {
  constexpr double each = false_alarms / 18;  // two baths, nine comparisons
  const double allowed = standard_errors(each);
  for (const auto& two : meetings) {
    samples same_step;
    samples next_step;
    for (std::uint64_t m = 0; m < many; ++m) {
      same_step.first.push_back(end_of(two, m, 3)[1] / two.end.deviation);
      same_step.second.push_back(begin_of(two, m, 3)[1] / two.begin.deviation);
      next_step.first.push_back(same_step.second.back());
      next_step.second.push_back(end_of(two, m, 4)[1] / two.end.deviation);
    }
    BOOST_TEST(off_identity(same_step) < allowed);
    BOOST_TEST(off_identity(next_step) < allowed);
    BOOST_TEST(mean_off(same_step.first, 0.0, 1.0) < allowed);
    BOOST_TEST(mean_off(same_step.second, 0.0, 1.0) < allowed);
    BOOST_TEST(kolmogorov_smirnov(same_step.second) < kolmogorov_smirnov_limit(each));
  }
}

// xi_1 = u xi + v zeta with xi_2 = v xi + u zeta are correlated by 2 u v, and without zeta they are one.
BOOST_AUTO_TEST_CASE(a_wrong_sign_or_weight_would_be_found_out) {
  const auto& two = meetings.front();
  const double of_end = two.begin.decay * two.end.deviation;
  const double u = of_end / std::hypot(of_end, two.begin.deviation);
  const double v = two.begin.deviation / std::hypot(of_end, two.begin.deviation);
  samples right;
  samples wrong_sign;
  samples wrong_weight;
  for (std::uint64_t m = 0; m < many; ++m) {
    vector<double, 2> xi;
    vector<double, 2> zeta;
    source.normals({m, 3, 0}, xi);
    source.halving({m, 3, 0}, zeta);
    right.first.push_back(u * xi[1] + v * zeta[1]);
    right.second.push_back(v * xi[1] - u * zeta[1]);
    wrong_sign.first.push_back(right.first.back());
    wrong_sign.second.push_back(v * xi[1] + u * zeta[1]);
    wrong_weight.first.push_back(u * xi[1] + u * zeta[1]);
    wrong_weight.second.push_back(right.second.back());
    // What the seam itself does, to rounding: two products of numbers below 6 and a sum.
    BOOST_TEST(std::abs(end_of(two, m, 3)[1] / two.end.deviation - right.first.back()) <= 32.0 * eps);
    BOOST_TEST(std::abs(begin_of(two, m, 3)[1] / two.begin.deviation - right.second.back()) <= 32.0 * eps);
  }
  BOOST_TEST(off_identity(right) < standard_errors(false_alarms / 3));
  BOOST_TEST(off_identity(wrong_sign) > 40.0);
  BOOST_TEST(off_identity(wrong_weight) > 10.0);
}

// a_2 (a_1 p + s_1 xi_1) + s_2 xi_2 = a_2 a_1 p + s xi, to some ten roundings of numbers below 6.
BOOST_AUTO_TEST_CASE(what_crosses_the_seam_is_its_two_halves) {
  for (const auto& two : meetings) {
    const double s = std::hypot(two.begin.decay * two.end.deviation, two.begin.deviation);
    for (std::uint64_t m = 0; m < 100; ++m) {
      auto merged = moving(1.5);
      auto plain = merged;
      auto where = at(m, 5);
      two.seam.cross(system_of_unit_masses, where, merged);
      two.seam.end(system_of_unit_masses, where, plain);
      const double between = plain.p[0];
      two.seam.begin(system_of_unit_masses, where, plain);
      BOOST_TEST((merged.p - plain.p).cwiseAbs().maxCoeff() <= 64.0 * eps);
      BOOST_TEST(std::abs(merged.p[0] - between) > 1e-6);
      vector<double, 2> xi;
      source.normals({m, 5, 0}, xi);
      BOOST_TEST(std::abs(across(two, m, 5)[0] - s * xi[0]) <= 64.0 * eps);
      BOOST_TEST((merged.q == moving(0.0).q));
    }
  }
}

BOOST_AUTO_TEST_CASE(before_the_first_step_there_is_only_the_half_that_begins_it) {
  const auto& two = meetings.front();
  for (std::uint64_t m = 0; m < 10; ++m) {
    BOOST_TEST((across(two, m, 0) == begin_of(two, m, 0)));
    BOOST_TEST((across(two, m, 1) != begin_of(two, m, 1)));
    BOOST_TEST((end_of(two, m, 0) == vector<double, 2>::Zero()));
  }
}

BOOST_AUTO_TEST_CASE(a_cold_bath_damps_and_draws_nothing) {
  const meeting two{bath::of_sigma(0.8, 0.0)};
  auto x = moving(1.0);
  cursor where{nullptr, 0, 3, 2, false, {}, {}};  // a draw would crash
  two.seam.cross(system_of_unit_masses, where, x);
  BOOST_TEST(x.p[0] == two.begin.decay * two.end.decay);
  x = moving(1.0);
  two.seam.end(system_of_unit_masses, where, x);
  BOOST_TEST(x.p[0] == two.end.decay);
  x = moving(1.0);
  two.seam.begin(system_of_unit_masses, where, x);
  BOOST_TEST(x.p[0] == two.begin.decay);
}

// Letters O with coefficient 0 at both ends are odd, but not NaN.
BOOST_AUTO_TEST_CASE(a_seam_without_a_duration_does_nothing) {
  const auto heat_bath = bath::of_sigma(0.8, 0.6);
  const auto none = O::prepare(0.0, 0.5, heat_bath);
  const merged_half_steps<double> seam(none, none, true);
  auto x = moving(1.0);
  auto where = at(0, 3);
  seam.end(system_of_unit_masses, where, x);
  seam.begin(system_of_unit_masses, where, x);
  seam.cross(system_of_unit_masses, where, x);
  BOOST_TEST((x.p == moving(1.0).p));
}
