// SPDX-License-Identifier: BSL-1.0
// Losses over several steps have the bits of window after window over double, whatever the number of
// parameters.
#include <boost/test/unit_test.hpp>

#include "../support/central_difference.hpp"
#include "../support/one_step.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/same_squares.hpp"
#include "../support/sample_blocks.hpp"
#include "../support/systems.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/losses/energy_error.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

struct asked {
  after_steps_options options{};
  bool of_energy = false;
};
const asked five_steps{{.steps = {5}}};
const asked apart{{.steps = {5}, .apart = 5}};
const asked several_times{{.steps = {1, 2, 5}, .apart = 3}};
const asked ten_of_energy{{.steps = {10}}, true};

const henon_heiles galaxy;

/// Trajectories of 4, 5, 0, 11, 12, 9 and 40 steps: some are too short.
flow_map_data uneven_data() {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  auto data = make_flow_map_data(galaxy, starts, fine_steps<>(0.05),
                                 {.step = 0.4, .horizon = 16.2, .trajectories = 2});
  data.first_of = {0, 4, 9, 9, 20, 32, 41, 81};
  data.start.resize(81);
  data.finish.resize(81);
  return data;
}

/// Not at the start of the family, where derivatives may vanish by symmetry.
template <Family F>
parameters_of<F> elsewhere() {
  auto theta = F::start();
  for (std::size_t k = 0; k < theta.size(); ++k) theta[k] += 0.01 * static_cast<double>(k + 1);
  return theta;
}

window_error<> error_of(const asked& what, const flow_map_data& data, const metric& measure) {
  return what.of_energy ? energy_error(galaxy, data) : state_error(measure);
}

template <Family F>
void check_bits(const asked& what, std::size_t windows) {
  const auto& options = what.options;
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  const sample_blocks<F, henon_heiles> blocks(galaxy, data, measure, options, what.of_energy);
  const Eigen::VectorXd theta = column_of(elsewhere<F>());
  const auto expected = blocks(theta);
  for (const int threads : {1, 2}) {
    auto in_threads = options;
    in_threads.threads = threads;
    const after_steps<> loss(run_time_family(F()), galaxy, data, error_of(what, data, measure), in_threads);
    BOOST_TEST_CONTEXT(F::name << " over " << options.steps.back() << " steps") {
      BOOST_TEST(blocks.windows() == windows);
      BOOST_TEST(same(squares_at(loss, theta), expected));
      BOOST_TEST(loss_value(loss, theta) == expected.value);
      BOOST_TEST(expected.half_gradient.cwiseAbs().minCoeff() > 1e-9);
      auto beside = theta;
      beside[theta.size() - 1] += 1e-15;
      BOOST_TEST(!same(squares_at(loss, beside), expected));
      // A pass for each two parameters, and one without derivatives.
      const std::int64_t passes = 2 * ((F::parameters + 1) / 2) + 1;
      using word = typename F::word;
      const std::int64_t of_run =
          word::evaluations_to_open + options.steps.back() * std::int64_t{word::evaluations_per_step};
      BOOST_TEST(loss.evaluations() == passes * of_run * static_cast<std::int64_t>(windows));
    }
  }
}

/// The loss without derivatives, formula by formula.
double energy_loss_by_hand(const flow_map_data& data, const parameters_of<nystrom>& theta) {
  const auto c = nystrom::coefficients(theta);
  const auto energy_of = [](const auto& x) {
    const double x1 = x.q[0];
    const double x2 = x.q[1];
    return 0.5 * (x.p.squaredNorm() + x.q.squaredNorm()) + x1 * x1 * x2 - x2 * x2 * x2 / 3.0;
  };
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    for (std::size_t first = data.first_of[m]; first + 10 <= data.first_of[m + 1]; ++first) {
      phase_point<double, 2> x = data.start[first];
      for (int n = 0; n < 10; ++n) {
        for (std::size_t i = 0; i < c.size(); ++i) {
          const vector<double, 2> f(-x.q[0] - 2.0 * x.q[0] * x.q[1],
                                    -x.q[1] - x.q[0] * x.q[0] + x.q[1] * x.q[1]);
          if (i % 2 == 0) x.q += x.p * (c[i] * data.step);
          if (i % 2 == 1) x.p += f * (c[i] * data.step);
        }
      }
      sum += std::pow(energy_of(x) - energy_of(data.start[first]), 2);
      count += 1.0;
    }
  }
  double kinetic = 0.0;
  for (const auto& x : data.start) kinetic += std::pow(0.5 * x.p.squaredNorm(), 2);
  return sum / count / (kinetic / static_cast<double>(data.pairs()));
}

}  // namespace

