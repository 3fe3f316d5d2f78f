// SPDX-License-Identifier: BSL-1.0
// Observables of a black box, whose force and potential may have memory, from several threads.
#include "comparison/observables.hpp"

#include <boost/test/unit_test.hpp>

#include <atomic>

#include "../support/with_memory.hpp"
#include "nysalt/detail/ensemble_loop.hpp"

using namespace nysalt;

namespace {

using black_box_with_memory = test::with_memory<struct observables>;
static_assert(BlackBoxForce<black_box_with_memory>);

/// value() on 4 threads, many times.
void call_on_threads(const auto& value) {
  for_each_block(64, 1, 4, [&](std::int64_t, int) {
    for (int n = 0; n < 1000; ++n) value();
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_thread_at_a_time_evaluates_an_observable_of_a_black_box) {
  const model system{black_box_with_memory()};
  const phase_point<double, Eigen::Dynamic> x{Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Zero(1)};
  const auto potential = program::of_system(
      system,
      []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& at) { return of.potential(at.q); });
  const auto energy_of_system = program::of_system(
      system,
      []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& at) { return energy<T>(of, at); });
  std::atomic<int> wrong = 0;
  call_on_threads([&] { wrong += potential(x) != 2.0 || energy_of_system(x) != 2.0; });
  BOOST_TEST(wrong == 0);
  BOOST_TEST(black_box_with_memory::meetings == 0);
  // The test can fail: one object that several threads use.
  const black_box_with_memory one;
  call_on_threads([&] { one.potential(vector<double, 1>(2.0)); });
  BOOST_TEST(black_box_with_memory::meetings > 0);
}
