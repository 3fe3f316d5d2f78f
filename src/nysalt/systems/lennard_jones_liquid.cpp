// SPDX-License-Identifier: BSL-1.0
#include "nysalt/systems/lennard_jones_liquid.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "lennard_jones_pair.hpp"
#include "neighbour_list.hpp"
#include "nysalt/core/sentence.hpp"
#include "nysalt/core/tree_sum.hpp"
#include "nysalt/parallel/ensemble_loop.hpp"

namespace nysalt {

struct lennard_jones_liquid::scratch {
  scratch(Eigen::Index atoms, double side, const lennard_jones_liquid_options& options, int threads)
      : list(atoms, side, options.cutoff, options.skin, threads) {}

  detail::neighbour_list list;
  std::vector<double> directions{};     // four an atom, by slots
  std::vector<double> sums_of_atoms{};  // by slots
};

namespace {

using detail::exact_sum;
using detail::integers;
using detail::reals;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

[[noreturn]] void refuse(const char* what, const char* condition, const std::string& got) {
  throw std::invalid_argument(sentence("lennard_jones_liquid: {} must be {}, got {}", what, condition, got));
}

void require_options(const lennard_jones_liquid_options& options) {
  if (!(options.cutoff >= 1.0) || !std::isfinite(options.cutoff))
    refuse("the cut-off", "finite and at least 1", sentence("{}", options.cutoff));
  if (!(options.skin > 0.0) || !std::isfinite(options.skin))
    refuse("the skin", "positive and finite", sentence("{}", options.skin));
  if (options.smoothness < 0 || options.smoothness > detail::lennard_jones_pair::smoothest)
    refuse("smoothness", "from 0 to 3", sentence("{}", options.smoothness));
}

/// The ways to some neighbours, and the inverse squares of the distances.
struct distances : detail::ways {
  reals inverse;
};

/// use(slot, pairs) for each slot, with pairs(action) calling action(d, others) for all of the neighbours,
/// `others` being their slots. Each turn takes the next distances and works on the last: what waits for a
/// division does not keep the processor from looking ahead.
void for_each_atom(const detail::neighbour_list& list, int threads, const detail::lennard_jones_pair& pair,
                   const auto& use) {
  const auto of_block = [&](std::int64_t block) {
    for (std::int64_t slot = list.first_slot(block); slot < list.end_slot(block); ++slot) {
      const auto row = list.row(slot);
      const detail::place* const places = list.places();
      const detail::centre here(places[slot]);
      use(
          slot, [&](const auto& action) __attribute__((always_inline)) {
            const auto distances_of = [&](std::size_t n) __attribute__((always_inline)) {
              const std::int32_t* const others = row.data() + n;
              const auto d = detail::ways_to(
                  here, [=](int k) __attribute__((always_inline))->const detail::place& {
                    return places[others[k]];
                  });
              return distances{d, pair.inverse(d.square)};
            };
            distances next = distances_of(0);
            for (std::size_t n = 0; n < row.size(); n += detail::pairs_at_a_time) {
              const distances here_and_now = next;
              next = distances_of(n + detail::pairs_at_a_time);
              action(here_and_now, row.data() + n);
            }
          });
    }
  };
  for_each_trajectory(list.blocks(), {.threads = threads},
                      std::cref(of_block));  // a copy would allocate at each force
}

reals only(const integers& mask, const reals& x) {
  return reinterpret_cast<reals>(reinterpret_cast<integers>(x) & mask);
}

}  // namespace

lennard_jones_liquid::lennard_jones_liquid(Eigen::Index atoms, double density,
                                           const lennard_jones_liquid_options& options)
    : atoms_(atoms), density_(density), side_(0.0), options_(options) {
  constexpr Eigen::Index most = std::numeric_limits<std::int32_t>::max() - 8;
  if (atoms < 2 || atoms > most) {
    throw std::invalid_argument(
        sentence("lennard_jones_liquid: atoms must be from 2 to {}, got {}", most, atoms));
  }
  if (!(density > 0.0) || !std::isfinite(density)) {
    throw std::invalid_argument(
        sentence("lennard_jones_liquid: the density must be positive and finite, got {}", density));
  }
  require_options(options);
  side_ = std::cbrt(static_cast<double>(atoms) / density);
  const double least = 2.0 * (options.cutoff + options.skin);
  if (!(side_ >= least)) {
    const double enough = std::ceil(least * least * least * density);
    throw std::invalid_argument(
        sentence("lennard_jones_liquid: the side (atoms/density)^(1/3) must be at least 2 (cut-off + skin) = "
                 "{}, got {}; take {}a shorter cut-off",
                 least, side_,
                 enough <= static_cast<double>(most)
                     ? sentence("at least {} atoms at this density, or ", static_cast<std::int64_t>(enough))
                     : std::string()));
  }
}

lennard_jones_liquid::lennard_jones_liquid(const lennard_jones_liquid& other)
    : atoms_(other.atoms_),
      density_(other.density_),
      side_(other.side_),
      options_(other.options_),
      threads_(other.threads_) {}
lennard_jones_liquid& lennard_jones_liquid::operator=(const lennard_jones_liquid& other) {
  if (this != &other) *this = lennard_jones_liquid(other);
  return *this;
}
lennard_jones_liquid::lennard_jones_liquid(lennard_jones_liquid&&) noexcept = default;
lennard_jones_liquid& lennard_jones_liquid::operator=(lennard_jones_liquid&&) noexcept = default;
lennard_jones_liquid::~lennard_jones_liquid() = default;

lennard_jones_liquid lennard_jones_liquid::on_threads(int threads) const {
  if (threads < 1) refuse("the number of threads", "at least 1", sentence("{}", threads));
  lennard_jones_liquid result(*this);
  result.threads_ = threads;
  return result;
}

lennard_jones_liquid::scratch& lennard_jones_liquid::scratch_of_this() const {
  if (!scratch_) scratch_ = std::make_unique<scratch>(atoms_, side_, options_, threads_);
  return *scratch_;
}

void lennard_jones_liquid::force(const Eigen::VectorXd& q, Eigen::VectorXd& f) const {
  auto& list = scratch_of_this().list;
  if (!list.update(q)) return void(f.setConstant(not_a_number));
  const detail::lennard_jones_pair pair(side_, options_.cutoff, options_.smoothness);
  const auto with = [&](auto smoothness) {
    for_each_atom(list, threads_, pair, [&](std::int64_t slot, const auto& pairs) {
      exact_sum x;
      exact_sum y;
      exact_sum z;
      pairs([&](const distances& d, const auto*) __attribute__((always_inline)) {
        const reals push = only(d.square < pair.limit, pair.push<smoothness.value>(d.square, d.inverse));
        x.add(push * d.x);
        y.add(push * d.y);
        z.add(push * d.z);
      });
      double* const to = f.data() + 3 * list.atom(slot);
      to[0] = x.total();
      to[1] = y.total();
      to[2] = z.total();
    });
  };
  detail::with_smoothness(options_.smoothness, with);
}

void lennard_jones_liquid::force_derivative(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                            Eigen::VectorXd& g) const {
  scratch& own = scratch_of_this();
  auto& list = own.list;
  const double size = v.cwiseAbs().maxCoeff();
  if (!list.update(q) || !std::isfinite(size) || v.hasNaN()) return void(g.setConstant(not_a_number));
  if (size == 0.0) return void(g.setZero());
  // By a power of two to below 2^-8 and back: sums then hold the steepest slope, and f'(q) v is linear in v.
  const int exponent = std::clamp(std::ilogb(size) + 9, -1000, 1000);
  const double up = std::scalbn(1.0, exponent);
  const double down = std::scalbn(1.0, -exponent);
  own.directions.resize(static_cast<std::size_t>(4 * (atoms_ + detail::neighbour_list::far_points)));
  for (Eigen::Index slot = 0; slot < atoms_; ++slot) {
    const double* const from = v.data() + 3 * list.atom(slot);
    double* const to = own.directions.data() + 4 * slot;
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis] * down;
  }
  const detail::lennard_jones_pair pair(side_, options_.cutoff, options_.smoothness);
  const double* const directions = own.directions.data();
  const auto with = [&](auto smoothness) {
    for_each_atom(list, threads_, pair, [&](std::int64_t slot, const auto& pairs) {
      exact_sum x;
      exact_sum y;
      exact_sum z;
      const double* const mine = directions + 4 * slot;
      pairs([&](const distances& d, const auto* others) __attribute__((always_inline)) {
        const auto theirs = detail::transposed<reals>([&](int k) __attribute__((always_inline)) {
          return directions + 4 * std::int64_t{others[k]};
        });
        const reals wx = mine[0] - theirs.x;
        const reals wy = mine[1] - theirs.y;
        const reals wz = mine[2] - theirs.z;
        const auto [push, slope] = pair.push_and_slope<smoothness.value>(d.square, d.inverse);
        const integers near = d.square < pair.limit;
        const reals along = slope * (d.x * wx + d.y * wy + d.z * wz);
        x.add(only(near, push * wx + along * d.x));
        y.add(only(near, push * wy + along * d.y));
        z.add(only(near, push * wz + along * d.z));
      });
      double* const to = g.data() + 3 * list.atom(slot);
      to[0] = x.total() * up;
      to[1] = y.total() * up;
      to[2] = z.total() * up;
    });
  };
  detail::with_smoothness(options_.smoothness, with);
}