BOOST_AUTO_TEST_CASE(bits_are_those_of_window_after_window) {
  check_bits<nystrom>(five_steps, 1 + 7 + 8 + 5 + 36);
  check_bits<nystrom>(apart, 1 + 2 + 2 + 1 + 8);
  check_bits<nystrom>(several_times, 1 + 3 + 3 + 2 + 12);
  check_bits<nystrom>(ten_of_energy, 2 + 3 + 31);
}

BOOST_AUTO_TEST_CASE(any_number_of_parameters_goes_two_at_a_time) {
  check_bits<aba<2>>(five_steps, 57);  // one
  check_bits<aba<4>>({}, 81);          // three
  check_bits<aba<4>>(five_steps, 57);
  check_bits<aba<6>>(ten_of_energy, 36);  // five
}

// A run of five steps of B A B A B takes eleven evaluations, five plain ones fifteen.
BOOST_AUTO_TEST_CASE(words_that_begin_with_a_kick_take_an_evaluation_less_a_step) {
  using word = bab<2>::word;
  static_assert(word::evaluations_to_open + 5 * word::evaluations_per_step == 11);
  static_assert(5 * word::evaluations_of_plain_step == 15);
  check_bits<bab<2>>(five_steps, 57);
}

BOOST_AUTO_TEST_CASE(the_energy_loss_is_its_formula) {
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  const after_steps<> loss(run_time_family(nystrom()), galaxy, data, energy_error(galaxy, data),
                           ten_of_energy.options);
  const auto theta = elsewhere<nystrom>();
  const double expected = energy_loss_by_hand(data, theta);
  // An energy below 1 rounds in some 20 operations for each of 10 steps, over errors of some 1e-4 or more.
  BOOST_TEST(loss_value(loss, column_of(theta)) == expected,
             boost::test_tools::tolerance(2.0 * 200.0 * eps / 1e-4));
  BOOST_TEST(expected > 1e-8);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  for (const auto& what : {five_steps, several_times, ten_of_energy}) {
    const after_steps<> loss(run_time_family(aba<4>()), galaxy, data, error_of(what, data, measure),
                             what.options);
    const Eigen::VectorXd theta = column_of(elsewhere<aba<4>>());
    const Eigen::VectorXd ours = squares_at(loss, theta).gradient();
    const auto value = [&](const Eigen::VectorXd& at) { return loss_value(loss, at); };
    for (Eigen::Index k = 0; k < 3; ++k) {
      const central_difference difference(value, theta, k);
      const double s = 1e-4;
      const double error = difference.truncation(s);
      // A residual is the difference of numbers below 1, or below the increments' inverse 1/.05, after some
      // hundred roundings.
      const double rounding = 2.0 * 100.0 * eps * 20.0 * std::sqrt(loss_value(loss, theta)) / s;
      BOOST_TEST_CONTEXT(what.options.steps.back() << " steps, parameter " << k) {
        BOOST_TEST(std::abs(ours[k] - difference(s)) <= 2.0 * error + rounding);
        BOOST_TEST(std::abs(ours[k] - difference(s)) <= 1e-4 * ours.norm());  // which says something
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto data = uneven_data();
  const metric measure(galaxy, data, coordinates::qp);
  const auto made = [&](int steps) {
    return [&, steps] {
      after_steps<>(run_time_family(nystrom()), galaxy, data, state_error(measure), {.steps = {steps}});
    };
  };
  BOOST_TEST(refuses<wrong>(made(41), {"41 steps", "longer horizon"}));
  BOOST_TEST(refuses<wrong>(made(0), {"from 1 on", "got 0"}));
  BOOST_TEST(refuses<wrong>(made(-1), {"from 1 on", "got -1"}));
  const auto of_times = [&](const std::vector<int>& steps) {
    return [&, steps] {
      after_steps<>(run_time_family(nystrom()), galaxy, data, state_error(measure), {.steps = steps});
    };
  };
  BOOST_TEST(refuses<wrong>(of_times({}), {"from 1 on"}));
  BOOST_TEST(refuses<wrong>(of_times({2, 2}), {"rising", "2, 2"}));
  BOOST_TEST(refuses<wrong>(of_times({4, 3}), {"rising", "4, 3"}));
  BOOST_TEST(!refuses<wrong>(made(40), {}));
  const black_box box;
  const normal_around<1> starts({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 0.5, 0.5);
  const auto of_box = make_flow_map_data(box, starts, fine_steps<>(0.05), {.step = 0.4, .trajectories = 3});
  BOOST_TEST(refuses<wrong>([&] { energy_error(box, of_box); }, {"energy loss", "potential", "black_box"}));
}
