// SPDX-License-Identifier: BSL-1.0
// From several starts the judge takes the best minimum, and the guard has the last word; and a search writes
// nothing to the standard error stream, as Ceres would.
#include "nysalt/learning/search.hpp"

#include <unistd.h>

#include <cstdio>

#include "../support/rounding.hpp"
#include "../support/scratch.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learning/minimise.hpp"
#include "nysalt/noises/counter_based.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const run_time_family family{aba<2>()};  // one parameter, from -4 to 4

Eigen::VectorXd number(double x) { return Eigen::VectorXd::Constant(1, x); }

/// Two minima: residuals x^2 - 1 and (x - 1)/10. At 1 the loss is zero; near -1 it is some .04.
squares two_wells(const Eigen::VectorXd& theta) {
  const double x = theta[0];
  const double r = x * x - 1.0;
  const double tilt = 0.1 * (x - 1.0);
  return {r * r + tilt * tilt, number(2.0 * x * r + 0.1 * tilt),
          Eigen::MatrixXd::Constant(1, 1, 4.0 * x * x + 0.01)};
}

/// The left minimum: where 2 x (x^2 - 1) + (x - 1)/100 = 0, by Newton's method.
double left_minimum() {
  double x = -1.0;
  for (int n = 0; n < 20; ++n) x -= (2.0 * x * (x * x - 1.0) + 0.01 * (x - 1.0)) / (6.0 * x * x - 1.99);
  return x;
}

using judge = std::function<double(const Eigen::VectorXd&)>;
using guard = std::function<bool(const Eigen::VectorXd&)>;

bool all(const Eigen::VectorXd&) { return true; }
double likes_left(const Eigen::VectorXd& theta) { return std::abs(theta[0] + 1.0); }
double likes_right(const Eigen::VectorXd& theta) { return std::abs(theta[0] - 1.0); }
double of_loss(const Eigen::VectorXd& theta) { return two_wells(theta).value; }

std::vector<named_parameters> named(const std::vector<double>& starts) {
  std::vector<named_parameters> result;
  for (const double x : starts) result.push_back({x < 0.0 ? "left" : "right", number(x)});
  return result;
}

search_task task_of(const judge& judges, const guard& admits = all) {
  return {.family = &family,
          .loss = two_wells,
          .judge = judges,
          .admits = admits,
          .free = {0},
          .max_iterations = 100};
}
search_result searched(const judge& judges, const guard& admits, const std::vector<double>& starts,
                       int max_iterations = 100) {
  search_task task = task_of(judges, admits);
  task.max_iterations = max_iterations;
  return search(task, named(starts));
}

/// A loss with its minimum at x0, and what it is there.
objective least_at(double x0, double least = 0.0) {
  return [=](const Eigen::VectorXd& theta) -> squares {
    const double r = theta[0] - x0;
    return {least + r * r, number(r), Eigen::MatrixXd::Ones(1, 1)};
  };
}
const std::vector<named_parameters> mostly_left = named({-1.3, -1.2, -1.1, 1.2});

constexpr double near_rounding = 1e-12;  // Newton's method ends at rounding, in a well of curvature 8

/// What is written to the standard error stream meanwhile, by whatever library.
std::string written_by(const std::function<void()>& act) {
  const scratch folder("quiet_search");
  const std::string name = folder / "err";
  std::fflush(stderr);
  const int kept = dup(STDERR_FILENO);
  std::FILE* file = std::fopen(name.c_str(), "w");
  BOOST_REQUIRE(file != nullptr);
  dup2(fileno(file), STDERR_FILENO);
  act();
  std::fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  std::fclose(file);
  return contents(name);
}

