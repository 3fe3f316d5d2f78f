// SPDX-License-Identifier: BSL-1.0
// Losses over steps have the bits of window after window over double, whatever the number of parameters, and
// in a bath they take the noise that the data hold.
#include "../../src/nysalt/losses/after_steps.hpp"

#include "../support/learned.hpp"
#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/losses/window_error.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const after_steps_options five_steps{.steps = {5}};

const henon_heiles galaxy;
const family two_stages{nystrom()};
const auto starts = around_rest<2>(0.1, 0.2);
const Eigen::VectorXd theta = Eigen::Vector2d(0.45, 0.38);

/// Trajectories of 4, 5, 0, 11, 12, 9 and 40 steps: some are too short.
flow_map_data uneven_data() {
  auto data =
      make_flow_map_data(galaxy, starts, fine_steps(0.05), {.step = 0.4, .horizon = 16.2, .trajectories = 2});
  data.first_of = {0, 4, 9, 9, 20, 32, 41, 81};
  data.start.resize(81);
  data.finish.resize(81);
  return data;
}

/// Not at the start of the family, where derivatives may vanish by symmetry.
template <Family F>
detail::parameters_of<F> elsewhere() {
  auto theta = F::start();
  for (std::size_t k = 0; k < theta.size(); ++k) theta[k] += 0.01 * static_cast<double>(k + 1);
  return theta;
}

template <Family F>
void check_bits(const after_steps_options& options, std::size_t windows) {
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  const sample_blocks<F, henon_heiles> blocks(galaxy, data, measure, options);
  const Eigen::VectorXd at = column_of(elsewhere<F>());
  const auto expected = blocks(at);
  auto in_threads = options;
  in_threads.execution.threads = 2;
  const after_steps<> loss(family(F()), galaxy, data, state_error(measure), in_threads);
  BOOST_TEST_CONTEXT(F::name << " over " << options.steps.back() << " steps") {
    BOOST_TEST(blocks.windows() == windows);
    BOOST_TEST(same(loss.at(at), expected));
    BOOST_TEST(loss.value(at) == expected.value);
    BOOST_TEST(expected.half_gradient.cwiseAbs().minCoeff() > 1e-9);
    auto beside = at;
    beside[at.size() - 1] += 1e-15;
    BOOST_TEST(!same(loss.at(beside), expected));
    // A pass for each two parameters, and one without derivatives.
    const std::int64_t passes = 2 * ((F::parameters + 1) / 2) + 1;
    const std::int64_t of_run =
        F::letters.evaluations_to_open + options.steps.back() * std::int64_t{F::letters.evaluations_per_step};
    BOOST_TEST(loss.evaluations() == passes * of_run * static_cast<std::int64_t>(windows));
  }
}

const family symmetric = two_stages_in(placement::symmetric);
const family at_end = two_stages_in(placement::end);
const family in_middle = two_stages_in(placement::middle);

constexpr double h = 0.4;
const detail::parameters_of<nystrom> maker{0.45, 0.38};
const detail::parameters_of<nystrom> far{0.55, 0.42};
const in_bath<henon_heiles> warm(henon_heiles(), bath::of_sigma(0.7, 0.1));

flow_map_data made(const family& family, int parts) {
  return made_by_steps(warm, starts, member(family, {maker.begin(), maker.end()}),
                       {.step = h, .trajectories = 20, .parts = parts});
}

/// The same data in fewer parts.
flow_map_data in_parts(flow_map_data data, int parts) {
  const int together = data.noise_parts / parts;
  const detail::coarse_graining coarse(warm.bath().friction() * h / data.noise_parts);
  detail::vector_list noise;
  for (std::size_t first = 0; first < data.noise.size(); first += static_cast<std::size_t>(together)) {
    Eigen::VectorXd of_one(2);
    coarse.over(data.noise, first, std::size_t(together), of_one);
    noise.push_back(of_one);
  }
  data.noise = noise;
  data.noise_parts = parts;
  return data;
}

