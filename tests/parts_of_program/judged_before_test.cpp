// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: whole trials are of millions of evaluations.
// The trial before a run takes no more force evaluations than the run, or than some tenths of a second have.
#include "../../src/comparison/prepared_problem.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::program;

namespace {

/// Springs to the origin, with a force that costs what the user does not say.
struct springs {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::Index count = 1;
  Eigen::Index size() const { return count; }
  template <class T>
  T potential(const vector<T, Eigen::Dynamic>& q) const {
    T sum(0.0);
    for (const T& x : q) sum += x * x;
    return sum * 0.5;
  }
  template <class T>
  void force(const vector<T, Eigen::Dynamic>& q, vector<T, Eigen::Dynamic>& f) const {
    for (Eigen::Index i = 0; i < count; ++i) f[i] = -q[i];
  }
};
/// The same, at a cost that is stated.
struct priced_springs : springs {
  double force_cost() const { return 2.0 * static_cast<double>(count); }
};
/// The same, differentiated.
struct potential_only {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::Index count = 1;
  Eigen::Index size() const { return count; }
  template <class T>
  T potential(const vector<T, Eigen::Dynamic>& q) const {
    return springs{count}.potential(q);
  }
};
/// One spring as a black box.
struct box {
  static constexpr int dimension = Eigen::Dynamic;
  Eigen::Index size() const { return 1; }
  double potential(const Eigen::VectorXd& q) const { return 0.5 * q[0] * q[0]; }
  void force(const Eigen::VectorXd& q, Eigen::VectorXd& f) const { f = -q; }
};

template <class S>
prepared_problem problem_of(const S& system, bool is_bundled = false, double deviation_of_p = 1.0) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.size());
  return {{.system = system, .starts = normal_around<Eigen::Dynamic>({zero, zero}, 1.0, deviation_of_p)},
          {},
          {.bath = bath::of_sigma(0.0, 0.0), .start = start::law, .is_bundled = is_bundled}};
}

trajectories_plan run_of(std::int64_t count, std::int64_t steps, int threads = 1) {
  return {.step = 0.1, .steps = steps, .count = count, .seed = 1, .threads = threads};
}

std::int64_t evaluations(const judgement& found) { return found.trajectories * found.steps; }

const method method(verlet{});

}  // namespace

// Of a black box 200000 evaluations in all, and a sixteenth at least, as states go singly.
BOOST_AUTO_TEST_CASE(a_trial_takes_what_the_run_takes_within_bounds) {
  const auto dear = problem_of(box());
  const judgement& before_short = dear.judged_before(method, run_of(1, 200));
  const judgement& before_middle = dear.judged_before(method, run_of(100, 250));
  const judgement& before_long = dear.judged_before(method, run_of(1000, 1000));
  BOOST_TEST(evaluations(before_short) <= 12500);
  BOOST_TEST(evaluations(before_short) > 12500 / 2);
  BOOST_TEST(evaluations(before_middle) <= 25000);
  BOOST_TEST(evaluations(before_middle) > 12500);
  BOOST_TEST(evaluations(before_long) > 25000);
  BOOST_TEST(&before_long == &dear.judged(method, 0.1, 1));  // the whole trial, which is not done twice
  BOOST_TEST(&before_short != &before_long);
  BOOST_TEST((before_long.verdict == step_verdict::good), before_long.in_words());
  for (const judgement* one : {&before_short, &before_middle})  // a verdict is of a whole trial
    BOOST_TEST((one->verdict == step_verdict::not_tried && one->reason.empty()), one->in_words());
  const auto again = problem_of(box());
  const judgement& by_threads = again.judged_before(method, run_of(1, 200, 2));
  BOOST_TEST(by_threads.energy_error.largest == before_short.energy_error.largest);
  BOOST_TEST(by_threads.steps == before_short.steps);
}

BOOST_AUTO_TEST_CASE(a_force_whose_cost_is_known_is_tried_at_length) {
  const auto is_whole = [](const prepared_problem& problem) {
    return &problem.judged_before(method, run_of(1, 10)) == &problem.judged(method, 0.1, 1);
  };
  BOOST_TEST(is_whole(problem_of(springs{16})));
  BOOST_TEST(!is_whole(problem_of(springs{20})));
  BOOST_TEST(is_whole(problem_of(springs{20}, true)));
  BOOST_TEST(is_whole(problem_of(priced_springs{{20}})));
}

// 4e8/(4 * 600^2) = 277 evaluations in all, and 16/600 of them before a short run.
BOOST_AUTO_TEST_CASE(before_a_short_run_of_a_costly_force_nothing_is_tried_and_the_judgement_says_so) {
  const auto costly = problem_of(potential_only{600});
  const judgement& found = costly.judged_before(method, run_of(1, 20));
  BOOST_TEST((found.verdict == step_verdict::not_tried));
  BOOST_TEST(found.in_words().find("too many before so short a run") != std::string::npos, found.in_words());
}

BOOST_AUTO_TEST_CASE(a_short_trial_finds_a_step_that_is_far_too_long) {
  trajectories_plan run = run_of(1, 200);
  run.step = 2.1;  // the limit of Verlet is 2
  const std::string reason = problem_of(box()).judged_before(method, run).reason;
  BOOST_TEST(reason.find("unstable") != std::string::npos, reason);
}

// A tenth of a radian from rest kinetic energies are 1/100 of those of the motion at most, and no scale of
// errors.
BOOST_AUTO_TEST_CASE(a_short_trial_from_rest_finds_no_fault_where_there_is_none) {
  constexpr double at_rest = 1e-9;
  const std::string reason = problem_of(box(), false, at_rest).judged_before(method, run_of(1, 200)).reason;
  BOOST_TEST(reason == "");
  trajectories_plan run = run_of(1, 200);
  run.step = 2.1;
  BOOST_TEST(problem_of(box(), false, at_rest).judged_before(method, run).reason != "");
}
