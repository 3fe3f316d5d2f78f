// SPDX-License-Identifier: BSL-1.0
// What a letter states of itself is true of its flow, for each letter of the library. R is the
// exact flow of the quadratic part, with masses and with a frequency of zero. G and H are their formula,
// p += b h f + 2 c h^3 f'(q) M^-1 f, and cost two evaluations, of a black box three; D is
// p += b h f(q + c h^2 M^-1 f(q)). O does to a momentum what the bath says, each mass in its measure. Letters
// of one's own, which the system declares, go where letters of the library go: over packs and derivatives, by
// the type of the system and its model, and into learning; to the same bits.
#include "nysalt/letters.hpp"
#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/flows/exact_flow.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// q'' = -(omega^2 + kappa) q, of which omega^2 is the quadratic part.
struct spring_and_rest {
  static constexpr int dimension = 1;
  static constexpr double omega = 1.3;
  static constexpr double kappa = 2.0;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * -(omega * omega + kappa);
  }
  template <class T>
  void soft_force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * -kappa;
  }
  normal_modes modes() const { return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, omega)}; }
};

/// One that declares no quadratic part.
struct without_parts {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -q[0]; }
};

/// f(flow) for all letters but that of the bath.
void for_each_hamiltonian(const auto& f) {
  const auto unless_of_bath = [&](auto flow) {
    if constexpr (!StochasticFlow<decltype(flow)>) f(flow);
  };
  std::apply([&](auto... flow) { (unless_of_bath(flow), ...); }, detail::known_letters{});
}

std::vector<double> random_coefficients(draws& random, std::size_t slots) {
  std::vector<double> c(slots);
  for (double& x : c) x = random.uniform(0.2, 1.0);
  return c;
}

struct state {
  double q = 0.4;
  double p = -0.9;
  /// As far from another as ten roundings of numbers up to 10 lead.
  bool is_near(const state& other) const {
    return std::abs(q - other.q) <= 100.0 * eps && std::abs(p - other.p) <= 100.0 * eps;
  }
};

state after(const nysalt::word& word, const std::vector<double>& c, state x) {
  detail::step_on_oscillator(
      word, c, spring_and_rest::omega, [](double y) { return spring_and_rest::kappa * y; }, x.q, x.p);
  return x;
}

state after_stepping(const nysalt::word& word, const std::vector<double>& c, const state& x) {
  const spring_and_rest system;
  phase_point<double, 1> z{vector<double, 1>(x.q), vector<double, 1>(x.p)};
  stepper<spring_and_rest>(system, word, c, 1.0).step(z);
  return {z.q[0], z.p[0]};
}

/// To the modes and back each sums three products of numbers below 10, both ways of reckoning alike.
constexpr double rounding_of_modes = 2.0 * (2.0 * 3.0 + 6.0) * eps * 10.0;

constexpr double h = 0.4;
constexpr double b = 0.7;
constexpr double c = 0.013;
constexpr double rounding = 30.0 * eps;  // some 30 operations on numbers below 2

template <SeparableSystem S>
auto kicked(const char* letter, const S& system, phase_point<double, S::dimension> x, double of_g = c) {
  stepper(system, nysalt::word(letter), {b, of_g}, h).step(x);
  return x;
}

/// Evaluations of a plain step, and of ten steps of a run.
std::array<std::int64_t, 2> evaluations_of(const auto& system, const word& letters,
                                           const std::vector<double>& coefficients) {
  const counted watched(system);
  const stepper one(watched, letters, coefficients, 0.01);
  const auto x = draws().state(system, 0.3);
  auto y = x;
  one.step(y);
  const std::int64_t plain = watched.evaluations;
  auto run = one.open(x);
  one.advance(run, 10);
  return {plain, watched.evaluations - plain};
}

template <Family F>
void check_cost(const auto& system, std::int64_t plain, std::int64_t ten_steps) {
  const word& letters = F::letters;
  const auto c = F::coefficients(F::start());
  BOOST_TEST_CONTEXT(F::name << " on " << describe(system)) {
    BOOST_TEST((evaluations_of(system, letters, {c.begin(), c.end()}) == std::array{plain, ten_steps}));
    using S = std::decay_t<decltype(system)>;
    const int more =
        (detail::derivative_calls<S> - 1) * letters.force_derivatives;  // than what the word says of others
    BOOST_TEST(letters.evaluations_of_plain_step + more == plain);
    BOOST_TEST(letters.evaluations_to_open + 10 * (letters.evaluations_per_step + more) == ten_steps);
  }
}

