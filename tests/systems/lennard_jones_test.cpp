// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 6 s at -O0, 0.7 s at -O1.
// Lennard-Jones clusters are at rest, and of the energies that their shapes have. The liquid's forces are
// those of all pairs, with bits that neither lists nor threads change; sums that know no order, and lists
// that hold for as long as they say.
#include "nysalt/systems/lennard_jones.hpp"
#include <set>
#include "../../src/nysalt/systems/neighbour_list.hpp"
#include "../support/dense.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;
using liquid = lennard_jones_liquid;
using options = lennard_jones_liquid_options;

namespace {

struct distances {
  double pairs;
  double length;  // of each
};

/// The least of 4 sum (r^-12 - r^-6) over the scale of a shape: with S_k = sum length^-k it is
/// -S_6^2/S_12. A shape whose only free length is its scale is in equilibrium there.
double least_energy(const std::vector<distances>& shape) {
  double sixth = 0.0;
  double twelfth = 0.0;
  for (const auto& [pairs, length] : shape) {
    sixth += pairs * std::pow(length, -6);
    twelfth += pairs * std::pow(length, -12);
  }
  return -sixth * sixth / twelfth;
}

/// At rest to 1e-12 in each force: the energy errs by the square of that, and rounds.
double energy_off(Eigen::Index space, Eigen::Index atoms, double expected) {
  const lennard_jones<> system(space, atoms);
  return std::abs(system.potential(detail::cluster_at_rest(system)) - expected) /
         (100.0 * eps * std::abs(expected));
}

const double golden = 0.5 * (1.0 + std::sqrt(5.0));
const double radius = 0.5 * std::sqrt(golden * golden + 1.0);  // of the icosahedron of edge 1

/// The derivative of 4 (x^-6 - x^-3) of that order.
double pair_derivative(double x, int order) {
  const double third = 1.0 / (x * x * x);
  double of_sixth = 4.0 * third * third;
  double of_third = 4.0 * third;
  for (int k = 0; k < order; ++k) {
    of_sixth *= (-6.0 - k) / x;
    of_third *= (-3.0 - k) / x;
  }
  return of_sixth - of_third;
}
/// The same less the Taylor polynomial.
class smooth_pair {
 public:
  explicit smooth_pair(const options& of) : centre_(of.cutoff * of.cutoff) {
    for (int m = 0; m <= of.smoothness; ++m) at_centre_.push_back(pair_derivative(centre_, m));
  }
  double derivative(double x, int order) const {
    double result = pair_derivative(x, order);
    double term = 1.0;
    for (std::size_t m = static_cast<std::size_t>(order); m < at_centre_.size(); ++m) {
      result -= at_centre_[m] * term;
      term *= (x - centre_) / (static_cast<double>(m) - order + 1.0);
    }
    return result;
  }
  double centre() const { return centre_; }