double lennard_jones_liquid::sum_over_pairs(const Eigen::VectorXd& q, const auto& summand) const {
  scratch& own = scratch_of_this();
  auto& list = own.list;
  if (!list.update(q)) return not_a_number;
  own.sums_of_atoms.resize(static_cast<std::size_t>(atoms_));
  const detail::lennard_jones_pair pair(side_, options_.cutoff, options_.smoothness);
  const auto with = [&](auto smoothness) {
    for_each_atom(list, threads_, pair, [&](std::int64_t slot, const auto& pairs) {
      exact_sum sum;
      pairs([&](const distances& d, const auto*) __attribute__((always_inline)) {
        sum.add(only(d.square < pair.limit, summand(pair, smoothness, d)));
      });
      own.sums_of_atoms[static_cast<std::size_t>(list.atom(slot))] = sum.total();
    });
  };
  detail::with_smoothness(options_.smoothness, with);
  return 0.5 * tree_sum(own.sums_of_atoms);  // each pair is there twice
}

double lennard_jones_liquid::potential(const Eigen::VectorXd& q) const {
  return sum_over_pairs(
      q, [](const auto& pair, auto smoothness, const distances& d) __attribute__((always_inline)) {
        return pair.template energy<smoothness.value>(d.square, d.inverse);
      });
}

double lennard_jones_liquid::virial(const Eigen::VectorXd& q) const {
  return sum_over_pairs(
      q, [this](const auto& pair, auto smoothness, const distances& d) __attribute__((always_inline)) {
        return pair.template push<smoothness.value>(d.square, d.inverse) * (d.square * side_);
      });
}

double lennard_jones_liquid::pressure(const phase_point<double, dimension>& x) const {
  return (x.p.squaredNorm() + virial(x.q)) / (3.0 * side_ * side_ * side_);
}

std::int64_t lennard_jones_liquid::lists_made() const { return scratch_ ? scratch_->list.made() : 0; }

std::string lennard_jones_liquid::description() const {
  return sentence("lennard_jones_liquid(atoms={}, density={}, cutoff={}, smoothness={})", atoms_, density_,
                  options_.cutoff, options_.smoothness);
}

std::string lennard_jones_liquid::kind() const {
  return sentence("lennard_jones_liquid(density={}, cutoff={}, smoothness={})", density_, options_.cutoff,
                  options_.smoothness);
}

}  // namespace nysalt