template <System S, Scalar C = double>
flow_state<double, 2> after_o(const S& system, const ornstein_uhlenbeck::prepared<C>& flow,
                              const vector<double, 2>& p, const vector<double, 2>& xi) {
  flow_state<double, 2> x{{{0.3, -0.2}, p}, {0.0, 0.0}};
  ornstein_uhlenbeck::apply(system, flow, xi, x);
  return x;
}

/// The drift, written again.
struct my_drift : exact_flow<'a'> {
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.q[i] += x.p[i] * t;
  }
};
/// The kick, written again: it evaluates the force itself.
struct my_kick : exact_flow<'b'> {
  static constexpr bool moves_q = false;
  static constexpr int displaced_forces = 1;
  template <System S, class State, class C>
  static void apply(const S& system, const C& t, State& x, auto& room) {
    using T = typename State::scalar_type;
    force<T>(system, x.q, room.x);
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += room.x[i] * t;
  }
};

method method_of(const word& letters) {
  return {letters.letters(), letters, {0.3, 0.5, 0.4, 0.5, 0.3}, {2, true, false}};
}
constexpr word own_drifts_first = alternating_word<my_drift, my_kick, 5>();
constexpr word own_kicks_first = alternating_word<my_kick, my_drift, 5>();
constexpr word mixed = alternating_word<drift, my_kick, 5>();

using lettered_galaxy = with_letters<henon_heiles, my_drift, my_kick>;
const lettered_galaxy galaxy;

const phase_point<double, 2> start{{0.1, -0.2}, {0.3, 0.1}};

/// The states that a watched run of 7 steps shows, every second of them and the last.
template <class S>
std::vector<double> seen(const S& system, const word& letters,
                         const phase_point<double, S::dimension>& from) {
  const auto steps = make_stepper(system, method_of(letters), 0.2);
  std::vector<double> all;
  const auto note = [&](const auto& x) {
    all.insert(all.end(), x.q.begin(), x.q.end());
    all.insert(all.end(), x.p.begin(), x.p.end());
  };
  auto run = steps.open(from);
  steps.advance(run, 7, 2, [&](std::int64_t, const auto& x) { note(x); });
  note(steps.synchronous(run));
  auto x = from;
  steps.step(x);
  note(x);
  return all;
}

struct own_family : symmetric_composition<my_drift, my_kick, 7> {
  static constexpr std::string_view name = "own";
};
/// For systems of one coordinate only.
struct for_one_coordinate : exact_flow<'u'> {
  template <System S, Scalar T>
  static constexpr bool serves = S::dimension == 1;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    x.q[0] += x.p[0] * t;
  }
};
/// p -= sin(q) of another force.
struct off_kick : my_kick {
  static constexpr bool moves_q = false;
  template <System S, class State, class C>
  static void apply(const S&, const C& t, State& x, auto&) {
    x.p[0] -= x.q[1] * t;
    x.p[1] += x.q[0] * t;
  }
};
struct off_family : symmetric_composition<my_drift, off_kick, 7> {
  static constexpr std::string_view name = "off";
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_action_on_an_oscillator_is_that_of_the_flow) {
  draws random;
  for_each_hamiltonian([&](auto flow) {
    const nysalt::word word(std::string(1, flow.letter));
    auto c = random_coefficients(random, flow.slots);
    BOOST_TEST_CONTEXT("letter " << flow.letter) {
      BOOST_TEST(after(word, c, {}).is_near(after_stepping(word, c, {})));
      c.back() += 0.01;
      const auto other = after_stepping(word, c, {});
      c.back() -= 0.01;
      BOOST_TEST(!after(word, c, {}).is_near(other));
    }
  });
}

// Symplectic, additive, taken back by negated coefficients, reversible, leaving q alone: what it says of
// these.
BOOST_AUTO_TEST_CASE(each_letter_is_what_it_states) {
  const std::vector<phase_point<double, Eigen::Dynamic>> points{
      {Eigen::Vector2d(0.1, -0.2), Eigen::Vector2d(0.3, 0.1)},
      {Eigen::Vector2d(-0.3, 0.25), Eigen::Vector2d(0.05, -0.2)}};
  for_each_hamiltonian([&](auto flow) {
    const letter_check found = check_letter(henon_heiles(), flow.letter, points, 0.7);
    BOOST_TEST(found.passed(), found.report());
    BOOST_TEST(flow.invertible == (flow.letter != 'D'));
  });
  BOOST_TEST(!ornstein_uhlenbeck::invertible);
  BOOST_TEST(!after(nysalt::word("DD"), {0.7, 0.3, -0.7, -0.3}, {}).is_near({}));
}

