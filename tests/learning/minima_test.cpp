// SPDX-License-Identifier: BSL-1.0
// From several starts the judge takes the best minimum, and the guard has the last word; and a search writes
// nothing to the standard error stream, as Ceres would, to which a few residuals instead of very many are the
// same function. What follows from a Hessian there: flat directions, conditions and standard errors.
#include <unistd.h>
#include <Eigen/LU>
#include <cstdio>

#include "../../src/nysalt/learning/curvature.hpp"
#include "../../src/nysalt/learning/minimise.hpp"
#include "../../src/nysalt/learning/search.hpp"
#include "../support/draws.hpp"
#include "../support/losses.hpp"
#include "../support/rounding.hpp"
#include "../support/scratch.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/nystrom.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const nysalt::family family{aba<2>()};  // one parameter, from -4 to 4

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
  const double a = theta[0] < wall ? theta[0] - 2.0 : infinite;
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

const Eigen::Vector2d along = Eigen::Vector2d(2.0, 1.0) / std::sqrt(5.0);
const Eigen::Vector2d across(-along[1], along[0]);

/// Curvatures 1 and `small`, the latter along (2, 1)/sqrt 5.
Eigen::MatrixXd valley(double small) {
  return across * across.transpose() + small * along * along.transpose();
}

/// Without others.
Eigen::VectorXd standard_errors_of(const curvature& bend, const std::vector<Eigen::VectorXd>& scores) {
  return bend.spread(scores, std::vector<Eigen::VectorXd>{}).standard_errors;
}