 private:
  double centre_;
  std::vector<double> at_centre_{};
};

/// By all pairs; what rounding may add to a component of the force of each atom, to V, and to the virial.
struct all_pairs {
  all_pairs(const liquid& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v)
      : force(Eigen::VectorXd::Zero(q.size())),
        derivative(force),
        force_error(force),
        derivative_error(force) {
    const double side = system.side();
    const smooth_pair pair(system.options());
    long double energies = 0.0;
    long double virials = 0.0;
    for (Eigen::Index i = 0; i < q.size(); i += 3) {
      for (Eigen::Index j = i + 3; j < q.size(); j += 3) {
        Eigen::Vector3d d = q.segment<3>(i) - q.segment<3>(j);
        for (double& along : d) along -= side * std::nearbyint(along / side);
        const double x = d.squaredNorm();
        if (x >= pair.centre()) continue;
        const double push = -2.0 * pair.derivative(x, 1);
        const double slope = -4.0 * pair.derivative(x, 2);
        const double steeper = 8.0 * std::abs(pair.derivative(x, 3));
        const Eigen::Vector3d w = v.segment<3>(i) - v.segment<3>(j);
        const Eigen::Vector3d change = push * w + slope * d.dot(w) * d;
        force.segment<3>(i) += push * d;
        force.segment<3>(j) -= push * d;
        derivative.segment<3>(i) += change;
        derivative.segment<3>(j) -= change;
        energies += pair.derivative(x, 0);
        virials += push * x;
        // Each of two positions is rounded to eps of a side, or of what it is; some 30 roundings of either
        // formula, whose powers magnify that of x by up to 8.
        const double moved = 4.0 * eps * (side + q.cwiseAbs().maxCoeff());
        const double rounded = 60.0 * eps;
        const double r = std::sqrt(x);
        const double stiff = std::abs(push) + std::abs(slope) * x;
        const double stiffer = (3.0 * std::abs(slope) + steeper * x) * r;
        for (const Eigen::Index k : {i, j}) {
          force_error.segment<3>(k).array() += stiff * moved + rounded * std::abs(push) * r;
          derivative_error.segment<3>(k).array() += (stiffer * moved + rounded * stiff) * w.norm();
        }
        potential_error += std::abs(push) * r * moved + rounded * (std::abs(pair_derivative(x, 0)) + 1.0);
        virial_error += (stiff * moved + rounded * std::abs(push) * r) * r;
      }
    }
    potential = static_cast<double>(energies);
    virial = static_cast<double>(virials);
  }
  Eigen::VectorXd force;
  Eigen::VectorXd derivative;
  Eigen::VectorXd force_error;
  Eigen::VectorXd derivative_error;
  double potential = 0.0;
  double potential_error = 0.0;
  double virial = 0.0;
  double virial_error = 0.0;
};

/// By how much the largest of x is beyond what it may be.
double beyond(const Eigen::VectorXd& x, const Eigen::VectorXd& allowed) {
  return (x.cwiseAbs() - allowed).maxCoeff();
}

void require_all_pairs(const liquid& system, const Eigen::VectorXd& q) {
  draws random;
  Eigen::VectorXd v(q.size());
  for (double& x : v) x = random.uniform(-1.0, 1.0);
  const all_pairs expected(system, q, v);
  Eigen::VectorXd f(q.size());
  Eigen::VectorXd g(q.size());
  system.force(q, f);
  system.force_derivative(q, v, g);
  BOOST_TEST(beyond(f - expected.force, expected.force_error) <= 0.0);
  BOOST_TEST(beyond(g - expected.derivative, expected.derivative_error) <= 0.0);
  BOOST_TEST(std::abs(system.potential(q) - expected.potential) <= expected.potential_error);
  BOOST_TEST(std::abs(system.virial(q) - expected.virial) <= expected.virial_error);
  // A pair that is left out at the cut-off is seen: its force is at least this, or it is smooth there.
  const smooth_pair pair(system.options());
  const double of_pair = std::abs(2.0 * system.options().cutoff * pair.derivative(pair.centre(), 1));
  if (system.options().smoothness == 0) BOOST_TEST(of_pair > 2.0 * expected.force_error.maxCoeff());
}

/// A crystal with each atom moved by up to `reach` along each axis.
Eigen::VectorXd shaken(const liquid& system, double reach) {
  draws random;
  Eigen::VectorXd q = lennard_jones_liquid_law(system, 0.0)(1, 0).q;
  for (double& x : q) x += random.uniform(-reach, reach);
  return q;
}

/// After some time: atoms are anywhere, the list is old.
phase_point<double, Eigen::Dynamic> melted(const liquid& system, std::int64_t steps) {
  return integrate(system, verlet{}, 0.004, lennard_jones_liquid_law(system, 3.0)(1, 0), steps).finish;
}

double sum_of(const std::vector<double>& x) {
  detail::exact_sum sum;
  for (std::size_t n = 0; n < x.size(); n += detail::pairs_at_a_time) {
    detail::reals some{};
    for (std::size_t k = 0; k < detail::pairs_at_a_time && n + k < x.size(); ++k) some[k] = x[n + k];
    sum.add(some);
  }
  return sum.total();
}

constexpr double box = 8.0;

/// Pairs of atoms that are nearer than that, by the list or by all pairs.
using pair_set = std::set<std::pair<std::int64_t, std::int64_t>>;
double distance_of(const Eigen::VectorXd& q, std::int64_t i, std::int64_t j) {
  Eigen::Vector3d d = q.segment<3>(3 * i) - q.segment<3>(3 * j);
  for (double& along : d) along -= box * std::nearbyint(along / box);
  return d.norm();
}
pair_set near(const Eigen::VectorXd& q, double reach) {
  pair_set result;
  for (std::int64_t i = 0; i < q.size() / 3; ++i) {
    for (std::int64_t j = 0; j < q.size() / 3; ++j) {
      if (i != j && distance_of(q, i, j) < reach) result.insert({i, j});
    }
  }
  return result;
}
pair_set listed(const detail::neighbour_list& list, std::int64_t atoms) {
  pair_set result;
  for (std::int64_t slot = 0; slot < atoms; ++slot) {
    for (const std::int32_t other : list.row(slot)) {
      if (other < atoms) {
        BOOST_TEST_REQUIRE(result.insert({list.atom(slot), list.atom(other)}).second);
      }
    }
  }
  return result;
}
bool has_all(const pair_set& some, const pair_set& wanted) {
  return std::includes(some.begin(), some.end(), wanted.begin(), wanted.end());
}

}  // namespace

