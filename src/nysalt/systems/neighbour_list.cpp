// SPDX-License-Identifier: BSL-1.0
#include "neighbour_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "nysalt/parallel/ensemble_loop.hpp"

namespace nysalt::detail {

namespace {

/// Rounding of places, 2^-37 of the side at most, is far below this part of a skin.
constexpr double less_than_half = 0.499999;

typedef std::int32_t quadruple __attribute__((vector_size(16)));

/// For each set of lanes, the numbers of those in it.
const auto lanes_of_set = [] {
  std::array<quadruple, 16> result{};
  for (unsigned set = 0; set < 16; ++set) {
    int n = 0;
    for (int k = 0; k < 4; ++k) {
      if ((set >> static_cast<unsigned>(k)) & 1U) result[set][n++] = k;
    }
  }
  return result;
}();

[[gnu::always_inline]] inline unsigned set_of(const integers& mask) {
#if defined __AVX__
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(mask)));
#else
  unsigned set = 0;
  for (int k = 0; k < pairs_at_a_time; ++k)
    set |= static_cast<unsigned>(mask[k] & 1) << static_cast<unsigned>(k);
  return set;
#endif
}

}  // namespace

neighbour_list::neighbour_list(std::int64_t atoms, double side, double reach, double skin, int threads)
    : atoms_(atoms),
      side_(side),
      radius_((reach + skin) / side),
      most_moved_square_((less_than_half * skin) * (less_than_half * skin)),
      threads_(threads),
      per_side_(std::max<std::int64_t>(1, static_cast<std::int64_t>(2.0 / radius_))),
      places_(static_cast<std::size_t>(atoms + far_points)),
      atoms_of_slots_(static_cast<std::size_t>(atoms)),
      made_at_(static_cast<std::size_t>(3 * atoms)),
      cell_of_atom_(static_cast<std::size_t>(atoms)),
      rows_(static_cast<std::size_t>(blocks())),
      found_(static_cast<std::size_t>(blocks())) {
  // Cells of less than an atom each would cost more than they save.
  const double most = std::cbrt(static_cast<double>(atoms));
  per_side_ =
      std::clamp<std::int64_t>(per_side_, 1, std::max<std::int64_t>(1, static_cast<std::int64_t>(most)));
  first_of_cell_.resize(static_cast<std::size_t>(per_side_ * per_side_ * per_side_ + 1));
  for (unsigned k = 0; k < far_points; ++k) {  // in the middle of each cell of a grid of 4 by 4 by 4
    const std::array<unsigned, 3> quarter{k % 4, k / 4 % 4, k / 16};
    place& at = places_[static_cast<std::size_t>(atoms) + k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at.axis[axis] = (2 * std::int64_t{quarter[axis]} + 1) << (places_bits - 3);
    }
  }
}

/// A point on the other side.
std::int32_t neighbour_list::far_from(const place& at) const {
  std::int64_t number = 0;
  for (std::size_t axis = 3; axis-- > 0;) {
    const std::int64_t quarter = (at.axis[axis] & bits_of_position) >> (places_bits - 2);
    number = 4 * number + (quarter + 2) % 4;
  }
  return static_cast<std::int32_t>(atoms_ + number);
}

std::int64_t neighbour_list::end_slot(std::int64_t block) const {
  return std::min(atoms_, (block + 1) * slots_of_block);
}

bool neighbour_list::update(const Eigen::VectorXd& q) {
  const state found = take(q);
  if (found == state::outdated) make(q);
  return found != state::not_a_place;
}

neighbour_list::state neighbour_list::take(const Eigen::VectorXd& q) {
  if (made_ == 0) {
    for (const double x : q) {
      if (!(std::abs(x) < 0x1p16 * side_)) return state::not_a_place;
    }
    return state::outdated;
  }
  for_each_trajectory(blocks(), {.threads = threads_}, [&](std::int64_t block) {
    const double per_side = 1.0 / side_;
    const double farthest = 0x1p16 * side_;
    double most_moved = 0.0;
    double most = 0.0;
    bool is_number = true;
    for (std::int64_t slot = first_slot(block); slot < end_slot(block); ++slot) {
      const double* const x = q.data() + 3 * atom(slot);
      const double* const before = made_at_.data() + 3 * slot;
      place& here = places_[static_cast<std::size_t>(slot)];
      double moved = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double way = x[axis] - before[axis];
        moved += way * way;
        most = std::max(most, std::abs(x[axis]));
        here.axis[axis] = place_of(x[axis] * per_side);
      }
      is_number = is_number && moved == moved;
      most_moved = std::max(most_moved, moved);
    }
    found_[static_cast<std::size_t>(block)] = !is_number || !(most < farthest)  ? state::not_a_place
                                              : most_moved < most_moved_square_ ? state::holds
                                                                                : state::outdated;
  });
  return *std::max_element(found_.begin(), found_.end());
}

void neighbour_list::make(const Eigen::VectorXd& q) {
  sort_into_cells(q);
  for_each_trajectory(blocks(), {.threads = threads_}, [&](std::int64_t block) { make_rows(block); });
  ++made_;
}

