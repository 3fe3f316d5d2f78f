// SPDX-License-Identifier: BSL-1.0
// A loss of one's own function: the library's losses come out of it to the bit, over double and in lanes, and
// it is learned as they are: found, judged, and given its errors.
#include "nysalt/losses/window_error.hpp"

#include "../../src/nysalt/learning/problem.hpp"
#include "../support/learned.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const henon_heiles galaxy;
const nysalt::family two_stages{nystrom()};
const Eigen::VectorXd theta = Eigen::Vector2d(0.45, 0.38);

const data_sets& two_sets() {
  static const data_sets sets(galaxy, around_rest<2>(0.1, 0.2), fine_steps(0.025),
                              {.step = 0.5, .horizon = 2.0, .trajectories = 30});
  return sets;
}

template <class S>
flow_map_data uneven_data(const S& system) {
  const auto starts = around_rest<S::dimension>(0.1, 0.2, size(system));
  // Of the second trajectory five steps are one more, and lanes are left over: there are 54 windows of
  // five.
  auto data =
      make_flow_map_data(system, starts, fine_steps(0.05), {.step = 0.4, .horizon = 13.2, .trajectories = 2});
  data.first_of = {0, 33, 61, 66};
  return data;
}

/// Of five steps.
template <Scalar R>
squares squares_of(const model& system, const flow_map_data& data, const window_error<R>& error,
                   int threads = 1) {
  const after_steps<R> loss(two_stages, system, data, error,
                            {.steps = {5}, .execution = {.threads = threads}});
  return loss.at(theta);
}

/// The state's error after three steps, with weights that a metric has estimated, or others.
auto state_after_three(const metric& measure, double of_positions = 1.0) {
  const auto error = [&measure, of_positions]<class T>(const phase_point<T, 2>&,
                                                       const phase_point<T, 2>& finish,
                                                       const phase_point<T, 2>& wanted) {
    std::array<T, 4> r;
    measure.residual(finish.q, finish.p, wanted, r.data());
    r[0] = r[0] * of_positions;
    r[1] = r[1] * of_positions;
    return r;
  };
  return own_loss{"my state", 3, error};
}

/// That of the energy, formula by formula.
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

}  // namespace

// In lanes and over double they are equal: invariance/results_test.cpp.
BOOST_AUTO_TEST_CASE(the_librarys_losses_come_out_to_the_bit) {
  using R = detail::lanes;
  const auto data = uneven_data(galaxy);
  const metric measure(galaxy, data, coordinates::qp);
  const auto state = squares_of<R>(galaxy, data, state_error<R>(measure));
  const auto of_own = [&](const auto& error) {
    return squares_of<R>(galaxy, data, detail::own_error<R>(galaxy, error));
  };
  BOOST_TEST(same(of_own(state_after_three(measure).error), state));
  BOOST_TEST(!same(of_own(state_after_three(measure, 1.0 + 1e-15).error), state));
  const auto energy = squares_of<R>(galaxy, data, energy_error<R>(galaxy, data));
  BOOST_TEST(same(of_own(own_energy_error(data)), energy));
  BOOST_TEST(energy.value > 1e-12);
}

BOOST_AUTO_TEST_CASE(any_number_of_residuals_is_told_by_what_is_returned) {
  // As many as there are masses, which no type knows.
  const auto chain = linear_chain::between_walls(3, 1.0, 2.0);
  const auto data = uneven_data(chain);
  const metric measure(chain, data, coordinates::qp);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(3);
  const phase_point<double, Eigen::Dynamic> zero{0.0 * ones, 0.0 * ones};
  std::array<double, 6> weights;
  measure.residual(ones, ones, zero, weights.data());
  const auto error = [weights]<class T>(const phase_point<T, Eigen::Dynamic>&,
                                        const phase_point<T, Eigen::Dynamic>& finish,
                                        const phase_point<T, Eigen::Dynamic>& wanted) {
    vector<T, Eigen::Dynamic> r(6);
    for (Eigen::Index i = 0; i < 3; ++i) {
      r[i] = (finish.q[i] - wanted.q[i]) * weights[std::size_t(i)];
      r[3 + i] = (finish.p[i] - wanted.p[i]) * weights[std::size_t(3 + i)];
    }
    return r;
  };
  using R = detail::lanes;
  const auto own = detail::own_error<R>(chain, error);
  BOOST_TEST(own.residuals == 6U);
  BOOST_TEST(own.weight_deviations == nullptr);
  BOOST_TEST(same(squares_of<R>(chain, data, own), squares_of<R>(chain, data, state_error<R>(measure))));
  BOOST_TEST(detail::own_error(galaxy, own_energy_error(uneven_data(galaxy))).residuals == 1U);
}

