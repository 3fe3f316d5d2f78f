// SPDX-License-Identifier: BSL-1.0
// A model steps with the bits of its system, refuses in the same words, and tells what the type of the system
// does.
#include "../laws/models.hpp"
#include "../support/members.hpp"
#include "../support/refusal.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/phase_point.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using detail::lanes;
using detail::lanes_with_slopes;
using detail::slopes;
using start_states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// Of a fixed dimension in lanes; of a dynamic one, with masses, modes and a quadratic part; and over double
/// alone.
const fpu_chain<3> fixed_chain(10.0);
const linear_chain dynamic_chain = free_chain();
const black_box box;
const in_bath warm(fixed_chain, bath::of_temperature(0.3, 0.02));
const in_bath warm_free(dynamic_chain, bath::of_sigma(0.4, 0.3));

const std::vector<method> quiet_words{verlet(),      srkn11b(), takahashi_imada(),
                                      omelyan_fg4(), impulse(), start_of<r_fg4>()};
const std::vector<method> noisy_words{
    baoab(), obabo(), aboba(), method("at one end", nysalt::word("OBA"), {1.0, 1.0, 1.0}, {1, false, false})};

/// All numbers of a state, in order.
void add(std::vector<double>& all, double x) { all.push_back(x); }
template <int L>
void add(std::vector<double>& all, const pack<double, L>& x) {
  for (int k = 0; k < L; ++k) all.push_back(lane(x, k));
}
template <class T, int K>
void add(std::vector<double>& all, const dual<T, K>& x) {
  add(all, x.value);
  for (const T& slope : x.derivative) add(all, slope);
}
void add_state(std::vector<double>& all, const auto& x) {
  for (const auto* part : {&x.q, &x.p}) {
    for (const auto& number : *part) add(all, number);
  }
}

/// As many states as there are lanes.
start_states starts_of(const auto& system) {
  draws random;
  start_states all;
  for (int k = 0; k < pack<double>::lanes; ++k) {
    const auto x = random.state(system, 0.5);
    all.push_back({x.q, x.p});
  }
  return all;
}
template <class R, int N>
phase_point<R, N> gathered(const start_states& starts) {
  return detail::gather<R, N>(lanes_in<R>, [&](int k) -> phase_point<double, N> {
    const auto& x = starts[static_cast<std::size_t>(k)];
    return {x.q, x.p};
  });
}

/// What a run over T shows: advanced at once, watched, cut, one plain step, and the energy.
template <Scalar T, NoiseSource Noise, class S>
std::vector<double> numbers_of_run(const S& system, const method& method, double step,
                                   const start_states& starts, const Noise& noise) {
  const stepper<S, double, Noise> fixed(system, method.letters(), method.coefficients(), step, noise);
  const auto x = gathered<T, S::dimension>(starts);
  constexpr std::uint64_t trajectory = 5;
  std::vector<double> all;
  for (const std::int64_t steps : {1, 64}) {
    auto run = fixed.open(x, trajectory);
    fixed.advance(run, steps);
    add_state(all, fixed.synchronous(run));
  }
  for (const std::int64_t every : {1, 3}) {
    auto run = fixed.open(x, trajectory);
    const auto observe = [&](std::int64_t n, const auto& seen) {
      all.push_back(static_cast<double>(n));
      add_state(all, seen);
    };
    for (const std::int64_t steps : {7, 57, 0}) fixed.advance(run, steps, every, observe);
    add_state(all, fixed.synchronous(run));
  }
  auto plain = x;
  fixed.step(plain, trajectory, 3);
  add_state(all, plain);
  if constexpr (HasEnergy<S, T>) {
    if (has_energy(system)) add(all, energy<T>(system, plain));
  }
  return all;
}

/// Plain steps over T = dual<R, 2>, with derivatives by two parameters.
template <class R, NoiseSource Noise, class S>
std::vector<double> numbers_of_step(const S& system, const method& method, double step,
                                    const start_states& starts, const Noise& noise) {
  using T = dual<R, 2>;
  const auto plain = method.coefficients();
  std::vector<T> coefficients(plain.begin(), plain.end());
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    coefficients[i].derivative[0] = R(0.1 * static_cast<double>(i + 1));
    coefficients[i].derivative[1] = R(1.0 - 0.3 * static_cast<double>(i));
  }
  const stepper<S, T, Noise> fixed(system, method.letters(), coefficients, step, noise);
  auto x = gathered<R, S::dimension>(starts).template cast<T>();
  for (std::int64_t n = 0; n < 3; ++n) fixed.step(x, 5, n);
  std::vector<double> all;
  add_state(all, x);
  return all;
}