void neighbour_list::sort_into_cells(const Eigen::VectorXd& q) {
  const double per_side = 1.0 / side_;
  std::fill(first_of_cell_.begin(), first_of_cell_.end(), 0);
  const auto place_at = [&](std::int64_t atom) {
    place at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at.axis[axis] = place_of(q[3 * atom + static_cast<Eigen::Index>(axis)] * per_side);
    }
    return at;
  };
  for (std::int64_t i = 0; i < atoms_; ++i) {
    const place at = place_at(i);
    const std::int64_t cell =
        (cell_of(at.axis[2]) * per_side_ + cell_of(at.axis[1])) * per_side_ + cell_of(at.axis[0]);
    cell_of_atom_[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(cell);
    ++first_of_cell_[static_cast<std::size_t>(cell) + 1];
  }
  for (std::size_t c = 1; c < first_of_cell_.size(); ++c) first_of_cell_[c] += first_of_cell_[c - 1];
  for (std::int64_t i = 0; i < atoms_; ++i) {  // moves each first to the end of the cell
    const auto cell = static_cast<std::size_t>(cell_of_atom_[static_cast<std::size_t>(i)]);
    const auto slot = static_cast<std::size_t>(first_of_cell_[cell]++);
    atoms_of_slots_[slot] = static_cast<std::int32_t>(i);
    places_[slot] = place_at(i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made_at_[3 * slot + axis] = q[3 * i + static_cast<Eigen::Index>(axis)];
    }
  }
  std::copy_backward(first_of_cell_.begin(), first_of_cell_.end() - 1, first_of_cell_.end());
  first_of_cell_.front() = 0;
}

/// Cells of an axis that are no farther than that from the centre, which is in units of cells; each once.
neighbour_list::cells neighbour_list::cells_within(double centre, double distance) const {
  const auto first = static_cast<std::int64_t>(std::floor(centre - distance));
  const auto last = static_cast<std::int64_t>(std::floor(centre + distance));
  if (last - first + 1 >= per_side_) return {0, per_side_, true};
  return {first, last - first + 1, false};
}

std::int64_t neighbour_list::going_round(std::int64_t cell) const {
  return cell < 0 ? cell + per_side_ : cell < per_side_ ? cell : cell - per_side_;
}

/// Lines of cells along x that come near enough, and of each as much as does.
void neighbour_list::make_rows(std::int64_t block) {
  const auto cells_of_side = static_cast<double>(per_side_);
  // In units of cells; one that is 2^-30 sides farther than the nearest image of what is in it is not missed.
  const double radius = (radius_ + 0x1p-30) * cells_of_side;
  const double limit = radius_ * radius_;
  // Of the nearest point of a cell, or 0 where any image of the cell may be the nearest.
  const auto way_to = [](const cells& all, std::int64_t cell, double centre) {
    const auto left = static_cast<double>(cell);
    return all.are_all ? 0.0 : std::max(0.0, std::max(left - centre, centre - left - 1.0));
  };
  rows_of_block& rows = rows_[static_cast<std::size_t>(block)];
  rows.first.assign(slots_of_block + 1, 0);
  std::size_t size = 0;
  std::size_t k = 0;
  for (std::int64_t slot = first_slot(block); slot < end_slot(block); ++slot) {
    const place& at = places_[static_cast<std::size_t>(slot)];
    const centre here(at);
    const auto add_near = [&](std::int64_t first, std::int64_t end) __attribute__((always_inline)) {
      const std::size_t most = size + static_cast<std::size_t>(end - first) + 8;
      if (rows.slots.size() < most) rows.slots.resize(2 * most);
      std::int32_t* const to = rows.slots.data();
      for (std::int64_t other = first; other < end; other += pairs_at_a_time) {
        const place* const from = places_.data() + other;
        const ways d = ways_to(
            here, [from](int n) __attribute__((always_inline))->const place& { return from[n]; });
        unsigned near = set_of(d.square < limit);
        near &= (1U << static_cast<unsigned>(std::min<std::int64_t>(end - other, pairs_at_a_time))) - 1U;
        const std::int64_t own = slot - other;
        if (own >= 0 && own < pairs_at_a_time) near &= ~(1U << static_cast<unsigned>(own));
        const quadruple numbers = lanes_of_set[near] + static_cast<std::int32_t>(other);
        __builtin_memcpy(to + size, &numbers, sizeof numbers);
        size += static_cast<std::size_t>(std::popcount(near));
      }
    };
    const double x = fraction_of(at.axis[0]) * cells_of_side;
    const double y = fraction_of(at.axis[1]) * cells_of_side;
    const double z = fraction_of(at.axis[2]) * cells_of_side;
    const cells along_z = cells_within(z, radius);
    const cells along_y = cells_within(y, radius);
    for (std::int64_t layer = along_z.first; layer < along_z.first + along_z.count; ++layer) {
      const double dz = way_to(along_z, layer, z);
      for (std::int64_t line = along_y.first; line < along_y.first + along_y.count; ++line) {
        const double dy = way_to(along_y, line, y);
        const double left = radius * radius - dy * dy - dz * dz;
        if (left < 0.0) continue;
        const cells along_x = cells_within(x, std::sqrt(left));
        const std::int32_t* const first_of =
            first_of_cell_.data() + (going_round(layer) * per_side_ + going_round(line)) * per_side_;
        const std::int64_t begin = along_x.first;
        const std::int64_t end = along_x.first + along_x.count;
        if (begin < 0) add_near(first_of[begin + per_side_], first_of[per_side_]);
        add_near(first_of[std::max<std::int64_t>(begin, 0)], first_of[std::min(end, per_side_)]);
        if (end > per_side_) add_near(first_of[0], first_of[end - per_side_]);
      }
    }
    for (; (size - rows.first[k]) % pairs_at_a_time != 0; ++size) rows.slots[size] = far_from(at);
    rows.first[++k] = size;
  }
  rows.slots.resize(std::max(rows.slots.size(), size + pairs_at_a_time));
  std::fill_n(rows.slots.begin() + static_cast<std::ptrdiff_t>(size), pairs_at_a_time, 0);
}

}  // namespace nysalt::detail