BOOST_AUTO_TEST_CASE(shapes_have_the_energies_that_their_distances_give) {
  BOOST_TEST(energy_off(2, 2, -1.0) <= 1.0);
  BOOST_TEST(energy_off(2, 3, -3.0) <= 1.0);
  BOOST_TEST(energy_off(3, 4, -6.0) <= 1.0);
  // Centred hexagon, -12.53: six spokes and six sides, six that skip one, three across.
  const double hexagon = least_energy({{12.0, 1.0}, {6.0, std::sqrt(3.0)}, {3.0, 2.0}});
  BOOST_TEST(energy_off(2, 7, hexagon) <= 1.0);
  BOOST_TEST(std::abs(hexagon + 12.53) < 0.005);
  // Icosahedron with an atom in its centre, -44.33: twelve spokes, thirty edges, thirty diagonals, six
  // across.
  const double icosahedron = least_energy({{12.0, radius}, {30.0, 1.0}, {30.0, golden}, {6.0, 2.0 * radius}});
  BOOST_TEST(energy_off(3, 13, icosahedron) <= 1.0);
  BOOST_TEST(std::abs(icosahedron + 44.33) < 0.005);
  BOOST_TEST(energy_off(3, 13, icosahedron * (1.0 + 1e-9)) > 1.0);
  // Not the lowest: the octahedron, which the growth of tetrahedra on faces does not find.
  const double octahedron = least_energy({{12.0, 1.0}, {3.0, std::sqrt(2.0)}});
  const lennard_jones<> six(3, 6);
  BOOST_TEST(six.potential(detail::cluster_at_rest(six)) > octahedron + 0.1);
}