/// numbers(system, table, step) of the system and of its model are the same; another step or table has
/// others.
template <class S>
void compare(const S& system, const method& method, const auto& numbers) {
  constexpr double step = 0.05;
  const auto expected = numbers(system, method, step);
  BOOST_REQUIRE(!expected.empty());
  BOOST_REQUIRE(std::ranges::all_of(expected, [](double x) { return std::isfinite(x); }));
  const model erased(system);
  BOOST_TEST((numbers(erased, method, step) == expected));
  BOOST_TEST((numbers(erased, method, step * (1.0 + 1e-12)) != expected));
  auto changed = method.coefficients();
  for (const std::size_t i : {std::size_t{0}, changed.size() / 2}) changed[i] += 1e-9;
  const nysalt::method another("another", method.letters(), changed, method);
  BOOST_TEST((numbers(erased, another, step) != expected));
}

template <class S, Scalar T>
bool serves_word(const S& system, const method& method) {
  return !refuses([&] { require_served<S, T>(method.letters(), system); }, {});
}

template <class S, NoiseSource Noise, NoiseSource Lifted>
int compare_all(const S& system, const std::vector<method>& words, const Noise& noise, const Lifted& lifted) {
  const auto starts = starts_of(system);
  int compared = 0;
  for (const method& method : words) {
    if (!serves_word<S, double>(system, method)) continue;
    ++compared;
    BOOST_TEST_CONTEXT(describe(system) << ", " << method.name()) {
      const auto run_over = [&]<Scalar T>(T) {
        compare(system, method, [&](const auto& tested, const nysalt::method& table, double h) {
          return numbers_of_run<T>(tested, table, h, starts, noise);
        });
      };
      const auto step_over = [&]<Scalar R>(R) {
        compare(system, method, [&](const auto& tested, const nysalt::method& table, double h) {
          return numbers_of_step<R>(tested, table, h, starts, lifted);
        });
      };
      run_over(0.0);
      if constexpr (detail::serves<S, lanes>) run_over(lanes(0.0));
      if (!serves_word<S, slopes>(system, method)) continue;
      step_over(0.0);
      if constexpr (detail::serves<S, lanes_with_slopes> && std::is_same_v<Lifted, no_noise>) {
        if (serves_word<S, lanes_with_slopes>(system, method)) step_over(lanes(0.0));
      }
    }
  }
  return compared;
}

/// f(system) for each of the systems by their types.
void for_each_type(const auto& f) {
  f(fixed_chain);
  f(dynamic_chain);
  f(box);
  f(warm);
}

/// q'' = -k q, of which somebody changes k.
struct changing {
  static constexpr int dimension = 1;
  double k = 1.0;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = q[0] * -k; }
};
double force_at_one(const model& system) {
  const Eigen::VectorXd q = Eigen::VectorXd::Ones(1);
  Eigen::VectorXd f(1);
  system.force(q, f);
  return f[0];
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_model_steps_with_the_bits_of_its_system) {
  BOOST_TEST(compare_all(fixed_chain, quiet_words, no_noise(), no_noise()) == 6);
  BOOST_TEST(compare_all(dynamic_chain, quiet_words, no_noise(), no_noise()) == 6);
  BOOST_TEST(compare_all(box, quiet_words, no_noise(), no_noise()) == 4);
}

BOOST_AUTO_TEST_CASE(a_model_in_a_bath_feels_the_noise_of_its_system) {
  BOOST_TEST(compare_all(warm, noisy_words, counter_noise(3), fresh_noise(3)) == 4);
  const auto starts = starts_of(warm_free);  // with masses
  for (const method& method : noisy_words) {
    const auto expected = numbers_of_run<lanes>(warm_free, method, 0.05, starts, counter_noise(3));
    const auto of_seed = [&](std::uint64_t seed) {
      return numbers_of_run<lanes>(model(warm_free), method, 0.05, starts, counter_noise(seed));
    };
    BOOST_TEST((of_seed(3) == expected));
    BOOST_TEST((of_seed(4) != expected));
  }
}

BOOST_AUTO_TEST_CASE(a_model_refuses_what_its_system_refuses_in_the_same_words) {
  int refused = 0;
  int served = 0;
  const auto check = [&]<class S>(const S& system) {
    const model erased(system);
    for (const char* letters : {"ABA", "BAGAB", "AGA", "RSR", "SRHRS", "ROSOR", "HR", "OABAO"}) {
      const nysalt::word word(letters);
      const auto compare_over = [&]<Scalar T>(T) {
        const auto expected = refusal_of([&] { require_served<S, T>(word, system); });
        BOOST_TEST(refusal_of([&] { require_served<model, T>(word, erased); }) == expected,
                   describe(system) << ", " << letters);
        (expected.empty() ? served : refused) += 1;
      };
      compare_over(0.0);
      compare_over(slopes(0.0));
      if constexpr (detail::serves<S, lanes>) compare_over(lanes(0.0));
      if constexpr (detail::serves<S, lanes_with_slopes>) compare_over(lanes_with_slopes(0.0));
    }
  };
  for_each_type(check);
  check(relativistic());
  BOOST_TEST(refused > 30);
  BOOST_TEST(served > 40);
}

