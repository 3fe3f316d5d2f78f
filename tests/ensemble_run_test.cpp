// SPDX-License-Identifier: BSL-1.0
// Trajectories that are saved and resumed go on as if nothing had happened, in whatever lanes and
// threads.
#include "nysalt/ensemble_run.hpp"

#include <boost/test/unit_test.hpp>

#include <atomic>
#include <cstdint>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/classical_methods.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/refusal.hpp"
#include "support/with_memory.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t count = 21;
constexpr std::int64_t steps = 300;
constexpr std::int64_t every = 7;

using samples = std::map<std::pair<std::int64_t, std::int64_t>, double>;  // by trajectory and step
using losses = std::vector<std::optional<std::int64_t>>;

struct followed {
  samples seen;
  losses diverged_at;
};
bool operator==(const followed& a, const followed& b) {
  return a.seen == b.seen && a.diverged_at == b.diverged_at;
}

template <class T>
const auto read_q1 = [](const auto& x, std::span<T> numbers) { numbers[0] = x.q[0]; };

/// What a table of samples would hold; filled from several threads.
auto keep_in(std::vector<samples>& of_each) {
  return [&of_each](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
    of_each[static_cast<std::size_t>(m)][{m, n}] = numbers[0];
  };
}
samples joined(const std::vector<samples>& of_each) {
  samples all;
  for (const auto& one : of_each) all.insert(one.begin(), one.end());
  return all;
}

template <class T>
followed uncut(const auto& stepper, const auto& ensemble) {
  std::vector<samples> seen(count);
  const ensemble_options options{.trajectories = count, .steps = steps, .every = every, .seed = 3};
  auto lost = integrate_ensemble<T>(stepper, ensemble, options, 1, read_q1<T>, keep_in(seen));
  return {joined(seen), lost};
}

/// Saved after each of the cuts, and resumed in lanes of T and U in turn, by another number of threads.
template <class T, class U, class Stepper>
followed cut(const Stepper& stepper, const auto& ensemble, const std::vector<std::int64_t>& cuts) {
  std::vector<samples> seen(count);
  saved_runs saved;
  const auto go_on = [&]<class P>(std::int64_t end, int threads) {
    using run = ensemble_run<P, Stepper>;
    auto current_run =
        saved.step == 0 ? run(stepper, ensemble, 3, 0, count) : run(stepper, ensemble, 3, 0, count, saved);
    current_run.go_on(end, every, 1, read_q1<P>, keep_in(seen), threads);
    saved = current_run.save();
  };
  bool odd = false;
  for (const std::int64_t end : cuts) {
    odd = !odd;
    odd ? go_on.template operator()<T>(end, 1) : go_on.template operator()<U>(end, 2);
  }
  return {joined(seen), saved.diverged_at};
}

}  // namespace

BOOST_AUTO_TEST_CASE(noise_and_all_goes_on_to_the_bit) {
  const fpu_chain<3> chain(50.0);
  const in_bath system(chain, bath::of_sigma(0.01, 0.05));
  const auto stepper = make_stepper(system, baoab{}, 0.01, counter_noise(5));
  const fpu_law<3> starts(chain);
  const auto whole = uncut<pack<double, 8>>(stepper, starts);
  BOOST_TEST(whole.seen.size() == count * (steps / every + 1));
  BOOST_TEST((cut<pack<double, 8>, pack<double, 8>>(stepper, starts, {128, steps}) == whole));
  BOOST_TEST((cut<pack<double, 8>, double>(stepper, starts, {64, 192, 256, steps}) == whole));
  // The noise of other trajectories is other noise: the equality above is not that of constants.
  const auto others = make_stepper(system, baoab{}, 0.01, counter_noise(6));
  BOOST_TEST(!(cut<pack<double, 8>, double>(others, starts, {64, steps}) == whole));
}

BOOST_AUTO_TEST_CASE(who_diverged_stays_lost_and_the_others_go_on) {
  const henon_heiles system;
  const auto stepper = make_stepper(system, verlet{}, 0.2);
  const vector<double, 2> rest(0.0, 0.0);
  const normal_around<2> wide({rest, rest}, 0.35, 0.35);  // some start beyond the saddle
  const auto whole = uncut<pack<double, 4>>(stepper, wide);
  const auto lost = std::ranges::count_if(whole.diverged_at, [](const auto& at) { return at.has_value(); });
  BOOST_TEST(lost > 2);
  BOOST_TEST(lost < count - 2);
  BOOST_TEST((cut<pack<double, 4>, double>(stepper, wide, {64, 128, steps}) == whole));
  BOOST_TEST((cut<double, pack<double, 16>>(stepper, wide, {64, 64, steps}) == whole));
}

BOOST_AUTO_TEST_CASE(of_other_trajectories_it_is_refused) {
  const henon_heiles system;
  const auto stepper = make_stepper(system, verlet{}, 0.1);
  const vector<double, 2> rest(0.0, 0.0);
  const normal_around<2> starts({rest, rest}, 0.1, 0.1);
  using run = ensemble_run<double, std::remove_const_t<decltype(stepper)>>;
  const saved_runs saved = run(stepper, starts, 1, 0, 5).save();
  BOOST_TEST(saved.numbers.size() == 5U * 3U * 2U);
  BOOST_TEST(
      refuses<std::invalid_argument>([&] { run(stepper, starts, 1, 0, 6, saved); },
                                     {"must hold 36 numbers of 6 trajectories", "got 30 numbers of 5"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { run(stepper, starts, 1, 0, 0); },
                                            {"trajectories must be >= 1", "trajectories 0"}));
}

namespace {

using black_box_with_memory = with_memory<struct ensemble_runs>;
static_assert(BlackBoxForce<black_box_with_memory>);

}  // namespace

BOOST_AUTO_TEST_CASE(each_block_of_a_black_box_has_a_copy_of_the_system) {
  const model system{black_box_with_memory()};
  const auto stepper = make_stepper(system, classical_methods().front(), 0.1);
  const vector<double, Eigen::Dynamic> rest = vector<double, Eigen::Dynamic>::Zero(1);
  const normal_around<Eigen::Dynamic> starts({rest, rest}, 0.1, 0.1);
  ensemble_run<double, std::remove_const_t<decltype(stepper)>> run(stepper, starts, 1, 0, 64, 4);
  run.go_on(
      2000, 2000, 1, read_q1<double>, [](auto&&...) {}, 4);
  BOOST_TEST(black_box_with_memory::meetings == 0);
  // The test can fail: one object that several threads use.
  const black_box_with_memory one;
  for_each_block(64, 1, 4, [&](std::int64_t, int) {
    vector<double, 1> q(0.1);
    vector<double, 1> f(0.0);
    for (int i = 0; i < 2000; ++i) one.force(q, f);
  });
  BOOST_TEST(black_box_with_memory::meetings > 0);
}