/// r = (theta_1 - 2, theta_2^2 - 3), and beyond theta_1 = `wall` the loss overflows or the point is
/// undefined.
squares bowl(const Eigen::VectorXd& theta, double wall) {
  const double a = theta[0] < wall ? theta[0] - 2.0 : std::numeric_limits<double>::infinity();
  const double b = theta[1] * theta[1] - 3.0;
  const Eigen::Matrix2d j{{1.0, 0.0}, {0.0, 2.0 * theta[1]}};
  const Eigen::Vector2d r(a, b);
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

minimum search_from(double first, double wall, bool by_definition) {
  const objective loss = [=](const Eigen::VectorXd& theta) { return bowl(theta, wall); };
  const auto defined = [=](const Eigen::VectorXd& theta) { return !by_definition || theta[0] < wall; };
  return minimise(loss, defined, Eigen::Vector2d(first, 1.0), {0, 1}, 100);
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_judge_decides_and_not_the_loss_and_the_guard_has_the_last_word) {
  const judge equal = [](const Eigen::VectorXd&) { return 1.0; };
  const judge nan_on_the_right = [](const auto& theta) { return theta[0] > 0.0 ? std::nan("") : 1e9; };
  const guard positive = [](const Eigen::VectorXd& theta) { return theta[0] > 0.0; };
  const guard none = [](const Eigen::VectorXd&) { return false; };
  struct row {
    judge judges;
    guard admits;
    std::vector<double> starts;
    std::string best, unguarded;
  };
  for (const auto& [judges, admits, starts, best, unguarded] :
       std::vector<row>{{likes_left, all, {1.2, -1.2}, "left", ""},
                        {likes_right, all, {1.2, -1.2}, "right", ""},
                        {equal, all, {1.2, -1.2}, "right", ""},  // of equals the first
                        {equal, all, {-1.2, 1.2}, "left", ""},
                        {nan_on_the_right, all, {1.2, -1.2}, "left", ""},
                        {likes_left, positive, {-1.2, 1.2}, "right", "left"},
                        {likes_right, positive, {-1.2, 1.2}, "right", ""},  // nothing was lost
                        {likes_right, none, {1.2, -1.2}, "right", "right"}}) {
    const auto found = searched(judges, admits, starts);
    const bool is_left = best == "left";
    BOOST_TEST(found.best.from == best);
    BOOST_TEST(std::abs(found.best.theta[0] - (is_left ? left_minimum() : 1.0)) <= near_rounding);
    BOOST_TEST((is_left ? found.best.loss > 0.03 : found.best.loss <= 1e-24));
    BOOST_TEST(found.best.converged);
    BOOST_TEST(found.best.admitted == admits(found.best.theta));
    BOOST_TEST(!found.best.is_held);
    BOOST_TEST(found.tried == (unguarded == "left" ? 3 : 2));  // the search goes on at the edge
    BOOST_TEST((found.unguarded ? found.unguarded->from : "") == unguarded);
    BOOST_TEST((!found.unguarded || !found.unguarded->admitted));
  }
}

BOOST_AUTO_TEST_CASE(what_did_not_converge_is_not_judged) {
  // From 1 + 1e-7 Newton's steps alone are enough, from -3 they are not.
  const auto found = searched(likes_left, all, {-3.0, 1.0 + 1e-7}, 0);
  BOOST_TEST(found.best.from == "right");
  BOOST_TEST(found.best.converged);
  BOOST_TEST(searched(likes_left, all, {-3.0, 1.0 + 1e-7}).best.from == "left");
  BOOST_TEST(!searched(likes_left, all, {-3.0}, 0).best.converged);  // a single start is what it was
}

BOOST_AUTO_TEST_CASE(where_no_minimum_is_admitted_the_guard_holds_what_it_admits) {
  const auto beyond = [](const Eigen::VectorXd& theta) { return std::abs(theta[0]) > 1.5; };
  const auto found = searched(likes_right, beyond, {0.5, 2.0});
  BOOST_TEST(found.best.is_held);
  BOOST_TEST(found.best.admitted);
  BOOST_TEST(beyond(found.best.theta));
  BOOST_TEST(of_loss(found.best.theta) <= of_loss(number(2.0)));  // no worse than its start
  BOOST_TEST(found.tried == 3);                                   // the start .5 is not admitted
  BOOST_REQUIRE(found.unguarded.has_value());
  BOOST_TEST(std::abs(found.unguarded->theta[0] - 1.0) <= near_rounding);
}

// The right well has no loss and is not admitted; at 1.05 the loss is .011, in the left well .04.
BOOST_AUTO_TEST_CASE(an_admitted_minimum_far_above_another_is_left_for_the_edge_where_that_is_better) {
  const auto left_and_beyond = [](double edge) {
    return [edge](const Eigen::VectorXd& theta) { return theta[0] < -0.5 || theta[0] > edge; };
  };
  const auto found = searched(of_loss, left_and_beyond(1.05), {-1.2, 1.5});
  BOOST_TEST(found.best.is_held);
  BOOST_TEST(found.best.theta[0] > 1.05);
  BOOST_TEST(found.best.judged < of_loss(number(left_minimum())));
  const auto stayed = searched(of_loss, left_and_beyond(1.2), {-1.2, 1.5});  // .19 there
  BOOST_TEST(!stayed.best.is_held);
  BOOST_TEST(std::abs(stayed.best.theta[0] - left_minimum()) <= near_rounding);
  BOOST_TEST(stayed.unguarded.has_value());
  // Where the refused one is not much better, the edge is not looked at.
  const auto less_different = [&](const Eigen::VectorXd& theta) { return 0.03 + two_wells(theta).value; };
  BOOST_TEST(searched(less_different, left_and_beyond(1.05), {-1.2, 1.5}).tried == 2);
  BOOST_TEST(found.tried > 2);
}

BOOST_AUTO_TEST_CASE(random_starts_are_those_of_their_seed_and_stay_in_range) {
  const run_time_family two{nystrom()};  // b1 in (0, 1), beta1 in [0, .5]
  const Eigen::VectorXd middle = Eigen::Vector2d(0.5, 0.4);
  const auto drawn = [&](std::uint64_t which, std::uint64_t n, const std::vector<Eigen::Index>& free) {
    return random_start(two, middle, free, which, n);
  };
  BOOST_TEST((drawn(1, 0, {0, 1}) == drawn(1, 0, {0, 1})));
  BOOST_TEST((drawn(1, 0, {0, 1}) != drawn(1, 1, {0, 1})));
  BOOST_TEST((drawn(1, 0, {0, 1}) != drawn(2, 0, {0, 1})));
  BOOST_TEST(drawn(1, 0, {1})[0] == 0.5);  // what is fixed stays
  BOOST_TEST(drawn(1, 0, {1})[1] == drawn(1, 0, {0, 1})[1]);
  // Normal, of deviations that are halved three times in four starts, and projected into the range.
  int at_the_bound = 0;
  for (std::uint64_t n = 0; n < 40; ++n) {
    Eigen::Vector2d z;
    standard_normals(3, {.trajectory = n, .purpose = noise_purpose::search}, z);
    const Eigen::Vector2d moved = middle + 0.6 * std::exp2(-static_cast<double>(n % 4)) * z;
    const auto theta = drawn(3, n, {0, 1});
    BOOST_TEST(std::abs(theta[0] - std::clamp(moved[0], 1e-3, 0.999)) <= 4.0 * eps);  // an open range
    BOOST_TEST(std::abs(theta[1] - std::clamp(moved[1], 0.0, 0.5)) <= 4.0 * eps);
    at_the_bound += theta[1] == 0.5;
  }
  BOOST_TEST(at_the_bound > 5);
}

// The stage leads all starts into the left well, and the one-step loss has its minimum in the right one.
BOOST_AUTO_TEST_CASE(a_search_in_stages_begins_at_the_minimum_of_the_one_step_loss_too) {
  search_task task = task_of(of_loss);
  task.stages = {{.loss = least_at(-1.0)}};
  BOOST_TEST(std::abs(search(task, mostly_left).best.theta[0] - left_minimum()) <= near_rounding);
  task.one_step_loss = least_at(1.1);
  const auto found = search(task, mostly_left);
  BOOST_TEST(found.best.from == "one step");
  BOOST_TEST(std::abs(found.best.theta[0] - 1.0) <= near_rounding);
}

// No start comes below 1 in the stage.
BOOST_AUTO_TEST_CASE(a_search_ends_at_a_stage_whose_minima_are_all_above_what_it_bears) {
  int passes = 0;
  search_task task = task_of(of_loss);
  task.loss = [&](const Eigen::VectorXd& theta) {
    ++passes;
    return two_wells(theta);
  };
  const auto found_with = [&](double lost_above) {
    task.stages = {{.loss = least_at(-1.0, 1.0), .steps = 16, .lost_above = lost_above}};
    return search(task, mostly_left);
  };
  BOOST_TEST(found_with(0.9).lost_after == 16);
  BOOST_TEST(passes == 0);
  const auto found = found_with(1.1);
  BOOST_TEST(found.lost_after == 0);
  BOOST_TEST(passes > 0);
  task.kept = {mostly_left.back()};  // what is kept may follow the data
  BOOST_TEST(found_with(0.9).lost_after == 0);
  BOOST_TEST(std::abs(found.best.theta[0] - left_minimum()) <= near_rounding);
}

BOOST_AUTO_TEST_CASE(a_start_or_a_step_where_the_loss_is_not_finite_is_given_up_in_silence) {
  BOOST_TEST(written_by([] { std::fputs("as Ceres would", stderr); }) == "as Ceres would");
  for (const bool by_definition : {false, true}) {
    minimum found{};
    BOOST_TEST(written_by([&] { found = search_from(5.0, 4.0, by_definition); }) == "");
    BOOST_TEST(!std::isfinite(found.loss));
    BOOST_TEST(!found.converged);
    BOOST_TEST(found.theta[0] == 5.0);
    for (const double wall : {2.5, 1.5}) {  // steps beyond it are rejected
      BOOST_TEST(written_by([&] { found = search_from(-3.0, wall, by_definition); }) == "");
      BOOST_TEST(found.theta[0] < wall);
      BOOST_TEST(std::isfinite(found.loss));
    }
  }
}