// States are of any size until they are stepped.
BOOST_AUTO_TEST_CASE(a_state_of_another_size_is_refused) {
  const model erased(fixed_chain);
  const auto fixed = make_stepper(erased, method(verlet()), 0.1);
  const phase_point<double, Eigen::Dynamic> of_three{Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3)};
  BOOST_TEST(refuses([&] { fixed.open(of_three); }, {"3 positions", "6 degrees of freedom"}));
}

BOOST_AUTO_TEST_CASE(facts_are_those_of_the_concepts) {
  const auto check = []<class S>(const S& system) {
    const model erased(system);
    BOOST_TEST_CONTEXT(describe(system)) {
      BOOST_TEST(size(erased) == size(system));
      BOOST_TEST(describe(erased) == describe(system));
      BOOST_TEST(erased.facts().has_potential == (HasPotential<S, double>));
      BOOST_TEST(has_energy(erased) == HasEnergy<S>);
      BOOST_TEST(has_quadratic_kinetic(erased) == NystromSystem<S>);
      BOOST_TEST(has_modes(erased) == HasModes<S>);
      BOOST_TEST(erased.facts().has_quadratic_part == HasQuadraticPart<S>);
      BOOST_TEST(erased.facts().has_bands == HasFrequencyBands<S>);
      BOOST_TEST(detail::is_black_box(erased) == BlackBoxForce<S>);
      BOOST_TEST(erased.facts().derivative_calls == detail::derivative_calls<S>);
      BOOST_TEST(erased.facts().derivative_source == std::string(detail::derivative_source<S>()));
      BOOST_TEST(erased.facts().in_lanes == (detail::lanes_of<S> > 1 && SystemOver<S, lanes>));
      BOOST_TEST(erased.has_unit_mass() == !HasInverseMass<S>);
      if constexpr (HasInverseMass<S>) {
        for (Eigen::Index i = 0; i < size(system); ++i) {
          BOOST_TEST(erased.inverse_mass(i) == system.inverse_mass(i));
          BOOST_TEST(root_mass(erased, i) == 1.0 / std::sqrt(system.inverse_mass(i)));
        }
      }
      if constexpr (HasModes<S>) {
        BOOST_TEST((erased.modes().frequencies == system.modes().frequencies));
        BOOST_TEST((erased.modes().basis == system.modes().basis));
        BOOST_TEST(frequency_to_fit(erased) == system.modes().frequencies.maxCoeff());
      }
      std::vector<frequency_band> bands;
      if constexpr (HasFrequencyBands<S>) bands = system.frequency_bands();
      BOOST_TEST(std::ranges::equal(erased.frequency_bands(), bands, [](const auto& x, const auto& y) {
        return x.low == y.low && x.high == y.high;
      }));
      if constexpr (HasBath<S>) BOOST_TEST(erased.bath().description() == system.bath().description());
      BOOST_TEST(erased.bath().acts() == HasBath<S>);
    }
  };
  for_each_type(check);
  check(relativistic());
  check(in_lanes<fpu_chain<3>, 1>(fixed_chain));
  const model alone = model(warm).base();
  BOOST_TEST(!alone.bath().acts());
  BOOST_TEST(describe(alone) == describe(fixed_chain));
}

