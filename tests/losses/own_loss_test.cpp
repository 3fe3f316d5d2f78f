// SPDX-License-Identifier: BSL-1.0
// A loss of one's own function: the library's losses come out of it to the bit, over double and in lanes.
#include "nysalt/losses/own_loss.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/losses.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/detail/tree_sum.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/energy_error.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/state_error.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

const henon_heiles galaxy;
const Eigen::VectorXd elsewhere = Eigen::Vector2d(0.45, 0.38);

template <class S>
flow_map_data data_of(const S& system) {
  const vector<double, S::dimension> zero = Eigen::VectorXd::Zero(size(system));
  const normal_around<S::dimension> starts({zero, zero}, 0.1, 0.2);
  // Of the second trajectory five steps are one more, and lanes are left over: there are 54 windows of
  // five.
  auto data = make_flow_map_data(system, starts, fine_steps<>(0.05),
                                 {.step = 0.4, .horizon = 13.2, .trajectories = 2});
  data.first_of = {0, 33, 61, 66};
  return data;
}

/// Of five steps.
template <Scalar R>
squares squares_of(const model& system, const flow_map_data& data, const window_error<R>& error,
                   int threads = 1) {
  const after_steps<R> loss(run_time_family(nystrom()), system, data, error,
                            {.steps = {5}, .threads = threads});
  return squares_at(loss, elsewhere);
}

/// Weights of q and p, as a metric has them.
Eigen::VectorXd weights_of(const metric& measure, Eigen::Index size) {
  const phase_point<double, Eigen::Dynamic> ones{Eigen::VectorXd::Ones(size), Eigen::VectorXd::Ones(size)};
  const phase_point<double, Eigen::Dynamic> zero{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  Eigen::VectorXd weights(2 * size);
  measure.residual(ones.q, ones.p, zero, weights.data());
  return weights;
}

/// The state's error, formula by formula.
auto own_state_error(const Eigen::VectorXd& weights) {
  return [weights]<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                            const phase_point<T, 2>& wanted) -> vector<T, 4> {
    return vector<T, 4>((finish.q[0] - wanted.q[0]) * weights[0], (finish.q[1] - wanted.q[1]) * weights[1],
                        (finish.p[0] - wanted.p[0]) * weights[2], (finish.p[1] - wanted.p[1]) * weights[3]);
  };
}

/// That of the energy.
auto own_energy_error(const flow_map_data& data) {
  std::vector<double> squares(3, 0.0);
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      const auto& p = data.start[n].p;
      const double kinetic = (p[0] * p[0] + p[1] * p[1]) * 0.5;
      squares[m] += kinetic * kinetic;
    }
  }
  const double scale = 1.0 / std::sqrt(tree_sum(squares) / 66.0);
  return [scale]<class T>(const phase_point<T, 2>& start, const phase_point<T, 2>& finish,
                          const phase_point<T, 2>&) -> T {
    return (energy<T>(galaxy, finish) - energy<T>(galaxy, start)) * scale;
  };
}

/// Nonlinear, of all three states, two residuals.
constexpr auto bent = []<class T>(const phase_point<T, 2>& start, const phase_point<T, 2>& finish,
                                  const phase_point<T, 2>& wanted) -> std::array<T, 2> {
  using std::sin;
  using std::sqrt;
  return {sin(finish.q[0] * finish.p[1]) - sin(wanted.q[0] * wanted.p[1]),
          sqrt(1.0 + finish.q[1] * finish.q[1]) - sqrt(1.0 + wanted.q[1] * wanted.q[1]) +
              (finish.p[0] - wanted.p[0]) * start.q[0]};
};