double loss_of(const family& family, const flow_map_data& data, const detail::parameters_of<nystrom>& theta,
               int steps = 1) {
  const metric measure(warm, data, coordinates::qp);
  const after_steps<> loss(family, warm, data, state_error(measure), {.steps = {steps}});
  return loss.value(column_of(theta));
}

void check_noise(const family& family, int parts, int steps) {
  const auto data = made(family, parts);
  // Who made the data has no loss but that of rounding; increments are .03 or more.
  const double rounding = 30.0 * steps * eps / 0.03;
  BOOST_TEST(loss_of(family, data, maker, steps) <= 4.0 * rounding * rounding);
  BOOST_TEST(loss_of(family, data, far, steps) > 1e-8);
  // With the noise of other pairs the loss is some half of the increments.
  auto shuffled = data;
  const std::size_t numbers = data.noise.size();
  for (std::size_t n = 0; n < numbers; ++n) {
    shuffled.noise[n] = data.noise[(n + static_cast<std::size_t>(parts)) % numbers];
  }
  BOOST_TEST(loss_of(family, shuffled, maker, steps) > 0.1);
  // The noise of each step counts, the last one's too.
  shuffled = data;
  const std::size_t last = numbers - static_cast<std::size_t>(parts);  // of the last window's last step
  shuffled.noise[last].swap(shuffled.noise[last - static_cast<std::size_t>(parts)]);
  BOOST_TEST(loss_of(family, shuffled, maker, steps) > 1e-5);
}

struct a_fork : potential_only {  // takes a branch, and says so
  static constexpr int lanes = 1;
};

}  // namespace

// The same for the energy error: learning/own_loss_test.cpp.
BOOST_AUTO_TEST_CASE(bits_are_those_of_window_after_window) {
  check_bits<nystrom>(five_steps, 1 + 7 + 8 + 5 + 36);
  check_bits<nystrom>({.steps = {5}, .apart = 5}, 1 + 2 + 2 + 1 + 8);
  check_bits<nystrom>({.steps = {1, 2, 5}, .apart = 3}, 1 + 3 + 3 + 2 + 12);
  check_bits<aba<4>>({}, 81);  // three parameters, two at a time
  check_bits<aba<4>>(five_steps, 57);
  check_bits<aba<4>>({.steps = {10}}, 2 + 3 + 31);
  // One parameter. A run of five steps of B A B A B takes eleven evaluations, five plain ones fifteen.
  check_bits<bab<2>>(five_steps, 57);
  constexpr const word& letters = bab<2>::letters;
  static_assert(letters.evaluations_to_open + 5 * letters.evaluations_per_step == 11);
  static_assert(5 * letters.evaluations_of_plain_step == 15);
}

// In modes, of a dynamic dimension, with masses: trajectory by trajectory, one longer than what a thread
// takes at once, and empty ones.
BOOST_AUTO_TEST_CASE(each_trajectory_has_the_bits_of_its_pairs) {
  const auto chain = linear_chain::between_walls(3, 1.0, 2.0);
  auto data = make_flow_map_data(chain, around_rest<Eigen::Dynamic>(0.1, 0.2, 3), fine_steps(0.05),
                                 {.step = 0.4, .horizon = 0.4, .trajectories = 2100});
  data.first_of = {0, 0, 1, 3, 3, 20, 37, 60, 61, 200, 2100, 2100};
  const metric measure(chain, data, coordinates::modes);
  const after_steps<> loss(two_stages, chain, data, state_error(measure), {.execution = {.threads = 2}});
  const sample_blocks<nystrom, linear_chain> pairs(chain, data, measure);
  const auto expected = pairs.by_trajectory(array_of<2>(theta));
  const auto losses = loss.by_trajectory(theta);
  const auto gradients = trajectory_gradients(loss, theta);
  BOOST_REQUIRE(losses.size() == expected.size());
  int differ = 0;
  for (std::size_t m = 0; m < losses.size(); ++m) {
    differ += losses[m] != expected[m].value;
    // Products of the same numbers are added in another order: 6 residuals of 1900 pairs at most.
    const double off = (gradients[m] - expected[m].gradient()).norm();
    BOOST_TEST(off <= 1e-12 * (losses[m] + gradients[m].norm()));
  }
  BOOST_TEST(differ == 0);
  BOOST_TEST(same(loss.at(theta), pairs(theta)));
  BOOST_TEST(!same(loss.at(Eigen::Vector2d(0.45, 0.38 + 1e-15)), pairs(theta)));
}