BOOST_AUTO_TEST_CASE(clusters_rest_around_the_origin) {
  for (const Eigen::Index space : {2, 3}) {
    for (const Eigen::Index atoms : {2, 3, 4, 6, 9, 14, 20}) {
      const lennard_jones<> system(space, atoms);
      const Eigen::VectorXd q = detail::cluster_at_rest(system);
      Eigen::VectorXd f(q.size());
      system.force(q, f);
      // To 1e-12, and the shift of the centre rounds distances, of stiffness 57 to each of some 12
      // neighbours.
      BOOST_TEST(f.cwiseAbs().maxCoeff() <= 1e-12 + 12.0 * 57.0 * 8.0 * eps);
      for (Eigen::Index axis = 0; axis < space; ++axis) {
        double sum = 0.0;
        for (Eigen::Index i = axis; i < q.size(); i += space) sum += q[i];
        BOOST_TEST(std::abs(sum) <= 8.0 * static_cast<double>(atoms) * eps);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_cluster_is_a_minimum) {
  for (const auto& [space, atoms] : {std::pair{2, 7}, {3, 13}}) {
    const lennard_jones<> system(space, atoms);
    const Eigen::VectorXd q = detail::cluster_at_rest(system);
    const Eigen::Index rigid = space == 2 ? 3 : 6;
    const Eigen::VectorXd stiffness = symmetric_eigen(hessian(system, q)).values;
    const double unit = static_cast<double>(q.size()) * eps * stiffness.tail(1)[0] + 1e-11;  // and the force
    BOOST_TEST(stiffness.head(rigid).cwiseAbs().maxCoeff() <= 8.0 * unit);
    BOOST_TEST(stiffness[rigid] > 1.0);
  }
}

BOOST_AUTO_TEST_CASE(forces_are_those_of_all_pairs) {
  for (const int smoothness : {0, 1, 2, 3}) {
    for (const auto& [atoms, density] : {std::pair{108, 0.3}, {256, 0.8442}, {256, 1.2}, {108, 0.05}}) {
      BOOST_TEST_CONTEXT("smoothness " << smoothness << ", density " << density) {
        const liquid system(atoms, density, {.smoothness = smoothness});
        require_all_pairs(system, shaken(system, 0.08));
      }
    }
  }
  const liquid far_reaching(256, 0.3, {.cutoff = 4.0, .skin = 0.5});
  require_all_pairs(far_reaching, shaken(far_reaching, 0.08));
  const liquid melted_one(256, 0.8442);
  require_all_pairs(melted_one, melted(melted_one, 300).q);
}

BOOST_AUTO_TEST_CASE(the_smallest_box_is_served) {
  const double density = 200.0 / std::pow(5.6 * (1.0 + 4.0 * eps), 3);
  const liquid system(200, density);
  require_all_pairs(system, shaken(system, 0.05));
  BOOST_TEST(refuses([&] { liquid(199, density); },
                     {"the side", "at least 2 (cut-off + skin)", "at least 200 atoms"}));
}

BOOST_AUTO_TEST_CASE(atoms_may_leave_the_box_and_be_on_the_borders_of_cells) {
  const liquid dense(256, 0.8442);
  draws random;
  Eigen::VectorXd elsewhere = shaken(dense, 0.08);
  for (double& x : elsewhere) x += dense.side() * std::floor(random.uniform(-3.0, 4.0));
  require_all_pairs(dense, elsewhere);
  // Cells of the list are an integer part of the side: so are the sites of crystals of one to five cells, and
  // those moved by a whole side.
  for (const double density : {0.05, 0.8442}) {
    const liquid system(256, density);
    Eigen::VectorXd q = lennard_jones_liquid_law(system, 0.0)(1, 0).q;
    q.head(3).array() += system.side();
    q.segment<3>(30).array() -= system.side();
    require_all_pairs(system, q);
  }
  const liquid system(256, 0.2);  // a side of 10.86: cells of 1/7 of it
  Eigen::VectorXd q(3 * 256);
  for (Eigen::Index i = 0; i < 256; ++i) {
    q.segment<3>(3 * i) = Eigen::Vector3d(static_cast<double>(i % 7), static_cast<double>(i / 7 % 7),
                                          static_cast<double>(i / 49)) *
                          (system.side() / 7.0);
  }
  require_all_pairs(system, q);
}

BOOST_AUTO_TEST_CASE(bits_depend_neither_on_threads_nor_on_the_list) {
  const liquid one(256, 0.8442);
  const auto x = melted(one, 250);
  BOOST_TEST(one.lists_made() > 10);
  Eigen::VectorXd with_old_list(x.size());
  one.force(x.q, with_old_list);
  BOOST_TEST_REQUIRE(with_old_list.cwiseAbs().maxCoeff() > 1.0);
  Eigen::VectorXd derivative(x.size());
  one.force_derivative(x.q, x.p, derivative);
  const liquid fresh = one;  // of a copy, which has no list yet
  BOOST_TEST(fresh.lists_made() == 0);
  for (const auto& [skin, threads] : {std::pair{0.3, 1}, {0.05, 2}, {0.7, 3}}) {
    const liquid other = liquid(256, 0.8442, {.skin = skin}).on_threads(threads);
    Eigen::VectorXd f(x.size());
    other.force(x.q, f);
    BOOST_TEST((f == with_old_list));
    other.force_derivative(x.q, x.p, f);
    BOOST_TEST((f == derivative));
    BOOST_TEST(other.potential(x.q) == one.potential(x.q));
    BOOST_TEST(other.virial(x.q) == one.virial(x.q));
  }
  // Another order of the atoms gives the same forces, to the bit, in that order.
  Eigen::VectorXd reversed(x.size());
  for (Eigen::Index i = 0; i < x.size(); i += 3) reversed.segment<3>(i) = x.q.segment<3>(x.size() - 3 - i);
  Eigen::VectorXd f(x.size());
  fresh.force(reversed, f);
  for (Eigen::Index i = 0; i < x.size(); i += 3) {
    BOOST_TEST_REQUIRE((f.segment<3>(i) == with_old_list.segment<3>(x.size() - 3 - i)));
  }
}

// Forces of a pair are opposite to the bit: what is left is one rounding of each atom's force, eps/2 of it.
BOOST_AUTO_TEST_CASE(momentum_is_kept_to_rounding) {
  const liquid system(256, 0.8442);
  const auto x = melted(system, 100);
  Eigen::VectorXd f(x.size());
  system.force(x.q, f);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    long double sum = 0.0;
    double allowed = 0.0;
    for (Eigen::Index i = axis; i < f.size(); i += 3) {
      sum += f[i];
      allowed += 0.5 * eps * std::abs(f[i]);
    }
    BOOST_TEST(std::abs(static_cast<double>(sum)) <= allowed);
    BOOST_TEST(std::abs(static_cast<double>(sum - f[axis])) > allowed);  // without one of the atoms
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_place_has_no_force) {
  const liquid system(256, 0.8442);
  const Eigen::VectorXd q = shaken(system, 0.05);
  Eigen::VectorXd before(q.size());
  Eigen::VectorXd f(q.size());
  system.force(q, before);
  for (const double bad : {not_a_number, infinite, 0x1p17 * system.side()}) {
    Eigen::VectorXd other = q;
    other[4] = bad;
    system.force(other, f);
    BOOST_TEST(f.array().isNaN().all());
    BOOST_TEST(std::isnan(system.potential(other)));
    BOOST_TEST(std::isnan(system.virial(other)));
    liquid(system).force(other, f);  // where no list was made
    BOOST_TEST(f.array().isNaN().all());
    system.force_derivative(q, other, f);
    BOOST_TEST((f.array().isNaN().all() || std::isfinite(bad)));
    system.force(q, f);
    BOOST_TEST((f == before));
  }
  Eigen::VectorXd near = q;
  near.segment<3>(3) = near.head(3);
  near[3] += 0.249;
  system.force(near, f);
  BOOST_TEST((std::isnan(f[0]) && std::isnan(f[3])));
  near[3] += 0.002;
  system.force(near, f);
  BOOST_TEST(f.allFinite());
  near[3] = near[0];
  system.force(near, f);
  BOOST_TEST((std::isnan(f[0]) && std::isnan(f[3])));
}

BOOST_AUTO_TEST_CASE(bad_liquids_are_refused) {
  BOOST_TEST(refuses([] { liquid(1, 0.8442); }, {"atoms", "from 2", "got 1"}));
  BOOST_TEST(refuses([] { liquid(Eigen::Index{1} << 31, 0.8442); }, {"atoms", "got 2147483648"}));
  for (const double bad : {0.0, -1.0, infinite, not_a_number}) {
    BOOST_TEST(refuses([&] { liquid(500, bad); }, {"density", "positive and finite"}));
    BOOST_TEST(refuses([&] { liquid(500, 0.8, {.skin = bad}); }, {"skin", "positive and finite"}));
    BOOST_TEST(refuses([&] { liquid(500, 0.8, {.cutoff = bad}); }, {"cut-off", "at least 1"}));
  }
  // No number of atoms would do.
  BOOST_TEST(refuses([] { liquid(500, 1e300); }, {"take a shorter cut-off"}));
  BOOST_TEST(refuses([] { liquid(500, 0.8, {.smoothness = 4}); }, {"smoothness", "0 to 3", "got 4"}));
  BOOST_TEST(refuses([] { liquid(500, 0.8, {.smoothness = -1}); }, {"smoothness", "got -1"}));
  BOOST_TEST(refuses([] { liquid(500, 0.8).on_threads(0); }, {"threads", "at least 1", "got 0"}));
  const liquid good(500, 0.8);
  BOOST_TEST(refuses([&] { lennard_jones_liquid_law(good, -1.0); }, {"temperature", "got -1"}));
  BOOST_TEST(good.description() == "lennard_jones_liquid(atoms=500, density=0.8, cutoff=2.5, smoothness=0)");
  BOOST_TEST(liquid(500, 0.8, {.skin = 0.2}).on_threads(2).description() == good.description());
  BOOST_TEST(good.kind() == liquid(600, 0.8).kind());
  BOOST_TEST(good.kind() != liquid(500, 0.7).kind());
}

BOOST_AUTO_TEST_CASE(no_order_changes_a_bit_of_a_sum) {
  draws random;
  std::vector<double> x;
  for (int n = 0; n < 300; ++n) {  // from 2^-40 to 2^20, and ties: halves of 2^-19 and of 2^-60
    const double scale = std::ldexp(1.0, static_cast<int>(random.uniform(-40.0, 20.0)));
    x.push_back(random.uniform(-scale, scale));
    x.push_back(std::ldexp(std::floor(random.uniform(-9.0, 9.0)) + 0.5, n % 2 == 0 ? -19 : -60));
  }
  const double first = sum_of(x);
  long double expected = 0.0;
  for (const double summand : x) expected += summand;
  // 2^-61 each, one rounding, and 64 bits of what is compared with.
  const double allowed = 600.0 * 0x1p-61 + std::abs(first) * 0x1p-53 + 600.0 * 0x1p20 * 0x1p-64;
  BOOST_TEST(std::abs(static_cast<double>(first - expected)) <= allowed);
  const auto plain = [&] {
    double sum = 0.0;
    for (const double summand : x) sum += summand;
    return sum;
  };
  const double in_order = plain();
  bool order_matters_to_others = false;
  for (int n = 0; n < 200; ++n) {
    for (std::size_t k = x.size(); k-- > 1;) std::swap(x[k], x[random.bits() % (k + 1)]);
    BOOST_TEST_REQUIRE(sum_of(x) == first);
    order_matters_to_others = order_matters_to_others || plain() != in_order;
  }
  BOOST_TEST(order_matters_to_others);
}

BOOST_AUTO_TEST_CASE(a_list_holds_until_an_atom_has_moved_by_half_the_skin) {
  constexpr std::int64_t atoms = 300;
  constexpr double reach = 1.5;
  constexpr double skin = 0.4;
  draws random;
  Eigen::VectorXd q(3 * atoms);
  for (double& x : q) x = random.uniform(-2.0 * box, 3.0 * box);
  detail::neighbour_list list(atoms, box, reach, skin, 1);
  BOOST_TEST(list.update(q));
  BOOST_TEST((listed(list, atoms) == near(q, reach + skin)));

  const auto moved_by = [&](double way) {
    Eigen::VectorXd result = q;
    for (std::int64_t i = 0; i < atoms; ++i) {
      const Eigen::Vector3d d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
                              random.uniform(-1.0, 1.0));
      result.segment<3>(3 * i) += d.normalized() * way;
    }
    return result;
  };
  for (int n = 0; n < 10; ++n) {
    const Eigen::VectorXd little = moved_by(0.499 * skin);
    BOOST_TEST(list.update(little));
    BOOST_TEST(list.made() == 1);
    BOOST_TEST(has_all(listed(list, atoms), near(little, reach)));
  }
  // Two that have each moved by more than half the skin may have come within reach.
  BOOST_TEST((list.take(moved_by(0.501 * skin)) == detail::neighbour_list::state::outdated));
  // Without a look at how far atoms went, pairs would be missed.
  const Eigen::VectorXd far = moved_by(2.0 * skin);
  BOOST_TEST((list.take(far) == detail::neighbour_list::state::outdated));
  BOOST_TEST(!has_all(listed(list, atoms), near(far, reach)));
  BOOST_TEST(list.update(far));
  BOOST_TEST(list.made() == 2);
  BOOST_TEST((listed(list, atoms) == near(far, reach + skin)));
  // By one atom, round the whole box.
  Eigen::VectorXd round = far;
  round[7] += box;
  BOOST_TEST(list.update(round));
  BOOST_TEST(list.made() == 3);
}