BOOST_AUTO_TEST_CASE(functions_of_a_model_have_the_bits_of_its_system) {
  constexpr double reach = 1e-3;
  const auto check = []<class S>(const S& system) {
    constexpr int N = S::dimension;
    const model erased(system);
    const auto own = gathered<double, N>(starts_of(system));
    const phase_point<double, Eigen::Dynamic> x{own.q, own.p};
    auto found = x.q;
    auto expected = own.q;
    BOOST_TEST_CONTEXT(describe(system)) {
      velocity<double>(system, own.p, expected);
      velocity<double>(erased, x.p, found);
      BOOST_TEST((found == expected));
      lifted_room<double, N> own_room(own.q.size());
      lifted_room<double, Eigen::Dynamic> room(own.q.size());
      force_along<field::whole, double>(system, own.q, own.p, expected, own_room, reach);
      force_along<field::whole, double>(erased, x.q, x.p, found, room, reach);
      BOOST_TEST((found == expected));
      if constexpr (BlackBoxForce<S>) {
        auto at_first = own.q;
        force<double>(system, own.q, at_first);
        directional_derivative(system, own.q, own.p, at_first, expected);
        directional_derivative(erased, x.q, x.p, Eigen::VectorXd(at_first), found);
        BOOST_TEST((found == expected));
      }
      using D = dual<double, 1>;
      auto slope = own.template cast<D>().p;
      for (Eigen::Index i = 0; i < slope.size(); ++i) slope[i].derivative[0] = own.q[i];
      auto expected_slope = slope;
      velocity<D>(system, slope, expected_slope);
      vector<D, Eigen::Dynamic> found_slope(slope.size());
      velocity<D>(erased, vector<D, Eigen::Dynamic>(slope), found_slope);
      for (Eigen::Index i = 0; i < slope.size(); ++i) {
        BOOST_TEST(found_slope[i].value == expected_slope[i].value);
        BOOST_TEST(found_slope[i].derivative[0] == expected_slope[i].derivative[0]);
      }
      if constexpr (HasEnergy<S>) {
        BOOST_TEST(kinetic_energy<double>(erased, x.p) == kinetic_energy<double>(system, own.p));
        BOOST_TEST(energy<double>(erased, x) == energy<double>(system, own));
      }
    }
  };
  for_each_type(check);
  check(relativistic());
}

BOOST_AUTO_TEST_CASE(starts_are_typical_and_energetic_where_the_model_has_an_energy) {
  for (const model& system : {model(fixed_chain), model(box)}) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size(system));
    const normal_around<Eigen::Dynamic> law({zero, zero}, 0.1, 0.2);
    const auto starts = detail::typical_and_energetic_starts(system, law, 1, 5, 10);
    BOOST_TEST(starts.size() == detail::plain_starts + (has_energy(system) ? 64U : 0U));
    for (std::size_t n = 0; n < detail::plain_starts; ++n) {
      BOOST_TEST((starts[n].q == law(1, 5 + n).q && starts[n].p == law(1, 5 + n).p));
      BOOST_TEST((starts[n].q != law(2, 5 + n).q && starts[n].p != law(2, 5 + n).p));
    }
    if (!has_energy(system)) continue;
    std::vector<double> energies;  // the 64 most energetic of the 896 that come next
    for (std::uint64_t n = 0; n < 896; ++n)
      energies.push_back(energy<double>(system, law(1, 5 + detail::plain_starts + n)));
    std::ranges::sort(energies, std::greater<>());
    for (std::size_t k = 0; k < 64; ++k) {
      const phase_point<double, Eigen::Dynamic> x = starts[detail::plain_starts + k];
      BOOST_TEST(energy<double>(system, x) == energies[k]);
    }
  }
  const normal_around<2> of_two({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.2);
  BOOST_TEST(
      refuses([&] { detail::typical_and_energetic_starts(box, of_two, 1, 0, 10); }, {"the dimension of"}));
}

BOOST_AUTO_TEST_CASE(packs_are_refused_by_a_system_of_one_lane) {
  const model erased(in_lanes<fpu_chain<3>, 1>{fixed_chain});
  BOOST_TEST(!erased.facts().in_lanes);
  vector<lanes, Eigen::Dynamic> q(6);
  q.fill(lanes(0.1));
  auto f = q;
  BOOST_TEST(refuses<std::logic_error>([&] { erased.force(q, f); }, {"does not serve"}));
  const auto lanes_taken_by = [](const model& system) {
    return detail::with_scalar_of(system, []<class T>(T) { return lanes_in<T>; });
  };
  BOOST_TEST(lanes_taken_by(erased) == 1);
  BOOST_TEST(lanes_taken_by(fixed_chain) == pack<double>::lanes);
}

BOOST_AUTO_TEST_CASE(copies_share_a_copy_of_the_system_and_a_separate_one_has_its_own) {
  changing system;
  const model first(system);
  system.k = 2.0;
  BOOST_TEST(force_at_one(first) == -1.0);
  BOOST_TEST(force_at_one(system) == -2.0);
  const model copy = first;
  BOOST_TEST(force_at_one(copy) == -1.0);
  BOOST_TEST((first.calls() == 2 && copy.calls() == 2));
  const model own = first.separate();
  BOOST_TEST(own.calls() == 0);  // counted for itself
  BOOST_TEST(force_at_one(own) == -1.0);
  BOOST_TEST(own.calls() == 1);
  BOOST_TEST(copy.calls() == 2);
  BOOST_TEST(describe(own) == describe(first));
}