// Without a bath it is that of dual numbers, to the bit: bits_are_those_of_window_after_window.
BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const auto noisy = made(symmetric, 2);
  const metric measure(warm, noisy, coordinates::qp);
  const after_steps<> loss(symmetric, warm, noisy, state_error(measure));
  const Eigen::VectorXd at = column_of(far);
  const Eigen::VectorXd ours = loss.at(at).gradient();
  const auto value = [&](const Eigen::VectorXd& x) { return loss.value(x); };
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const central_difference difference(value, at, k);
    const double s = 1e-4;
    // A residual is the difference of numbers below 1, or below the increments' inverse 1/.05, after some
    // hundred roundings.
    const double rounding = 2.0 * 100.0 * eps * 20.0 * std::sqrt(value(at)) / s;
    const double off = std::abs(ours[k] - difference(s));
    BOOST_TEST(off <= 2.0 * difference.truncation(s) + rounding);
    BOOST_TEST(off <= 1e-4 * ours.norm());  // which says something
  }
}

// Each trajectory adds its part of the mean to the whole: the mean over some has their parts, and no others.
BOOST_AUTO_TEST_CASE(some_trajectories_alone) {
  constexpr int trajectories = 23;
  const auto data = make_flow_map_data(galaxy, starts, fine_steps(0.05),
                                       {.step = 0.4, .horizon = 3.2, .trajectories = trajectories});
  const metric measure(galaxy, data, coordinates::qp);
  const auto parts_of = [&](int every) {
    const after_steps<> loss(two_stages, galaxy, data, state_error<detail::lanes>(measure),
                             {.steps = {1, 3}, .apart = 2, .every = every});
    return loss.by_trajectory(theta);
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
  static_assert(std::same_as<detail::scalar_of_passes<henon_heiles>, packs>);
  static_assert(std::same_as<detail::scalar_of_passes<potential_only>, packs>);
  static_assert(std::same_as<detail::scalar_of_passes<relativistic>, packs>);
  static_assert(std::same_as<detail::scalar_of_passes<black_box>, double>);
  static_assert(std::same_as<detail::scalar_of_passes<a_fork>, double>);
  const black_box box;
  const auto data = make_flow_map_data(box, around_rest<1>(0.5, 0.5), fine_steps(0.05),
                                       {.step = 0.4, .horizon = 2.0, .trajectories = 3});
  const metric measure(box, data, coordinates::qp);
  const after_steps<double> loss(two_stages, box, data, state_error<double>(measure));
  loss.value(theta);  // derivatives along two parameters are carried even where no caller asks for them
  BOOST_TEST(loss.evaluations() == 2 * 15 * (1 + 2 * 2));
  loss.at(theta);  // and count one each
  BOOST_TEST(loss.evaluations() == 2 * (2 * 15 * (1 + 2 * 2)));
  BOOST_TEST(refuses([&] { after_steps<packs>(two_stages, box, data, state_error<packs>(measure)); },
                     {"black_box", "after_steps<double>"}));
  BOOST_TEST(refuses([&] { energy_error(box, data); }, {"energy loss", "potential", "black_box"}));
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  const auto refused = [&](const std::vector<int>& steps, said words) {
    const auto made = [&] {
      after_steps<>(two_stages, galaxy, data, state_error(measure), {.steps = steps});
    };
    return refuses(made, words);
  };
  BOOST_TEST(refused({41}, {"41 steps", "longer horizon"}));
  BOOST_TEST(refused({0}, {"from 1 on", "got 0"}));
  BOOST_TEST(refused({-1}, {"from 1 on", "got -1"}));
  BOOST_TEST(refused({}, {"from 1 on"}));
  BOOST_TEST(refused({2, 2}, {"rising", "2, 2"}));
  BOOST_TEST(refused({4, 3}, {"rising", "4, 3"}));
  BOOST_TEST(!refused({40}, {}));
}

BOOST_AUTO_TEST_CASE(each_step_takes_its_own_noise) {
  for (const int steps : {1, 3}) {
    check_noise(at_end, 1, steps);
    check_noise(in_middle, 1, steps);
    check_noise(symmetric, 2, steps);
  }
  const auto data = made(symmetric, 2);
  const metric measure(warm, data, coordinates::qp);
  const after_steps<> loss(symmetric, warm, data, state_error(measure));
  loss.value(column_of(maker));
  BOOST_TEST(loss.evaluations() == 2 * 200);  // those of plain steps
}

BOOST_AUTO_TEST_CASE(more_parts_than_the_letters_need_are_put_together) {
  const auto sixths = made(symmetric, 6);
  for (const auto& theta : {maker, far}) {
    const double expected = loss_of(symmetric, sixths, theta);
    // Noise differs by rounding: so do residuals, which at the minimum are nothing else.
    const double rounding = 1e4 * eps * expected + std::pow(100.0 * eps, 2);
    BOOST_TEST(std::abs(loss_of(symmetric, in_parts(sixths, 2), theta) - expected) <= rounding);
  }
  const auto quarters = made(at_end, 4);
  BOOST_TEST(loss_of(at_end, quarters, maker) <= 1e-24);
  BOOST_TEST(loss_of(at_end, in_parts(quarters, 2), maker) <= 1e-24);
  BOOST_TEST(loss_of(in_middle, quarters, maker) > 1e-3);  // it is another method
}

BOOST_AUTO_TEST_CASE(data_without_the_noise_that_is_needed_are_refused) {
  const auto refused = [](const flow_map_data& data, const family& family, said w) {
    return refuses([&] { loss_of(family, data, maker); }, w);
  };
  auto without = made(symmetric, 2);
  without.noise.clear();
  without.noise_parts = 0;
  BOOST_TEST(
      refused(without, symmetric, {"a multiple of 2 for the word OABABAO", "got 0", "noise_parts = 2"}));
  BOOST_TEST(refused(without, at_end, {"a multiple of 1 for the word ABABAO", "got 0"}));
  const auto thirds = made(at_end, 3);
  BOOST_TEST(refused(thirds, symmetric, {"got 3", "noise_parts = 2"}));
  BOOST_TEST(!refused(thirds, in_middle, {}));
  BOOST_TEST(refused(made(symmetric, 2), nystrom(), {"must have a letter O"}));
}

BOOST_AUTO_TEST_CASE(without_sigma_no_noise_is_needed) {
  for (const double friction : {0.0, 0.7}) {
    const in_bath<henon_heiles> quiet(henon_heiles(), bath::of_sigma(friction, 0.0));
    auto data = made_by_steps(quiet, starts, member(symmetric, {maker.begin(), maker.end()}), {.step = h});
    const metric measure(quiet, data, coordinates::qp);
    const auto loss = [&] {
      return after_steps<>(symmetric, quiet, data, state_error(measure)).value(column_of(maker));
    };
    BOOST_TEST(loss() <= 1e-24);
    data.noise_parts = 0;
    data.noise.clear();
    BOOST_TEST(loss() <= 1e-24);
    data.finish[0].p[0] += 1e-3;
    BOOST_TEST(loss() > 1e-9);
  }
}
