// SPDX-License-Identifier: BSL-1.0
// The loss of a family in a bath: a step with the noise that the data hold.
#include <boost/test/unit_test.hpp>

#include "../support/central_difference.hpp"
#include "../support/one_step.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/steps_in_bath.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/thermostatted.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using galaxy = in_bath<henon_heiles>;
template <placement P>
using family = thermostatted_family<nystrom, P>;
using symmetric = family<placement::symmetric>;

constexpr double h = 0.4;
constexpr parameters_of<nystrom> maker{0.45, 0.38};
constexpr parameters_of<nystrom> elsewhere{0.55, 0.42};
const galaxy warm(henon_heiles(), bath::of_sigma(0.7, 0.1));
const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);

template <Family F>
flow_map_data made(int parts, std::int64_t trajectories = 20) {
  return made_by_steps(warm, starts, member<F>(maker),
                       {.step = h, .trajectories = trajectories, .parts = parts});
}

/// The same data in fewer parts.
flow_map_data in_parts(flow_map_data data, int parts) {
  const int together = data.noise_parts / parts;
  const coarse_graining coarse(warm.bath().friction() * h / data.noise_parts);
  vector_list noise;
  for (std::size_t first = 0; first < data.noise.size(); first += static_cast<std::size_t>(together)) {
    Eigen::VectorXd of_one(2);
    coarse.over(data.noise, first, std::size_t(together), of_one);
    noise.push_back(of_one);
  }
  data.noise = noise;
  data.noise_parts = parts;
  return data;
}

template <Family F>
double loss_of(const flow_map_data& data, const parameters_of<nystrom>& theta, int steps = 1) {
  const metric measure(warm, data, coordinates::qp);
  const after_steps<> loss(run_time_family(F()), warm, data, state_error(measure), {.steps = {steps}});
  return loss_value(loss, column_of(theta));
}

/// The formula, window by window over double; each letter O takes the noise given for its position.
template <Family F>
double loss_by_hand(const flow_map_data& data, const parameters_of<nystrom>& theta, std::size_t steps) {
  const auto c = F::coefficients(theta);
  const std::string letters = F::word::letters();
  const bath& heat_bath = warm.bath();
  vector<double, 2> of_q(0.0, 0.0), of_p(0.0, 0.0), sigma_q(0.0, 0.0), sigma_p(0.0, 0.0);
  double windows = 0.0;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t n = data.first_of[m]; n + steps <= data.first_of[m + 1]; ++n) {
      phase_point<double, 2> x = data.start[n];
      auto next = n * static_cast<std::size_t>(data.noise_parts);
      for (std::size_t i = 0; i < steps * letters.size(); ++i) {
        const char letter = letters[i % letters.size()];
        const double time = c[i % letters.size()] * h;
        vector<double, 2> f;
        force<double>(warm, x.q, f);
        if (letter == 'A') x.q += x.p * time;
        if (letter == 'B') x.p += f * time;
        if (letter == 'O') x.p = x.p * heat_bath.decay(time) + data.noise[next++] * heat_bath.deviation(time);
      }
      of_q += (x.q - data.finish[n + steps - 1].q).cwiseAbs2();
      of_p += (x.p - data.finish[n + steps - 1].p).cwiseAbs2();
      windows += 1.0;
    }
  }
  const auto pairs = static_cast<double>(data.pairs());
  for (std::size_t n = 0; n < data.pairs(); ++n) {
    sigma_q += (data.start[n].q - data.finish[n].q).cwiseAbs2() / pairs;
    sigma_p += (data.start[n].p - data.finish[n].p).cwiseAbs2() / pairs;
  }
  return (of_q.cwiseQuotient(sigma_q).sum() + of_p.cwiseQuotient(sigma_p).sum()) / windows;
}

template <Family F>
void check_formula(int parts, int steps) {
  const auto data = made<F>(parts);
  // Some thirty operations a step, and 200 windows added.
  BOOST_TEST(loss_of<F>(data, elsewhere, steps) == loss_by_hand<F>(data, elsewhere, std::size_t(steps)),
             boost::test_tools::tolerance(200 * 30 * steps * eps));
  // Who made the data has no loss but that of rounding; increments are .03 or more.
  const double rounding = 30.0 * steps * eps / 0.03;
  BOOST_TEST(loss_of<F>(data, maker, steps) <= 4.0 * rounding * rounding);
  BOOST_TEST(loss_of<F>(data, elsewhere, steps) > 1e-8);
  // With the noise of other pairs the loss is some half of the increments.
  auto shuffled = data;
  const std::size_t numbers = data.noise.size();
  for (std::size_t n = 0; n < numbers; ++n) {
    shuffled.noise[n] = data.noise[(n + static_cast<std::size_t>(parts)) % numbers];
  }
  BOOST_TEST(loss_of<F>(shuffled, maker, steps) > 0.1);
  // The noise of each step counts, the last one's too.
  shuffled = data;
  const std::size_t last = numbers - static_cast<std::size_t>(parts);  // of the last window's last step
  shuffled.noise[last].swap(shuffled.noise[last - static_cast<std::size_t>(parts)]);
  BOOST_TEST(loss_of<F>(shuffled, maker, steps) > 1e-5);
}

/// Trajectories of different lengths, among them empty ones and one longer than what a thread takes at once.
flow_map_data uneven_data() {
  auto data = made<symmetric>(2, 350);
  data.first_of = {0, 0, 1, 3, 3, 20, 37, 60, 61};
  while (data.first_of.back() < 1700) {
    data.first_of.push_back(data.first_of.back() + data.first_of.size() % 31);
  }
  data.first_of.push_back(data.pairs());
  return data;
}