/// Residuals r + J (theta - 0) of a linear problem.
squares of(const Eigen::MatrixXd& j, const Eigen::VectorXd& r) {
  return {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
}

/// Of (sin a + b - 1, a b - .3, e^b - 2), with parameters in other units, x = scale theta.
squares in_units(const Eigen::Vector2d& scale, const Eigen::VectorXd& theta) {
  const double a = scale[0] * theta[0];
  const double b = scale[1] * theta[1];
  const Eigen::Matrix<double, 3, 2> j{{std::cos(a), 1.0}, {b, a}, {0.0, std::exp(b)}};
  return of(j * scale.asDiagonal(), Eigen::Vector3d(std::sin(a) + b - 1.0, a * b - 0.3, std::exp(b) - 2.0));
}
Eigen::Matrix2d exact_in_units(const Eigen::Vector2d& x) {
  const double mixed = x[0] * x[1] - 0.3;
  const Eigen::Matrix2d of_second{{-std::sin(x[0]) * (std::sin(x[0]) + x[1] - 1.0), mixed},
                                  {mixed, std::exp(x[1]) * (std::exp(x[1]) - 2.0)}};
  return 2.0 * (in_units(Eigen::Vector2d::Ones(), x).normal_matrix + of_second);
}

struct small_block {
  bool accepted;
  Eigen::VectorXd r;
  Eigen::MatrixXd j;
};
small_block compress(const squares& all, bool with_jacobian = true) {
  using rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index count = all.half_gradient.size();
  const compressed_cost cost([&](const Eigen::VectorXd&) { return all; },
                             [](const Eigen::VectorXd&) { return true; }, static_cast<int>(count));
  const Eigen::VectorXd theta = Eigen::VectorXd::Zero(count);
  const double* at = theta.data();
  Eigen::VectorXd r(count + 1);
  rows j = rows::Zero(count + 1, count);
  double* slopes = j.data();
  const bool accepted = cost.Evaluate(&at, r.data(), with_jacobian ? &slopes : nullptr);
  return {accepted, r, j};
}

Eigen::MatrixXd random_matrix(draws& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd result(rows, columns);
  for (auto& x : result.reshaped()) x = random.uniform(-1.0, 1.0);
  return result;
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
  const nysalt::family two{nystrom()};  // b1 in (0, 1), beta1 in [0, .5]
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

BOOST_AUTO_TEST_CASE(parameters_in_any_units_have_the_same_hessian) {
  const Eigen::Vector2d x(0.7, 0.4);
  const Eigen::Matrix2d exact = exact_in_units(x);
  for (const auto& [first, second] : std::vector<std::array<double, 2>>{
           {1.0, 1.0}, {1e4, 1.0}, {1.0, 1e-4}, {1e4, 1e-4}, {1e10, 1e-10}, {1e-6, 1e6}}) {
    const Eigen::Vector2d scale(first, second);
    const objective loss = [&](const Eigen::VectorXd& theta) { return in_units(scale, theta); };
    const Eigen::Vector2d theta = x.cwiseQuotient(scale);
    const Eigen::Matrix2d back = scale.cwiseInverse().asDiagonal();
    const Eigen::Matrix2d found = back * hessian(loss, theta) * back;
    BOOST_TEST_CONTEXT("scales " << first << ", " << second) {
      // Steps are 1e-5 to 1e-3 of what changes the loss: s^2, and rounding, 20 eps/1e-5.
      BOOST_TEST(norm(found - exact) <= 2e-6 * norm(exact));
      if (first != 1e4 && first != 1e10) continue;
      constexpr double s = 1e-5;  // the same for all, as it must not be
      const Eigen::Vector2d ahead(theta[0] + s, theta[1]);
      const Eigen::Vector2d behind(theta[0] - s, theta[1]);
      const double absolute = (loss(ahead).gradient()[0] - loss(behind).gradient()[0]) / (2.0 * s);
      BOOST_TEST(std::abs(absolute / (scale[0] * scale[0]) - exact(0, 0)) > 1e-4 * norm(exact));
    }
  }
}

BOOST_AUTO_TEST_CASE(flat_directions_are_found_and_left_alone) {
  const curvature flat(valley(1e-9), {0, 1});
  BOOST_REQUIRE(flat.flat_directions().size() == 1);
  const Eigen::Vector2d along = flat.flat_directions()[0];
  BOOST_TEST(std::abs(along[0]) == 2.0 / std::sqrt(5.0),
             tolerance(1e-8));  // eps/1e-9 at most
  BOOST_TEST(along[0] * along[1] > 0.0);
  BOOST_TEST(flat.condition() == 1.0, tolerance(1e-12));
  BOOST_TEST(flat.is_minimum());
  BOOST_TEST(norm(flat.solve(along)) <= 1e-7);  // nothing along the valley
  const Eigen::Vector2d across(-1.0, 2.0);
  BOOST_TEST(norm(flat.solve(across) - across) <= 1e-7);
}

BOOST_AUTO_TEST_CASE(a_shallow_valley_is_not_a_flat_one) {
  const curvature shallow(valley(1e-6), {0, 1});
  BOOST_TEST(shallow.flat_directions().empty());
  BOOST_TEST(shallow.condition() == 1e6,
             tolerance(1e-8));  // eps of the larger in the smaller
  const Eigen::Vector2d along(2.0, 1.0);
  BOOST_TEST(norm(shallow.solve(along) - 1e6 * along) <= 1e-8 * 1e6);
  BOOST_TEST(!curvature(valley(-1e-3), {0, 1}).is_minimum());  // a saddle
  BOOST_TEST(curvature(valley(-1e-12), {0, 1}).is_minimum());  // zero, to the Hessian's error
}

BOOST_AUTO_TEST_CASE(only_free_parameters_count) {
  const curvature one(valley(1e-9), {1});
  BOOST_TEST(one.flat_directions().empty());
  BOOST_TEST(one.condition() == 1.0);
  const Eigen::VectorXd solved = one.solve(Eigen::Vector2d(7.0, 1.0));
  BOOST_TEST(solved[0] == 0.0);
  BOOST_TEST(solved[1] == 1.0 / valley(1e-9)(1, 1), tolerance(1e-14));
  const curvature none(valley(1.0), {});
  BOOST_TEST(none.is_minimum());
  BOOST_TEST(norm(standard_errors_of(none, std::vector<Eigen::VectorXd>(3, Eigen::Vector2d::Ones()))) == 0.0);
}

BOOST_AUTO_TEST_CASE(standard_errors_are_the_sandwich) {
  const std::vector<Eigen::VectorXd> scores{Eigen::Vector2d(1.0, 0.5), Eigen::Vector2d(-2.0, 0.5),
                                            Eigen::Vector2d(1.0, -1.0)};
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto& score : scores) spread += score * score.transpose();
  const Eigen::Matrix2d bread = valley(0.1).inverse();
  const Eigen::Matrix2d sandwich = bread * spread * bread * 3.0 / 2.0;
  const auto errors = standard_errors_of(curvature(valley(0.1), {0, 1}), scores);
  // A condition of 10, squared, times some 10 roundings.
  BOOST_TEST(norm(errors.cwiseAbs2() - sandwich.diagonal()) <= 1e3 * eps * norm(sandwich));
  const double excess = curvature(valley(0.1), {0, 1}).expected_excess(scores);
  BOOST_TEST(std::abs(excess - 0.5 * (valley(0.1) * sandwich).trace()) <= 1e3 * eps * norm(sandwich));
  BOOST_TEST(std::abs(excess - 0.5 * sandwich.trace()) > 0.01 * excess);  // H matters
  const auto unknown = standard_errors_of(curvature(valley(0.1), {0, 1}), std::vector{scores[0]});
  BOOST_TEST(std::isnan(unknown[0]));
  const auto unbounded = standard_errors_of(curvature(valley(0.0), {0, 1}), scores);
  BOOST_TEST(unbounded[0] == infinite);
  BOOST_TEST(unbounded[1] == infinite);
}

BOOST_AUTO_TEST_CASE(others_count_about_their_mean_as_one_among_the_blocks) {
  const curvature bend(Eigen::MatrixXd::Identity(1, 1), {0});
  const std::vector<Eigen::VectorXd> few{number(0.1), number(-0.1)};
  // Four, each of weight 1/4 in their own loss: among two, 1/2. With that they are 2.4 and .4 twice each.
  const std::vector<Eigen::VectorXd> others{number(1.2), number(1.2), number(0.2), number(0.2)};
  const auto found = bend.spread(few, others);
  const double squares = 2.0 * 0.01 + 4.0 * 1.0;  // about 1.4
  BOOST_TEST(found.standard_errors[0] == std::sqrt(squares * 2.0 / (1.0 + 3.0)), tolerance(1e-14));
  BOOST_TEST(found.deciding[0] == squares * squares / (2.0 * 1e-4 + 4.0), tolerance(1e-14));
  const auto alone = bend.spread(few, std::vector<Eigen::VectorXd>{});
  BOOST_TEST(alone.standard_errors[0] == std::sqrt(0.02 * 2.0), tolerance(1e-14));
  BOOST_TEST(alone.deciding[0] == 2.0, tolerance(1e-14));
  BOOST_TEST(bend.spread(few, std::vector{number(5.0)}).standard_errors[0] == alone.standard_errors[0]);
}

// C is infinite along the valley and H zero: what is across it counts alone.
BOOST_AUTO_TEST_CASE(the_expected_excess_is_finite_on_a_flat_direction) {
  const std::vector<Eigen::VectorXd> scores{0.3 * across + along, -0.1 * across, -0.2 * across - along};
  const double expected = 0.5 * 1.5 * (0.09 + 0.01 + 0.04);  // over the curvature 1, and B/(B - 1) = 3/2
  BOOST_TEST(curvature(valley(0.0), {0, 1}).expected_excess(scores) == expected, tolerance(1e-12));
  BOOST_TEST(std::isnan(curvature(valley(0.0), {0, 1}).expected_excess(std::vector{scores[0]})));
  BOOST_TEST(curvature(valley(0.0), {}).expected_excess(scores) == 0.0);
}

BOOST_AUTO_TEST_CASE(where_one_trajectory_outweighs_the_rest_it_alone_decides) {
  const curvature bend(valley(0.1), {0, 1});
  std::vector<Eigen::VectorXd> scores(20, Eigen::Vector2d(1.0, 0.5));
  BOOST_TEST(bend.deciding_blocks(scores) == 20.0, tolerance(1e-12));
  scores[7] *= 100.0;  // 10^4 in its square
  BOOST_TEST(bend.deciding_blocks(scores) == 10019.0 * 10019.0 / 100'000'019.0, tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(a_small_block_has_loss_gradient_and_normal_matrix_of_the_large_one) {
  draws random;
  for (Eigen::Index count = 1; count <= 4; ++count) {
    const Eigen::MatrixXd j = random_matrix(random, 50, count);
    const Eigen::VectorXd r = random_matrix(random, 50, 1);
    const auto all = of(j, r);
    const auto block = compress(all);
    BOOST_TEST_CONTEXT(count << " parameters") {
      BOOST_TEST(block.accepted);
      BOOST_TEST(block.r.size() == count + 1);
      // 50 terms, and a dozen operations on each eigenvector.
      const double rounding = 100.0 * eps;
      BOOST_TEST(std::abs(block.r.squaredNorm() - all.value) <= rounding * all.value);
      BOOST_TEST(norm(block.j.transpose() * block.r - all.half_gradient) <= rounding * norm(j.transpose()));
      BOOST_TEST(norm(block.j.transpose() * block.j - all.normal_matrix) <=
                 rounding * norm(all.normal_matrix));
      const auto value_only = compress(all, false);
      BOOST_TEST(std::abs(value_only.r.squaredNorm() - all.value) <= rounding * all.value);
    }
  }
}

BOOST_AUTO_TEST_CASE(directions_in_which_nothing_changes_are_left_out) {
  draws random;
  Eigen::MatrixXd j = random_matrix(random, 50, 3);
  j.col(2) = 2.0 * j.col(0);  // along (2, 0, -1) nothing changes
  const Eigen::VectorXd r = random_matrix(random, 50, 1);
  const auto all = of(j, r);
  const auto block = compress(all);
  BOOST_TEST(block.j.allFinite());
  BOOST_TEST((block.j * Eigen::Vector3d(2.0, 0.0, -1.0)).norm() <= 100.0 * eps * norm(j));
  BOOST_TEST((block.j.rowwise().squaredNorm().array() == 0.0).count() == 2);  // that, and the rest of r
  BOOST_TEST(std::abs(block.r.squaredNorm() - all.value) <= 100.0 * eps * all.value);
  j(0, 2) += 1e-4;  // a shallow direction is none: 1e-8 of the largest eigenvalue
  BOOST_TEST((compress(of(j, r)).j.rowwise().squaredNorm().array() == 0.0).count() == 1);
}

BOOST_AUTO_TEST_CASE(where_the_jacobian_explains_all_the_rest_is_zero_and_no_nan) {
  draws random;
  const Eigen::MatrixXd j = random_matrix(random, 50, 2);
  for (int n = 0; n < 100; ++n) {
    const auto all = of(j, j * random_matrix(random, 2, 1));
    const auto block = compress(all);
    BOOST_TEST(block.r.allFinite());
    BOOST_TEST(block.r[2] * block.r[2] <= 100.0 * eps * all.value);
  }
  const auto nothing = compress({0.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()});
  BOOST_TEST(nothing.accepted);
  BOOST_TEST(nothing.r.norm() == 0.0);
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_or_not_defined_is_rejected) {
  BOOST_TEST(!compress({not_a_number, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Zero()}).accepted);
  BOOST_TEST(!compress({1.0, Eigen::Vector2d(not_a_number, 0.0), Eigen::Matrix2d::Zero()}).accepted);
  BOOST_TEST(!compress({1.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Constant(not_a_number)}).accepted);
  int calls = 0;
  const auto counting = [&](const Eigen::VectorXd&) {
    ++calls;
    return squares{1.0, Eigen::Vector2d::Zero(), Eigen::Matrix2d::Identity()};
  };
  const compressed_cost cost(
      counting, [](const Eigen::VectorXd& theta) { return theta[0] > 0.0; }, 2);
  std::array<double, 2> theta{-1.0, 0.0};
  std::array<double, 3> r{};
  const double* at = theta.data();
  BOOST_TEST(!cost.Evaluate(&at, r.data(), nullptr));
  BOOST_TEST(calls == 0);
  theta[0] = 1.0;
  std::array<double, 6> j{};
  double* slopes = j.data();
  BOOST_TEST(cost.Evaluate(&at, r.data(), nullptr));
  BOOST_TEST(cost.Evaluate(&at, r.data(), &slopes));  // the same place costs no second pass
  BOOST_TEST(calls == 1);
}