BOOST_AUTO_TEST_CASE(residuals_that_change_in_number_are_refused) {
  const auto data = uneven_data(galaxy);
  const auto of_so_many = [&](Eigen::Index at_zero, Eigen::Index elsewhere, int threads) {
    return [=, &data] {
      const auto error = [=]<class T>(const phase_point<T, 2>& start, const phase_point<T, 2>&,
                                      const phase_point<T, 2>&) {
        const bool is_zero = !any(start.q[0].value != 0.0);
        vector<T, Eigen::Dynamic> r(is_zero ? at_zero : elsewhere);
        r.fill(T(1.0));
        return r;
      };
      squares_of(galaxy, data, detail::own_error(galaxy, error), threads);
    };
  };
  for (const int threads : {1, 2}) {
    BOOST_TEST(refuses(of_so_many(2, 3, threads), {"the same for every pair of states", "got 2 and 3"}));
    BOOST_TEST(!refuses(of_so_many(3, 3, threads), {}));
    BOOST_TEST(refuses(of_so_many(0, 0, threads), {"residuals must be one or more"}));
  }
}

BOOST_AUTO_TEST_CASE(the_librarys_loss_written_as_ones_own_is_learned_to_the_bit) {
  const auto& sets = two_sets();
  const metric measure(galaxy, sets.data, coordinates::qp);
  const fit_options from_one_start{.start = two_stages.starts.front().theta};
  fit_options by_state = from_one_start;
  by_state.loss = loss_named("state:3");
  const auto usual = sets.learned(two_stages, galaxy, by_state);
  const auto learned_with = [&](const auto& loss) {
    return sets.learned(two_stages, galaxy, from_one_start, loss);
  };
  const auto own = learned_with(state_after_three(measure));
  const auto other = learned_with(state_after_three(measure, 2.0));
  BOOST_TEST_CONTEXT(usual.summary.full() << own.summary.full() << other.summary.full()) {
    BOOST_TEST((own.theta == usual.theta));
    BOOST_TEST((other.theta != usual.theta));
    BOOST_TEST(own.summary.loss == usual.summary.loss);
    BOOST_TEST(own.summary.held_out_loss == usual.summary.held_out_loss);
    BOOST_TEST(own.summary.held_out_start_loss == usual.summary.held_out_start_loss);
    BOOST_TEST(own.summary.trajectory_error == usual.summary.trajectory_error);
    BOOST_TEST(own.summary.loss_name == "my state:3");
    BOOST_TEST(own.summary.usable);
    BOOST_TEST(other.summary.usable);
    BOOST_TEST(other.summary.held_out_loss > own.summary.held_out_loss);
  }
}

BOOST_AUTO_TEST_CASE(weights_of_ones_own_have_no_error_and_the_own_loss_judges) {
  const auto& [data, held_out] = two_sets();
  const metric measure(galaxy, data, coordinates::qp);
  const auto problem_of = [&](const loss_choice& loss) {
    return learning_problem(two_stages, galaxy, data, held_out, {.loss = loss});
  };
  const auto problem = problem_of(loss_of(galaxy, state_after_three(measure)));
  const auto usual = problem_of(loss_named("state:3"));
  const after_steps<> loss(two_stages, galaxy, data, state_error(measure), {.steps = {3}});
  const auto gradients = loss.gradients(theta);
  const auto ours = problem.scores(theta);
  const auto with_weights = usual.scores(theta);
  BOOST_REQUIRE(ours.of_each.size() == gradients.size());
  int differ = 0;
  for (std::size_t m = 0; m < gradients.size(); ++m) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2);
    for (Eigen::Index k = 0; k < 4; ++k) gradient += gradients[m].col(k);
    BOOST_TEST((ours.of_each[m] == gradient));
    // The library's weights are estimates, of which each trajectory has its part.
    differ += (with_weights.of_each[m] - gradient).norm() > 0.01 * gradient.norm();
  }
  BOOST_TEST(differ > 20);  // of thirty
  // Between several minima the own loss judges.
  const auto own = problem_of(loss_of(galaxy, state_after_three(measure, 2.0)));
  BOOST_TEST(own.judge(theta) == own.over_held_out->value(theta));
  BOOST_TEST(own.judge(theta) != own.at_end_of_held_out->value(theta));
  BOOST_TEST(usual.judge(theta) == usual.at_end_of_held_out->value(theta));
  BOOST_TEST(usual.judge(theta) != usual.over_held_out->value(theta));
}

namespace {

/// 1e-3 + |theta - (.5, .4)|^2, in sixty blocks with scores of one size. Two of them may have another
/// curvature, with either sign.
class sixty_blocks final : public loss_on_data {
 public:
  explicit sixty_blocks(double curvature_of_two) : curvature_of_two_(curvature_of_two) {}