template <Scalar R>
std::vector<Eigen::VectorXd> gradients(const flow_map_data& data, int threads, int steps = 1) {
  const metric measure(warm, data, coordinates::qp);
  const after_steps<R> loss(run_time_family(symmetric()), warm, data, state_error<R>(measure),
                            {.steps = {steps}, .threads = threads});
  return trajectory_gradients(loss, column_of(elsewhere));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_loss_is_that_of_a_step_with_its_noise) {
  for (const int steps : {1, 3}) {
    check_formula<family<placement::end>>(1, steps);
    check_formula<family<placement::middle>>(1, steps);
    check_formula<symmetric>(2, steps);
  }
}

BOOST_AUTO_TEST_CASE(more_parts_than_the_letters_need_are_put_together) {
  const auto sixths = made<symmetric>(6);
  for (const auto& theta : {maker, elsewhere}) {
    const double expected = loss_of<symmetric>(sixths, theta);
    // Noise differs by rounding: so do residuals, which at the minimum are nothing else.
    const double rounding = 1e4 * eps * expected + std::pow(100.0 * eps, 2);
    BOOST_TEST(std::abs(loss_of<symmetric>(in_parts(sixths, 2), theta) - expected) <= rounding);
  }
  const auto quarters = made<family<placement::end>>(4);
  BOOST_TEST(loss_of<family<placement::end>>(quarters, maker) <= 1e-24);
  BOOST_TEST(loss_of<family<placement::end>>(in_parts(quarters, 2), maker) <= 1e-24);
  BOOST_TEST(loss_of<family<placement::middle>>(quarters, maker) > 1e-3);  // it is another method
}

BOOST_AUTO_TEST_CASE(lanes_and_threads_change_no_bit) {
  const auto data = uneven_data();
  const auto expected = gradients<double>(data, 1);
  for (const int threads : {1, 2, 3}) {
    BOOST_TEST((gradients<double>(data, threads) == expected));
    BOOST_TEST((gradients<detail::lanes>(data, threads) == expected));
  }
  const auto of_three = gradients<double>(data, 1, 3);
  BOOST_TEST((gradients<double>(data, 2, 3) == of_three));
  BOOST_TEST((gradients<detail::lanes>(data, 2, 3) == of_three));
  BOOST_TEST((gradients<detail::lanes>(data, 3, 3) == of_three));
  BOOST_TEST((of_three != expected));
  auto other = data;
  other.noise[other.noise.size() - 1][1] += 1e-12;
  BOOST_TEST((gradients<double>(other, 1) != expected));
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const auto data = made<symmetric>(2);
  const metric measure(warm, data, coordinates::qp);
  const one_step<symmetric> loss(warm, data, measure);
  const Eigen::VectorXd ours = squares_at(loss, elsewhere).gradient();
  const auto value = [&](const parameters_of<nystrom>& theta) { return loss_value(loss, theta); };
  for (std::size_t k = 0; k < 2; ++k) {
    const central_difference difference(value, elsewhere, k);
    const double s = 1e-4;
    const double error = difference.truncation(s);
    // Each of 800 squares rounds.
    const double rounding = 800.0 * eps * loss_value(loss, elsewhere) / s;
    const double off = std::abs(ours[static_cast<Eigen::Index>(k)] - difference(s));
    BOOST_TEST(off <= 2.0 * error + rounding);
    BOOST_TEST(off <= 1e-5 * ours.norm());  // which says something
  }
}

BOOST_AUTO_TEST_CASE(evaluations_are_those_of_plain_steps) {
  const auto data = made<symmetric>(2);
  const metric measure(warm, data, coordinates::qp);
  const one_step<symmetric> loss(warm, data, measure);
  loss_value(loss, maker);
  BOOST_TEST(loss.evaluations() == 2 * 200);
}

BOOST_AUTO_TEST_CASE(data_without_the_noise_that_is_needed_are_refused) {
  const auto refused = [](const flow_map_data& data, auto of, std::initializer_list<std::string_view> w) {
    return refuses<wrong>([&] { loss_of<decltype(of)>(data, maker); }, w);
  };
  auto without = made<symmetric>(2);
  without.noise.clear();
  without.noise_parts = 0;
  BOOST_TEST(
      refused(without, symmetric(), {"a multiple of 2 for the word OABABAO", "got 0", "noise_parts = 2"}));
  BOOST_TEST(refused(without, family<placement::end>(), {"a multiple of 1 for the word ABABAO", "got 0"}));
  const auto thirds = made<family<placement::end>>(3);
  BOOST_TEST(refused(thirds, symmetric(), {"got 3", "noise_parts = 2"}));
  BOOST_TEST(!refused(thirds, family<placement::middle>(), {}));
  BOOST_TEST(refused(made<family<placement::end>>(1), symmetric(), {"got 1", "noise_parts = 2"}));
  BOOST_TEST(refused(made<symmetric>(2), nystrom(), {"must have a letter O"}));
}

BOOST_AUTO_TEST_CASE(without_sigma_no_noise_is_needed) {
  for (const double friction : {0.0, 0.7}) {
    const galaxy quiet(henon_heiles(), bath::of_sigma(friction, 0.0));
    auto data = made_by_steps(quiet, starts, member<symmetric>(maker), {.step = h});
    const metric measure(quiet, data, coordinates::qp);
    const auto loss = [&] { return loss_value(one_step<symmetric>(quiet, data, measure), maker); };
    BOOST_TEST(loss() <= 1e-24);
    data.noise_parts = 0;
    data.noise.clear();
    BOOST_TEST(loss() <= 1e-24);
    data.finish[0].p[0] += 1e-3;
    BOOST_TEST(loss() > 1e-9);
  }
}
