// SPDX-License-Identifier: BSL-1.0
// Threads that share trajectories: each is followed once, the first exception is the one that is thrown, a
// black box with memory is used by one thread at a time, all round alike, and no handler of signals runs
// where it must wait.
#include <cfenv>
#include <chrono>
#include <future>
#include "../support/refusal.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;
using nysalt::detail::held_signals;
using nysalt::detail::wait_for_held_signals;

BOOST_AUTO_TEST_CASE(every_trajectory_is_visited_once) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> visits(1000, 0);
    for_each_trajectory(1000, {.threads = threads},
                        [&](std::int64_t m) { ++visits[static_cast<std::size_t>(m)]; });
    BOOST_TEST(std::ranges::count(visits, 1) == 1000);
  }
  for_each_trajectory(0, {.threads = 2}, [](std::int64_t) { BOOST_ERROR("there is none"); });
  BOOST_CHECK_THROW(for_each_trajectory(1, {.threads = 0}, [](std::int64_t) {}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(blocks_cover_all_trajectories_once) {
  for (const std::int64_t count : {1, 7, 16, 100}) {
    for (const int width : {1, 3, 8, 16}) {
      std::vector<int> visits(static_cast<std::size_t>(count), 0);
      std::atomic<int> short_blocks = 0;
      std::atomic<int> off_blocks = 0;
      detail::for_each_block(count, width, {.threads = 2}, [&](std::int64_t first, int n) {
        off_blocks += first % width != 0;  // BOOST_TEST is for one thread
        short_blocks += n != width;
        for (int k = 0; k < n; ++k) ++visits[static_cast<std::size_t>(first + k)];
      });
      BOOST_TEST(off_blocks == 0);
      BOOST_TEST(std::ranges::count(visits, 1) == count);
      BOOST_TEST(short_blocks == (count % width == 0 ? 0 : 1));
    }
  }
  BOOST_CHECK_THROW(detail::for_each_block(1, 0, {.threads = 1}, [](std::int64_t, int) {}),
                    std::invalid_argument);
}

// The later one is thrown long before the earlier one can be.
BOOST_AUTO_TEST_CASE(the_first_exception_leaves_the_loop) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<bool> later = false;
    const auto body = [&](std::int64_t m) {
      if (m == 90) {
        later = true;
        throw std::runtime_error("90");
      }
      if (m != 17) return;
      const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
      while (threads > 1 && !later && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
      throw std::runtime_error("17");
    };
    BOOST_TEST(
        refuses<std::runtime_error>([&] { for_each_trajectory(100, {.threads = threads}, body); }, {"17"}));
  }
}

// In its block 21 is found in trouble before 18 is, as a later stage of the work finds it.
BOOST_AUTO_TEST_CASE(the_first_trajectory_in_trouble_is_named_by_any_number_of_lanes) {
  const auto body = [](std::int64_t first, int n) {
    for (const std::int64_t culprit : {21, 18, 70}) {
      if (first <= culprit && culprit < first + n) throw std::runtime_error(std::to_string(culprit));
    }
  };
  for (const int width : {1, 5, 16, 100}) {
    for (const int threads : {1, 3}) {
      BOOST_TEST(refuses<std::runtime_error>(
          [&] { detail::for_each_block(100, width, {.threads = threads}, body); }, {"18"}));
    }
  }
}

namespace {

using black_box_with_memory = with_memory<struct threads>;
static_assert(BlackBoxForce<black_box_with_memory>);
const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
const normal_around<Eigen::Dynamic> around_rest({zero, zero}, 1.0, 1.0);

}  // namespace

// Trial runs and error measures share the system that they were given for its energies, and step copies of
// their own; so does each block of a run.
BOOST_AUTO_TEST_CASE(a_black_box_with_memory_is_used_by_one_thread_at_a_time) {
  const model system{black_box_with_memory()};
  const nysalt::method method{verlet{}};
  phase_points starts;
  for (std::uint64_t n = 0; n < 64; ++n) starts.push_back(around_rest(1, n));
  const judgement found = judge(system, starts, method, 0.1, {.steps = 700, .execution = {.threads = 4}});
  BOOST_TEST(found.holds(), found.in_words());
  BOOST_TEST(found.energy_was_watched);
  BOOST_TEST(black_box_with_memory::meetings == 0);
  const auto errors =
      trajectory_errors(system, fine_steps(0.01), around_rest, method, energy_measure(system),
                        {.step = 0.1, .steps = 20, .trajectories = 64, .execution = {.threads = 4}});
  BOOST_TEST(errors.methods[0].error.mean > 0.0);
  BOOST_TEST(black_box_with_memory::meetings == 0);
  const auto stepper = make_stepper(system, method, 0.1);
  ensemble_run<double, std::remove_const_t<decltype(stepper)>> run(stepper, around_rest, 1, 0, 64,
                                                                   {.threads = 4});
  run.go_on(
      2000, 2000, 1, [](const auto& x, std::span<double> number) { number[0] = x.q[0]; }, [](auto&&...) {},
      {.threads = 4});
  BOOST_TEST(black_box_with_memory::meetings == 0);
  // The count can fail: one object that several threads use.
  const black_box_with_memory one;
  detail::for_each_block(64, 1, {.threads = 4}, [&](std::int64_t, int) {
    for (int i = 0; i < 2000; ++i) one.potential(vector<double, 1>(2.0));
  });
  BOOST_TEST(black_box_with_memory::meetings > 0);
}

// Forces, energies and derivatives are asked for by four threads at once.
BOOST_AUTO_TEST_CASE(all_functions_of_a_shared_black_box_have_one_lock) {
  const model system{black_box_with_memory()};
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
  const auto ask = [&](std::int64_t which) {
    Eigen::VectorXd f(1);
    Eigen::VectorXd g(1);
    if (which == 0) force<double>(system, one, f);
    if (which == 1) static_cast<void>(system.potential(one));
    if (which == 2) static_cast<void>(system.kernels<double>().energy(one, one));
    if (which == 3) directional_derivative(system, one, one, one, g);
  };
  black_box_with_memory::meetings = 0;
  detail::for_each_block(64, 1, {.threads = 4}, [&](std::int64_t m, int) {
    for (int i = 0; i < 2000; ++i) ask(m % 4);
  });
  BOOST_TEST(black_box_with_memory::meetings == 0);
}

BOOST_AUTO_TEST_CASE(work_rounds_to_nearest_and_must_leave_it_so) {
  for (const int threads : {1, 3}) {
    std::fesetround(FE_UPWARD);
    std::atomic<int> off = 0;
    detail::for_each_block(100, 8, {.threads = threads},
                           [&](std::int64_t, int) { off += std::fegetround() != FE_TONEAREST; });
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    BOOST_TEST(off == 0);
    BOOST_TEST(after == FE_UPWARD);  // the caller's
    const auto changes = [](std::int64_t first, int) {
      std::fesetround(first < 48 ? FE_TONEAREST : FE_DOWNWARD);
    };
    BOOST_TEST(refuses([&] { detail::for_each_block(100, 8, {.threads = threads}, changes); },
                       {"floating-point environment", "got rounding downward"}));
    BOOST_TEST(std::fegetround() == FE_TONEAREST);
  }
}

namespace {
volatile std::sig_atomic_t handled = 0;
extern "C" void note_signal(int) { handled = handled + 1; }
}  // namespace

// While a file is made and the name of it noted no handler runs, on no thread.
BOOST_AUTO_TEST_CASE(a_handler_runs_behind_the_scope) {
  const auto before = std::signal(SIGUSR1, &note_signal);
  std::raise(SIGUSR1);
  BOOST_TEST(handled == 1);  // not held
  {
    const held_signals held;
    std::raise(SIGUSR1);
    BOOST_TEST(handled == 1);
  }
  BOOST_TEST(handled == 2);
  std::signal(SIGUSR1, before);
}

BOOST_AUTO_TEST_CASE(a_handler_on_another_thread_waits) {
  wait_for_held_signals();  // returns at once, as no thread holds signals back
  std::promise<void> holds;
  std::atomic<bool> is_done = false;
  std::thread other([&] {
    const held_signals held;
    holds.set_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    is_done = true;
  });
  holds.get_future().wait();
  wait_for_held_signals();
  BOOST_TEST(is_done);
  other.join();
}
