// SPDX-License-Identifier: BSL-1.0
// What a problem has of its own: of its letters unsound ones are refused each time, and sound ones taken at
// any offset and step; observables of a black box with memory are asked from several threads.
#include <atomic>

#include "../../src/comparison/catalogue.hpp"
#include "../../src/comparison/observables.hpp"
#include "../../src/comparison/prepared_problem.hpp"
#include "../../src/comparison/refusal.hpp"
#include "../support/systems.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"
#include "nysalt/plugin.hpp"

using namespace nysalt;
using namespace nysalt::program;

namespace {

struct own_drift : exact_flow<'d'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.q[i] += x.p[i] * t;
  }
};
struct own_kick : exact_flow<'f'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    force<typename State::scalar_type>(system, x.q, room.x);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += room.x[i] * t;
  }
};
struct slow_drift : own_drift {
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    own_drift::apply(system, C(t * 0.9), x, room);
  }
};

/// A spring about a place that may be far away, or none.
struct distant_spring {
  static constexpr int dimension = 1;
  double place = 0.0;
  double stiffness = 1.0;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    const T r = q[0] - place;
    return r * r * (0.5 * stiffness);
  }
};

template <class Drift>
prepared_problem problem_of(const distant_spring& system) {
  const auto declared = detail::declare_system<distant_spring>(
      "distant_spring", "a spring", parameter("place", &distant_spring::place, "of rest"),
      parameter("stiffness", &distant_spring::stiffness, "of the spring"), letters<Drift, own_kick>(),
      starts([](const distant_spring& s) {
        return normal_around<1>({vector<double, 1>(s.place), vector<double, 1>(0.0)}, 0.1, 0.1);
      }));
  parameter_values values;
  values.add("place", system.place);
  values.add("stiffness", system.stiffness);
  return {declared.make(values, bath::of_sigma(0.0, 0.0), 1.0), {}, {bath::of_sigma(0.0, 0.0), start::law}};
}

/// What is said against the word dfd; nothing if it is taken.
std::string objection(const prepared_problem& problem, double step = 0.1) {
  try {
    problem.require_sound_letters("mine", method_of_word("word:dfd", problem.letters()).letters(), step);
  } catch (const refusal& problem_of_letters) {
    return problem_of_letters.what();
  }
  return {};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_word_that_was_refused_is_refused_again) {
  const auto unsound = problem_of<slow_drift>({});
  const auto sound = problem_of<own_drift>({});
  for (int n = 0; n < 2; ++n) {
    BOOST_TEST(objection(unsound).find("must add up to H") != std::string::npos);
    BOOST_TEST(objection(sound) == "");
  }
}

// Rounding of q over a difference of times 1e-5 h is larger than a share of its rate there.
BOOST_AUTO_TEST_CASE(sound_letters_are_taken_far_from_0_and_at_short_steps) {
  for (const double place : {0.0, 1e3, 1e6}) {
    for (const double step : {1e-6, 1e-3, 0.1}) {
      BOOST_TEST_CONTEXT("at " << place << ", step " << step)
      BOOST_TEST(objection(problem_of<own_drift>({place, 1.0}), step) == "");
    }
  }
  // Where rounding leaves something to see, a part that is a tenth short is still seen.
  for (const double place : {0.0, 1e3}) {
    BOOST_TEST(objection(problem_of<slow_drift>({place, 1.0})).find("must add up to H") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(free_motion_has_letters_too) {
  BOOST_TEST(objection(problem_of<own_drift>({0.0, 0.0})) == "");
  const std::string why = objection(problem_of<slow_drift>({0.0, 0.0}));
  BOOST_TEST(why.find("must add up to H") != std::string::npos, why);
  BOOST_TEST(why.find("nan") == std::string::npos, why);
}

BOOST_AUTO_TEST_CASE(one_thread_at_a_time_evaluates_an_observable_of_a_black_box) {
  using black_box = test::with_memory<struct observables>;
  const model system{black_box()};
  const phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Zero(1)};
  const auto potential =
      of_system(system, [](const model& of, const auto& at) { return of.potential(at.q); });
  const auto energy_of_system = of_system(
      system,
      []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& at) { return energy<T>(of, at); });
  const auto on_threads = [](const auto& value) {
    detail::for_each_block(64, 1, {.threads = 4}, [&](std::int64_t, int) {
      for (int n = 0; n < 1000; ++n) value();
    });
  };
  std::atomic<int> wrong = 0;
  on_threads([&] { wrong += potential(x) != 2.0 || energy_of_system(x) != 2.0; });
  BOOST_TEST(wrong == 0);
  BOOST_TEST(black_box::meetings == 0);
  // The test can fail: one object that several threads use.
  const black_box one;
  on_threads([&] { one.potential(vector<double, 1>(2.0)); });
  BOOST_TEST(black_box::meetings > 0);
}
