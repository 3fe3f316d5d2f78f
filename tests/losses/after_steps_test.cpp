// SPDX-License-Identifier: BSL-1.0
// A pass over the data gives the bits of pair after pair over double, whatever the lanes and the threads.
#include "nysalt/losses/after_steps.hpp"

#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/one_step.hpp"
#include "../support/refusal.hpp"
#include "../support/sample_blocks.hpp"
#include "../support/systems.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/losses/own_loss.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr parameters_of<nystrom> theta{0.45, 0.38};

/// Trajectories of different lengths, among them empty ones and one longer than what a thread takes at once.
template <class S>
flow_map_data uneven_data(const S& system) {
  const vector<double, S::dimension> zero = Eigen::VectorXd::Zero(size(system));
  const normal_around<S::dimension> starts({zero, zero}, 0.1, 0.2);
  auto data = make_flow_map_data(system, starts, fine_steps<>(0.05),
                                 {.step = 0.4, .horizon = 0.4, .trajectories = 3783});
  data.first_of = {0, 0, 1, 3, 3, 20, 37, 60, 61};
  while (data.first_of.back() + 32 < 1900) {
    data.first_of.push_back(data.first_of.back() + data.first_of.size() % 31);
  }
  data.first_of.push_back(3783);
  data.first_of.push_back(3783);
  return data;
}

bool same(const squares& a, const squares& b) {
  return a.value == b.value && a.half_gradient == b.half_gradient && a.normal_matrix == b.normal_matrix;
}

template <Scalar R, class S>
void check_bits(const S& system, const flow_map_data& data, const metric& measure, int threads) {
  const one_step<nystrom, R> loss(system, data, measure, threads);
  const sample_blocks<nystrom, S> pairs(system, data, measure);
  const auto expected = pairs.by_trajectory(theta);
  BOOST_TEST_CONTEXT(lanes_in<R> << " lanes, " << threads << " threads") {
    const auto losses = trajectory_losses(loss, theta);
    const auto gradients = trajectory_gradients(loss, theta);
    BOOST_REQUIRE(losses.size() == expected.size());
    int differ = 0;
    for (std::size_t m = 0; m < losses.size(); ++m) {
      differ += losses[m] != expected[m].value || gradients[m] != expected[m].gradient();
    }
    BOOST_TEST(differ == 0);
    BOOST_TEST(same(squares_at(loss, theta), pairs(column_of(theta))));
    BOOST_TEST(!same(squares_at(loss, parameters_of<nystrom>{0.45, 0.38 + 1e-15}), pairs(column_of(theta))));
    // One pass without derivatives, three with.
    const int of_each = nystrom::word::evaluations_of_plain_step;
    BOOST_TEST(loss.evaluations() == 4 * of_each * std::int64_t(data.pairs()));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(lanes_and_threads_change_no_bit) {
  const henon_heiles galaxy;
  const auto data = uneven_data(galaxy);
  const metric measure(galaxy, data, coordinates::qp);
  for (const int threads : {1, 2, 3}) {
    check_bits<double>(galaxy, data, measure, threads);
    check_bits<detail::lanes>(galaxy, data, measure, threads);
  }
}

BOOST_AUTO_TEST_CASE(a_dynamic_dimension_with_modes_changes_no_bit) {
  const auto chain = linear_chain::between_walls(3, 1.0, 2.0);
  const auto data = uneven_data(chain);
  const metric measure(chain, data, coordinates::modes);
  check_bits<double>(chain, data, measure, 2);
  check_bits<detail::lanes>(chain, data, measure, 2);
}

namespace {
struct a_fork : potential_only {  // takes a branch, and says so
  static constexpr int lanes = 1;
};
}  // namespace

// Each trajectory adds its part of the mean to the whole: the mean over some has their parts, and no others.
BOOST_AUTO_TEST_CASE(some_trajectories_alone) {
  const henon_heiles galaxy;
  const normal_around<2> starts({vector<double, 2>(0.0, 0.0), vector<double, 2>(0.0, 0.0)}, 0.1, 0.2);
  constexpr int trajectories = 23;
  const auto data = make_flow_map_data(galaxy, starts, fine_steps<>(0.05),
                                       {.step = 0.4, .horizon = 3.2, .trajectories = trajectories});
  const metric measure(galaxy, data, coordinates::qp);
  const run_time_family family{nystrom()};
  const auto parts_of = [&](int every) {
    const after_steps<> loss(family, galaxy, data, state_error<detail::lanes>(measure),
                             {.steps = {1, 3}, .apart = 2, .every = every});
    return trajectory_losses(loss, column_of(theta));
  };
  const auto all = parts_of(1);
  for (const int every : {2, 5, 23, 40}) {
    const auto some = parts_of(every);
    const int counted = (trajectories + every - 1) / every;
    for (std::size_t m = 0; m < all.size(); ++m) {
      const bool counts = static_cast<int>(m) % every == 0;
      const double expected = counts ? all[m] * trajectories / counted : 0.0;
      BOOST_TEST(std::abs(some[m] - expected) <= 4e-16 * expected);  // two weights, each rounded
    }
  }
}

BOOST_AUTO_TEST_CASE(packs_are_for_systems_that_serve_them) {
  using packs = detail::lanes;
  static_assert(std::same_as<scalar_of_passes<henon_heiles>, packs>);
  static_assert(std::same_as<scalar_of_passes<potential_only>, packs>);
  static_assert(std::same_as<scalar_of_passes<relativistic>, packs>);
  static_assert(std::same_as<scalar_of_passes<black_box>, double>);
  static_assert(std::same_as<scalar_of_passes<a_fork>, double>);
  const black_box box;
  const normal_around<1> starts({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 0.5);
  const auto data =
      make_flow_map_data(box, starts, fine_steps<>(0.05), {.step = 0.4, .horizon = 2.0, .trajectories = 3});
  const metric measure(box, data, coordinates::qp);
  const one_step<nystrom, double> loss(box, data, measure);
  loss_value(loss, theta);  // derivatives along two parameters are carried even where no caller asks for them
  BOOST_TEST(loss.evaluations() == 2 * 15 * (1 + 2 * 2));
  squares_at(loss, theta);  // and count one each
  BOOST_TEST(loss.evaluations() == 2 * (2 * 15 * (1 + 2 * 2)));
  BOOST_TEST(refuses<std::invalid_argument>([&] { one_step<nystrom, packs>(box, data, measure); },
                                            {"black_box", "after_steps<double>"}));
}