BOOST_AUTO_TEST_CASE(letters_of_a_quadratic_part_are_those_that_need_one) {
  for_each_hamiltonian([&](auto flow) {
    using L = decltype(flow);
    const bool is_of_part = L::splits == splitting::quadratic_part_and_rest;
    BOOST_TEST(is_of_part == !(L::template serves<without_parts, double>), flow.letter);
    BOOST_TEST(is_of_part == nysalt::word(std::string(1, flow.letter)).rotates(), flow.letter);
    BOOST_TEST((L::same_order_as::splits == splitting::kinetic_and_potential), flow.letter);
    BOOST_TEST(L::slots == L::same_order_as::slots, flow.letter);
    BOOST_TEST(L::moves_q == L::same_order_as::moves_q, flow.letter);
  });
  BOOST_TEST((ornstein_uhlenbeck::splits == splitting::any));
  BOOST_TEST(nysalt::word("OSO").rotates());
  BOOST_TEST(!nysalt::word("OSO").reads_modes);
  BOOST_TEST(nysalt::word("ORO").reads_modes);
  BOOST_TEST(!nysalt::word("OBAGO").rotates());
  static_assert(word("SRS").rotates() && !word("BAB").rotates());
}

BOOST_AUTO_TEST_CASE(on_a_linear_system_a_rotation_is_the_exact_flow) {
  const auto chain = free_chain();
  const reference exact = exact_linear(chain);
  draws random;
  for (const double h : {1e-3, 0.3, 2.0, -0.7}) {
    for (int n = 0; n < 5; ++n) {
      const auto x = random.state(chain, 1.0);
      auto expected = x;
      exact.advance(chain, expected, h);
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", step " << h) {
        const auto off = [&](const char* letters, const std::vector<double>& c) {
          auto y = x;
          stepper(chain, nysalt::word(letters), c, h).step(y);
          return distance(y, expected);
        };
        BOOST_TEST(off("R", {1.0}) <= rounding_of_modes);
        BOOST_TEST(off("R", {1.0 + 1e-9}) > rounding_of_modes);
        // What is soft is nothing: all words with one rotation in all are the same.
        BOOST_TEST(off("SRS", {0.5, 1.0, 0.5}) <= rounding_of_modes);
        BOOST_TEST(off("RSR", {0.3, 1.0, 0.7}) <= 2.0 * rounding_of_modes);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(gradient_kicks_are_those_of_the_formula) {
  draws random;
  const two_masses whole;
  const auto split = split_masses();
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(whole, 1.0);
    const auto expected = [&](const vector<double, 2>& f, const Eigen::Matrix2d& slope) {
      const vector<double, 2> v(f[0], 0.25 * f[1]);  // masses 1 and 4
      auto y = x;
      y.p += f * (b * h) + slope * v * (2.0 * c * h * h * h);
      return y;
    };
    const vector<double, 2> soft = -x.q.array().cube();
    const double elongation = x.q[1] - x.q[0];
    const vector<double, 2> spring(elongation, -elongation);
    const Eigen::Matrix2d soft_slope = (-3.0 * x.q.cwiseAbs2()).asDiagonal();
    const Eigen::Matrix2d spring_slope{{-1.0, 1.0}, {1.0, -1.0}};
    const auto by_whole = expected(spring + soft, spring_slope + soft_slope);
    BOOST_TEST(distance(kicked("G", whole, x), by_whole) <= rounding);
    BOOST_TEST(distance(kicked("G", whole, x, 1.01 * c), by_whole) > 1e3 * rounding);
    const auto by_soft = expected(soft, soft_slope);
    BOOST_TEST(distance(kicked("H", split, x), by_soft) <= rounding);
    BOOST_TEST(distance(kicked("G", split, x), by_soft) > 1e-6);  // G is of the whole force
  }
}

// Coefficients of dual numbers: dp/db = h f, dp/dc = 2 h^3 f' f. However the force is written they are the
// same, but for differences: a central one along h^2 f errs by s^2 (h^2 f)^2/6 and eps/(s h^2) of its size,
// which is below .001.
BOOST_AUTO_TEST_CASE(derivatives_by_both_coefficients_flow_through_a_gradient_kick) {
  using D = dual<double, 2>;
  constexpr double s = detail::part_of_displacement;
  const double f = -std::sin(0.8);
  const double by_c = 2.0 * h * h * h * -std::cos(0.8) * f;
  const auto check = [&](const auto& system, double of_differences) {
    phase_point<D, 1> x{vector<D, 1>(D(0.8)), vector<D, 1>(D(0.1))};
    using S = std::decay_t<decltype(system)>;
    stepper<S, D>(system, word("G"), {D::variable(b, 0), D::variable(c, 1)}, h).step(x);
    const D& p = x.p[0];
    BOOST_TEST(std::abs(p.value - (0.1 + b * h * f + c * by_c)) <= rounding + c * of_differences);
    BOOST_TEST(std::abs(p.derivative[0] - h * f) <= rounding);
    BOOST_TEST(std::abs(p.derivative[1] - by_c) <= rounding + of_differences);
  };
  check(black_box_with_derivative(), 0.0);
  const double relative = s * s * h * h * h * h * f * f / 6.0 + 2.0 * eps / (s * h * h);
  check(black_box(), std::abs(by_c) * relative);
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_is_that_of_the_formula) {
  draws random;
  const two_masses system;
  constexpr double of_g = 0.13;
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(system, 1.0);
    vector<double, 2> f;
    vector<double, 2> displaced;
    force<double>(system, x.q, f);
    const vector<double, 2> v(f[0], 0.25 * f[1]);  // masses 1 and 4
    force<double>(system, vector<double, 2>(x.q + of_g * h * h * v), displaced);
    const vector<double, 2> expected = x.p + b * h * displaced;
    BOOST_TEST((kicked("D", system, x, of_g).p - expected).norm() <= 2.0 * rounding);
    force<double>(system, vector<double, 2>(x.q + of_g * h * h * f), displaced);  // without masses
    BOOST_TEST((x.p + b * h * displaced - expected).norm() > 2e4 * rounding);
  }
}

BOOST_AUTO_TEST_CASE(gradient_and_displaced_kicks_cost_two_evaluations_and_differences_three) {
  const std::array alone{std::int64_t{2}, std::int64_t{11}};  // the force is known: q does not move
  BOOST_TEST((evaluations_of(two_masses(), nysalt::word("G"), {b, c}) == alone));
  // fg_chin: the last kick's force is the first one's of the next step.
  check_cost<fg_chin>(dynamic_potential(), 4, 1 + 10 * 3);
  check_cost<fg_chin>(black_box(), 5, 1 + 10 * 4);
  check_cost<fg_chin>(black_box_with_derivative(), 4, 1 + 10 * 3);
  check_cost<fd_chin>(black_box(), 4, 1 + 10 * 3);  // no derivative, no differences
  check_cost<fg4>(two_masses(), 4, 10 * 4);
  check_cost<r_fg4>(split_masses(), 4, 10 * 4);  // rotations cost none
}

static_assert(Flow<ornstein_uhlenbeck> && StochasticFlow<ornstein_uhlenbeck>);
static_assert(!ornstein_uhlenbeck::additive && !ornstein_uhlenbeck::moves_q &&
              ornstein_uhlenbeck::reads == field::none);

// sigma M^{1/2} dW: with mass 4 the noise is twice as large, and p^2/m has the same temperature.
BOOST_AUTO_TEST_CASE(a_heavier_mass_gets_more_noise) {
  const auto flow = ornstein_uhlenbeck::prepare(1.0, 0.2, bath::of_sigma(0.4, 0.9));
  const two_masses system;
  BOOST_REQUIRE(system.inverse_mass(1) == 0.25);
  const auto x = after_o(system, flow, {0.0, 0.0}, {1.0, 1.0});
  BOOST_TEST(x.p[0] == flow.deviation);
  BOOST_TEST(x.p[1] == 2.0 * flow.deviation);
}

BOOST_AUTO_TEST_CASE(a_letter_that_is_not_prepared_does_nothing) {
  const auto x = after_o(two_masses(), ornstein_uhlenbeck::prepared<double>{}, {1.0, -2.0}, {3.0, 3.0});
  BOOST_TEST((x.p == vector<double, 2>(1.0, -2.0)));
}

BOOST_AUTO_TEST_CASE(noise_cannot_go_back_in_time) {
  const auto noisy = bath::of_sigma(0.4, 0.9);
  const auto heating = bath::of_sigma(0.0, 0.9);
  const auto cold = bath::of_sigma(0.4, 0.0);
  for (const auto& heat_bath : {noisy, heating}) {
    BOOST_TEST(refuses([&] { ornstein_uhlenbeck::prepare(1.0, -0.2, heat_bath); },
                       {"letter O", "back in time", "-0.2", "the sign of the step"}));
    BOOST_TEST(refuses([&] { ornstein_uhlenbeck::prepare(-1.0, 0.2, heat_bath); }, {"back in time"}));
    BOOST_TEST(ornstein_uhlenbeck::prepare(0.0, 0.2, heat_bath).deviation == 0.0);
    BOOST_TEST(ornstein_uhlenbeck::prepare(-1.0, -0.2, heat_bath).deviation == heat_bath.deviation(0.2));
  }
  BOOST_TEST(
      refuses([&] { ornstein_uhlenbeck::prepare(pack<double, 3>(-1.0), 0.2, noisy); }, {"back in time"}));
  // What damps alone grows backwards: one undoes the other, to rounding.
  const double there = ornstein_uhlenbeck::prepare(1.0, 0.2, cold).decay;
  const double back = ornstein_uhlenbeck::prepare(1.0, -0.2, cold).decay;
  BOOST_TEST(back > 1.0);
  BOOST_TEST(std::abs(there * back - 1.0) <= 4.0 * eps);
}

// Coefficients that carry derivatives act on states that do.
BOOST_AUTO_TEST_CASE(derivatives_flow_through_the_letter_o) {
  using D = dual<double, 1>;
  const auto flow = ornstein_uhlenbeck::prepare(D::variable(0.5, 0), 0.2, bath::of_sigma(0.4, 0.9));
  flow_state<D, 2> x{{{D(0.3), D(-0.2)}, {D(1.0), D(-2.0)}}, {D(0.0), D(0.0)}};
  vector<D, 2> xi(D(0.7), D(-0.1));
  ornstein_uhlenbeck::apply(two_masses(), flow, xi, x);
  BOOST_TEST(x.p[0].value == flow.decay.value + 0.7 * flow.deviation.value);
  BOOST_TEST(x.p[0].derivative[0] == flow.decay.derivative[0] + 0.7 * flow.deviation.derivative[0]);
  BOOST_TEST(x.p[0].derivative[0] != 0.0);
}

BOOST_AUTO_TEST_CASE(a_model_steps_with_the_bits_of_its_system) {
  const auto check = [](const auto& system, const word& letters, const auto& from) {
    const phase_point<double, Eigen::Dynamic> dynamic{from.q, from.p};
    BOOST_TEST(seen(system, letters, from) == seen(model(system), letters, dynamic));
  };
  check(galaxy, own_drifts_first, start);
  check(galaxy, own_kicks_first, start);
  check(galaxy, mixed, start);
  const phase_point<double, Eigen::Dynamic> from{Eigen::VectorXd::LinSpaced(5, -0.3, 0.4),
                                                 Eigen::VectorXd::LinSpaced(5, 0.2, -0.1)};
  check(with_letters<phi4_chain<>, my_drift, my_kick>(5), own_kicks_first, from);
}

BOOST_AUTO_TEST_CASE(letters_written_again_have_the_bits_of_the_library) {
  BOOST_TEST(seen(galaxy, own_drifts_first, start) == seen(henon_heiles(), word("ABABA"), start));
  BOOST_TEST(seen(galaxy, own_kicks_first, start) == seen(henon_heiles(), word("BABAB"), start));
  BOOST_TEST(seen(galaxy, own_kicks_first, start) != seen(galaxy, word("ABABA"), start));
}

BOOST_AUTO_TEST_CASE(lanes_change_no_bit) {
  draws random;
  const model system(galaxy);
  const nysalt::method method = method_of(own_kicks_first);
  BOOST_TEST((run_of{system, method, 0.2}.lanes_are_alone(specimen_of("henon_heiles"), random)));
}

BOOST_AUTO_TEST_CASE(evaluations_are_those_of_the_word) {
  static_assert(own_kicks_first.view() == "babab" && own_kicks_first.has_own_letters());
  static_assert(own_kicks_first.merges && own_kicks_first.evaluations_per_step == 2 &&
                own_kicks_first.evaluations_of_plain_step == 3 && own_kicks_first.evaluations_to_open == 1 &&
                own_kicks_first.evaluations_to_observe == 1);
  BOOST_TEST((evaluations_of(galaxy, own_kicks_first, {0.3, 0.5, 0.4, 0.5, 0.3}) ==
              std::array{std::int64_t{3}, std::int64_t{21}}));
}

BOOST_AUTO_TEST_CASE(letters_are_taken_from_a_list_by_their_names) {
  const std::vector<letter_facts> known = model(galaxy).facts().own_letters;
  BOOST_TEST((word("ababa", known) == own_drifts_first));
  BOOST_TEST((word("ababa", known) != own_kicks_first));
  BOOST_TEST(!word("BAB", known).has_own_letters());  // what a word does not hold it does not carry
  BOOST_TEST(word("AaA", known).own_letter('b') == nullptr);
  BOOST_TEST((own_kicks_first.with_letters("ababa") == own_drifts_first));
  BOOST_TEST(refuses([&] { word("aca", known); }, {"aca with the letter c"}));
  BOOST_TEST(refuses([&] { word("aBa"); }, {"aBa with the letter a"}));
}

BOOST_AUTO_TEST_CASE(a_system_steps_only_letters_that_it_declares) {
  const auto refused = [](const auto& system, const word& letters, said words) {
    return refuses([&] { make_stepper(system, method_of(letters), 0.1); }, words);
  };
  BOOST_TEST(!refused(galaxy, own_drifts_first, {}));
  BOOST_TEST(!refused(model(galaxy), own_drifts_first, {}));
  const said not_declared{
      "cannot step henon_heiles() by the word ababa: the system must declare the letter a", "using letters",
      "with_letters"};
  BOOST_TEST(refused(henon_heiles(), own_drifts_first, not_declared));
  BOOST_TEST(refused(model(henon_heiles()), own_drifts_first, not_declared));
  // A letter of the same name that states something else.
  auto stated = detail::facts_of_letter<my_drift>();
  stated.moves_q = false;
  const word other("aBaBa", std::array{stated});
  BOOST_TEST(refused(galaxy, other, {"must declare the letter a"}));
  BOOST_TEST(refused(model(galaxy), other, {"must declare the letter a"}));
  const with_letters<henon_heiles, for_one_coordinate> of_two;
  constexpr word unserved = alternating_word<for_one_coordinate, kick, 5>();
  BOOST_TEST(refused(of_two, unserved, {"uBuBu", "the letter u must serve the system"}));
  BOOST_TEST(refused(model(of_two), unserved, {"uBuBu", "the letter u must serve the system"}));
  // The action of a letter of one's own on an oscillator is not guessed.
  BOOST_CHECK_THROW(stability_windows(method_of(own_drifts_first)), std::invalid_argument);
}

// The losses have equal bits, so that a search from one start goes the same way.
BOOST_AUTO_TEST_CASE(what_is_learned_with_it_is_what_is_learned_with_the_library) {
  const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.1);
  const auto data = [&](std::uint64_t seed) {
    return make_flow_map_data(galaxy, starts, fine_steps(0.01),
                              {.step = 0.5, .horizon = 2.0, .trajectories = 16, .seed = seed});
  };
  const auto first = data(1);
  const auto second = data(2);
  const fit_options options{.start = column_of(own_family::start()), .random_starts = 0, .guarded = false};
  const fit own = learn(own_family(), galaxy, first, second, options);
  const fit known = learn(aba<3>(), galaxy, first, second, options);
  BOOST_TEST(own.summary.loss == known.summary.loss);
  BOOST_TEST((own.theta == known.theta));
  // Of drifts and kicks of one's own, but of the library's own letters the bands.
  BOOST_TEST(own.summary.guard.starts_with("linearised motion of abababa along "), own.summary.guard);
  BOOST_TEST(!known.summary.guard.starts_with("linearised"), known.summary.guard);
  BOOST_TEST(own.summary.loss < own.summary.held_out_start_loss);
  const with_letters<henon_heiles, my_drift, off_kick> off;
  BOOST_TEST(refuses([&] { learn(off_family(), off, first, second); },
                     {"the letter b is not symplectic: it is off by "}));
}