  squares at(const Eigen::VectorXd& theta) const override {
    const Eigen::Vector2d off = off_at(theta);
    return {1e-3 + off.squaredNorm(), off, Eigen::Matrix2d::Identity()};
  }
  std::vector<double> by_trajectory(const Eigen::VectorXd& theta) const override {
    return std::vector<double>(blocks, at(theta).value / blocks);
  }
  Eigen::VectorXd by_residual(const Eigen::VectorXd& theta) const override {
    return Eigen::Vector4d::Constant(at(theta).value / 4.0);  // as of two coordinates and momenta
  }
  std::vector<Eigen::MatrixXd> gradients(const Eigen::VectorXd& theta) const override {
    const Eigen::Vector2d off = off_at(theta);
    std::vector<Eigen::MatrixXd> scores;
    for (int b = 0; b < blocks; ++b) {
      const double sign = b % 2 == 0 ? 1.0 : -1.0;
      const double curvature = 2.0 / blocks + (b < 2 ? sign * curvature_of_two_ : 0.0);
      scores.emplace_back(curvature * off + sign * Eigen::Vector2d(1e-5, 1e-5));
    }
    return scores;
  }
  std::size_t residuals() const override { return 4; }
  bool has_estimated_weights() const override { return false; }
  std::unique_ptr<const loss_on_data> of_family(const nysalt::family&) const override {
    return std::make_unique<const sixty_blocks>(*this);
  }
  const shard& share() const override { return share_; }
  std::int64_t evaluations() const override { return 0; }

  inline static const Eigen::Vector2d least{0.5, 0.4};

 private:
  /// Rivals, which have no parameters, are far off.
  static Eigen::Vector2d off_at(const Eigen::VectorXd& theta) {
    if (theta.size() == 0) return Eigen::Vector2d::Ones();
    return theta - least;
  }

  static constexpr int blocks = 60;
  double curvature_of_two_;
  shard share_{blocks};
};

}  // namespace

// Of 60 trajectories with equal scores, sixty decide; but two may have ten times the curvature of all, with
// either sign, so that others like them would have another minimum.
BOOST_AUTO_TEST_CASE(errors_are_withheld_where_single_trajectories_make_the_curvature) {
  const data_sets sets(galaxy, around_rest<2>(0.1, 0.2), fine_steps(0.025),
                       {.step = 0.5, .horizon = 2.0, .trajectories = 60});
  const auto fitted = [&](double curvature_of_two) {
    learning_problem problem(two_stages, galaxy, sets.data, sets.data,
                             {.loss = loss_named("state:3"),
                              .start = sixty_blocks::least + Eigen::Vector2d(0.01, 0.01),
                              .random_starts = 0});
    problem.over_data = std::make_shared<const sixty_blocks>(curvature_of_two);
    problem.over_held_out = problem.over_data;
    problem.loss = detail::objective_of(*problem.over_data);
    problem.stages.clear();
    problem.one_step_before = {};
    problem.facts.trajectory_steps = problem.facts.loss_steps;
    return solve(problem).summary;
  };
  const auto equal = fitted(0.0);
  BOOST_TEST_CONTEXT(equal.full()) {
    BOOST_TEST(equal.errors_withheld == "");
    const double expected = 1e-5 * std::sqrt(60.0 * 60.0 / 59.0) / 2.0;
    for (const auto& one : equal.parameters) {
      BOOST_TEST(one.standard_error == expected, tolerance(1e-6));
    }
  }
  const auto of_two = fitted(20.0);
  BOOST_TEST_CONTEXT(of_two.full()) {
    BOOST_TEST(says(of_two.errors_withheld, "single trajectories make the loss's curvature"));
    BOOST_TEST(std::isnan(of_two.parameters[0].standard_error));
    BOOST_TEST(says(of_two.full(), "+- not known"));
  }
}

BOOST_AUTO_TEST_CASE(where_an_own_loss_is_not_a_number_no_search_ends) {
  const auto nowhere = []<class T>(const phase_point<T, 2>&, const phase_point<T, 2>& finish,
                                   const phase_point<T, 2>&) -> T { return finish.q[0] * std::nan(""); };
  const auto found = two_sets().learned(two_stages, galaxy, {}, own_loss{"nowhere", 3, nowhere}).summary;
  BOOST_TEST((!found.usable && !found.reason.empty()), found.full());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto& data = two_sets().data;
  const metric measure(galaxy, data, coordinates::qp);
  auto loss = state_after_three(measure);
  const auto refused = [&](const fit_options& options, said words) {
    return refuses([&] { detail::with_loss(options, loss_of(galaxy, loss)); }, words);
  };
  BOOST_TEST(!refused({}, {}));
  BOOST_TEST(refused({.loss = loss_named("energy:6")}, {"energy:6", "my state:3", "must be one"}));
  BOOST_TEST(refused({.loss = loss_named("covariance")}, {"covariance", "my state:3"}));
  for (const char* name : {"", "state", "energy", "covariance", "two\nlines"}) {
    loss.name = name;
    BOOST_TEST(refused({}, {"must be one line", name}));
  }
  loss.name = "mine";
  loss.steps = 5;
  BOOST_TEST(
      refuses([&] { learn(two_stages, galaxy, data, data, {}, loss); }, {"5 steps", "longer horizon"}));
}
