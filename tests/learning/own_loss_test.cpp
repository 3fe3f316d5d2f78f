// SPDX-License-Identifier: BSL-1.0
// A loss of one's own is learned as the library's are: found, judged, and given its errors.
#include "nysalt/losses/own_loss.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/after_steps.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/state_error.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;

const henon_heiles galaxy;
const run_time_family family{nystrom()};

flow_map_data data_of(std::uint64_t seed) {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  return make_flow_map_data(galaxy, starts, fine_steps<>(0.025),
                            {.step = 0.5, .horizon = 2.0, .trajectories = 30, .seed = seed});
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

/// A loss that asks no windows, (theta_0 - .45)^2 (theta_0 - .55)^2 + (theta_1 - .4)^2: it has two minima,
/// both 0. Each trajectory has an equal part of it.
class two_minima {
 public:
  using scalar = double;

  explicit two_minima(const shard& share) : share_(share) {}

  Eigen::Index parameters() const { return 2; }
  std::size_t residuals() const { return 2; }
  const shard& share() const { return share_; }

  std::vector<Eigen::VectorXd> sums(const Eigen::VectorXd& theta, bool, Eigen::Index terms,
                                    const terms_of_window<double>& of_window) const {
    const double left = theta[0] - 0.45;
    const double right = theta[0] - 0.55;
    const residuals_of_window<double> r{2, {left * right, theta[1] - 0.4}, {left + right, 0.0, 0.0, 1.0}};
    std::vector<double> numbers(static_cast<std::size_t>(terms));
    of_window(r, numbers);
    const Eigen::VectorXd all = Eigen::Map<const Eigen::VectorXd>(numbers.data(), terms);
    return {static_cast<std::size_t>(share_.count()), all / static_cast<double>(share_.total())};
  }

 private:
  shard share_;
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_librarys_loss_written_as_ones_own_is_learned_to_the_bit) {
  const auto data = data_of(1);
  const auto held_out = data_of(2);
  const metric measure(galaxy, data, coordinates::qp);
  const fit_options from_one_start{.start = family.starts.front().theta};
  fit_options by_state = from_one_start;
  by_state.loss = loss_named("state:3");
  const auto usual = learn(family, galaxy, data, held_out, by_state);
  const auto learned_with = [&](const auto& loss) {
    return learn(family, galaxy, data, held_out, from_one_start, loss);
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

BOOST_AUTO_TEST_CASE(weights_of_ones_own_have_no_error) {
  const auto data = data_of(1);
  const metric measure(galaxy, data, coordinates::qp);
  const auto problem =
      make_learning_problem(family, galaxy, data, data_of(2), {}, state_after_three(measure));
  const auto usual = make_learning_problem(family, galaxy, data, data_of(2), {.loss = loss_named("state:3")});
  const Eigen::VectorXd theta = Eigen::Vector2d(0.45, 0.38);
  const after_steps<> loss(family, galaxy, data, state_error(measure), {.steps = {3}});
  const auto by_residual = residual_gradients(loss, theta);
  const auto ours = problem.scores(theta);
  const auto with_weights = usual.scores(theta);
  BOOST_REQUIRE(ours.of_each.size() == by_residual.size());
  int differ = 0;
  for (std::size_t m = 0; m < by_residual.size(); ++m) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2);
    for (Eigen::Index k = 0; k < 4; ++k) gradient += by_residual[m].col(k);
    BOOST_TEST((ours.of_each[m] == gradient));
    // The library's weights are estimates, of which each trajectory has its part.
    differ += (with_weights.of_each[m] - gradient).norm() > 0.01 * gradient.norm();
  }
  BOOST_TEST(differ > 20);  // of thirty
}

BOOST_AUTO_TEST_CASE(between_several_minima_the_own_loss_judges) {
  const auto data = data_of(1);
  const auto held_out = data_of(2);
  const metric measure(galaxy, data, coordinates::qp);
  const Eigen::VectorXd theta = Eigen::Vector2d(0.45, 0.38);
  const auto own = make_learning_problem(family, galaxy, data, held_out, {}, state_after_three(measure, 2.0));
  BOOST_TEST(own.judge(theta) == own.held_out.sum(own.held_out_losses(theta)));
  BOOST_TEST(own.judge(theta) != own.loss_at_end(theta));
  const auto usual = make_learning_problem(family, galaxy, data, held_out, {.loss = loss_named("state:3")});
  BOOST_TEST(usual.judge(theta) == usual.loss_at_end(theta));
  BOOST_TEST(usual.judge(theta) != usual.held_out.sum(usual.held_out_losses(theta)));
}

BOOST_AUTO_TEST_CASE(a_problem_takes_a_loss_of_another_form_and_its_judge_decides) {
  const auto data = data_of(1);
  const two_minima loss(data.share());
  const fit_options options{.start = Eigen::Vector2d(0.46, 0.41),
                            .further_starts = {{"the other", Eigen::Vector2d(0.54, 0.39)}},
                            .random_starts = 0};
  auto problem = make_learning_problem(family, galaxy, data, data_of(2), options);
  problem.loss = objective_of(loss);
  problem.stages.clear();
  problem.shorter.reset();
  problem.scores = [&](const Eigen::VectorXd& theta) {
    return trajectory_scores(trajectory_gradients(loss, theta), loss.share());
  };
  problem.held_out_losses = [&](const Eigen::VectorXd& theta) { return trajectory_losses(loss, theta); };
  problem.facts.loss_name = "two minima";
  for (const double wanted : {0.45, 0.55}) {
    problem.judge = [=](const Eigen::VectorXd& theta) { return std::abs(theta[0] - wanted); };
    const fit found = solve(problem);
    BOOST_TEST_CONTEXT(found.summary.full()) {
      BOOST_TEST(std::abs(found.theta[0] - wanted) < 0.01);  // they are .1 apart
      BOOST_TEST(std::abs(found.theta[1] - 0.4) < 0.01);
      BOOST_TEST(found.summary.from == (wanted < 0.5 ? "start" : "the other"));
      BOOST_TEST(found.summary.loss_name == "two minima");
    }
  }
}

BOOST_AUTO_TEST_CASE(where_an_own_loss_is_not_a_number_no_search_ends) {
  const auto data = data_of(1);
  const auto held_out = data_of(2);
  const metric measure(galaxy, data, coordinates::qp);
  const auto cut_off_at = [&](double bound) {
    const auto all = state_after_three(measure).error;
    const auto error = [=](const auto& start, const auto& finish, const auto& wanted) {
      using std::sqrt;
      auto r = all(start, finish, wanted);
      r[3] = r[3] + 0.0 * sqrt(bound - (finish.p[0] - wanted.p[0]) * (finish.p[0] - wanted.p[0]));
      return r;
    };
    return learn(family, galaxy, data, held_out, {}, own_loss{"cut off", 3, error}).summary;
  };
  BOOST_TEST(cut_off_at(1.0).usable);
  const auto nowhere = cut_off_at(-1.0);
  BOOST_TEST(!nowhere.usable);
  BOOST_TEST(!nowhere.reason.empty());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto data = data_of(1);
  const metric measure(galaxy, data, coordinates::qp);
  auto loss = state_after_three(measure);
  const auto refused = [&](const fit_options& options, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { make_learning_problem(family, galaxy, data, data, options, loss); }, words);
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
  BOOST_TEST(refused({}, {"5 steps", "longer horizon"}));
  loss.steps = 0;
  BOOST_TEST(refused({}, {"from 1 on", "got 0"}));
}