template <Scalar R>
void check_the_librarys() {
  const auto data = data_of(galaxy);
  const metric measure(galaxy, data, coordinates::qp);
  const auto state = squares_of<R>(galaxy, data, state_error<R>(measure));
  const auto weights = weights_of(measure, 2);
  const auto of_own = [&](const auto& error) {
    return squares_of<R>(galaxy, data, own_error<R>(galaxy, error));
  };
  BOOST_TEST_CONTEXT(lanes_in<R> << " lanes") {
    BOOST_TEST(same(of_own(own_state_error(weights)), state));
    BOOST_TEST(!same(of_own(own_state_error(weights * (1.0 + 1e-15))), state));
    const auto energy = squares_of<R>(galaxy, data, energy_error<R>(galaxy, data));
    BOOST_TEST(same(of_own(own_energy_error(data)), energy));
    BOOST_TEST(energy.value > 1e-12);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_librarys_losses_come_out_to_the_bit) {
  check_the_librarys<double>();
  check_the_librarys<detail::lanes>();
}

BOOST_AUTO_TEST_CASE(any_number_of_residuals_is_told_by_what_is_returned) {
  // As many as there are masses, which no type knows.
  const auto chain = linear_chain::between_walls(3, 1.0, 2.0);
  const auto data = data_of(chain);
  const metric measure(chain, data, coordinates::qp);
  const auto weights = weights_of(measure, 3);
  const auto error = [&]<class T>(const phase_point<T, Eigen::Dynamic>&,
                                  const phase_point<T, Eigen::Dynamic>& finish,
                                  const phase_point<T, Eigen::Dynamic>& wanted) {
    vector<T, Eigen::Dynamic> r(6);
    for (Eigen::Index i = 0; i < 3; ++i) {
      r[i] = (finish.q[i] - wanted.q[i]) * weights[i];
      r[3 + i] = (finish.p[i] - wanted.p[i]) * weights[3 + i];
    }
    return r;
  };
  using R = detail::lanes;
  const auto own = own_error<R>(chain, error);
  BOOST_TEST(own.residuals == 6U);
  BOOST_TEST(own.weight_deviations == nullptr);
  BOOST_TEST(same(squares_of<R>(chain, data, own), squares_of<R>(chain, data, state_error<R>(measure))));
  BOOST_TEST(own_error(galaxy, bent).residuals == 2U);
  BOOST_TEST(own_error(galaxy, own_energy_error(data_of(galaxy))).residuals == 1U);
}

BOOST_AUTO_TEST_CASE(the_gradient_is_the_slope_of_the_loss) {
  const auto data = data_of(galaxy);
  const after_steps<> loss(run_time_family(aba<4>()), galaxy, data, own_error(galaxy, bent), {.steps = {5}});
  Eigen::VectorXd theta = column_of(aba<4>::start());
  for (Eigen::Index k = 0; k < 3; ++k) theta[k] += 0.01 * static_cast<double>(k + 1);
  const Eigen::VectorXd ours = squares_at(loss, theta).gradient();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const central_difference difference([&](const auto& x) { return loss_value(loss, x); }, theta, k);
    // A residual is the difference of numbers below 2 after some hundred roundings.
    const double s = 1e-4;
    const double error = difference.truncation(s);
    const double rounding = 2.0 * 100.0 * eps * 2.0 * std::sqrt(loss_value(loss, theta)) / s;
    BOOST_TEST_CONTEXT("parameter " << k) {
      BOOST_TEST(std::abs(ours[k] - difference(s)) <= 2.0 * error + rounding);
      BOOST_TEST(std::abs(ours[k] - difference(s)) <= 1e-4 * ours.norm());  // which says something
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_not_a_number_is_none_of_the_loss_either) {
  const auto data = data_of(galaxy);
  const auto error = []<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                                 const phase_point<T, 2>&) -> T {
    using std::sqrt;
    return sqrt(finish.q[0] - 100.0);  // which no window has
  };
  BOOST_TEST(!squares_of(galaxy, data, own_error(galaxy, error)).is_finite());
  BOOST_TEST(squares_of(galaxy, data, own_error(galaxy, bent)).is_finite());
}

BOOST_AUTO_TEST_CASE(residuals_that_change_in_number_are_refused) {
  const auto data = data_of(galaxy);
  const auto of_so_many = [&](Eigen::Index at_zero, Eigen::Index elsewhere, int threads) {
    return [=, &data] {
      const auto error = [=]<class T>(const phase_point<T, 2>& start, const phase_point<T, 2>&,
                                      const phase_point<T, 2>&) {
        const bool is_zero = !any(start.q[0].value != 0.0);
        vector<T, Eigen::Dynamic> r(is_zero ? at_zero : elsewhere);
        r.fill(T(1.0));
        return r;
      };
      squares_of(galaxy, data, own_error(galaxy, error), threads);
    };
  };
  for (const int threads : {1, 2}) {
    BOOST_TEST(
        refuses<wrong>(of_so_many(2, 3, threads), {"the same for every pair of states", "got 2 and 3"}));
    BOOST_TEST(!refuses<wrong>(of_so_many(3, 3, threads), {}));
    BOOST_TEST(refuses<wrong>(of_so_many(0, 0, threads), {"residuals must be one or more"}));
  }
}
