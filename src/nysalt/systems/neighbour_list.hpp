// SPDX-License-Identifier: BSL-1.0
// Which atoms of a periodic cube are near which.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

#include "periodic_positions.hpp"

namespace nysalt::detail {

/// For each atom all others that were nearer than reach + skin when the list was made [verlet_1967]: those
/// nearer than the reach are among them until an atom has moved by half the skin. Atoms are kept in slots,
/// cell after cell, so that neighbours lie near each other in memory; the list is that of slots, in blocks
/// whose number depends only on that of the atoms. The order within a row means nothing.
class neighbour_list {
 public:
  static constexpr std::int64_t slots_of_block = 128;

  /// Of a cube of that side, on `threads` threads. The side is at least 2 (reach + skin).
  neighbour_list(std::int64_t atoms, double side, double reach, double skin, int threads);

  /// Takes coordinates in, and makes the list again if it does not hold for them. False, and nothing else, if
  /// one is not finite or 2^16 sides or more from the origin.
  bool update(const Eigen::VectorXd& q);
  /// Takes coordinates in. Whether they may be had from the list.
  enum class state { holds, outdated, not_a_place };
  state take(const Eigen::VectorXd& q);
  /// Makes the list for coordinates.
  void make(const Eigen::VectorXd& q);

  std::int64_t blocks() const { return (atoms_ + slots_of_block - 1) / slots_of_block; }
  std::int64_t first_slot(std::int64_t block) const { return block * slots_of_block; }
  std::int64_t end_slot(std::int64_t block) const;
  std::int64_t atom(std::int64_t slot) const { return atoms_of_slots_[static_cast<std::size_t>(slot)]; }
  const place* places() const { return places_.data(); }  ///< by slots
  /// Slots beyond those of atoms, of points: each atom has one that is at least 3/8 of the side away along
  /// each axis, and so beyond any reach, when the list is made.
  static constexpr std::int64_t far_points = 64;

  /// The slots of the neighbours of a slot, and then of a far point, until lanes are full. As many entries as
  /// there are lanes may be read beyond them.
  std::span<const std::int32_t> row(std::int64_t slot) const {
    const auto& block = rows_[static_cast<std::size_t>(slot / slots_of_block)];
    const auto k = static_cast<std::size_t>(slot % slots_of_block);
    return {block.slots.data() + block.first[k], block.first[k + 1] - block.first[k]};
  }
  std::int64_t made() const { return made_; }  ///< how many times

 private:
  struct rows_of_block {
    std::vector<std::int32_t> slots;
    std::vector<std::size_t> first;
  };
  struct cells {
    std::int64_t first;  // may be negative, or beyond the last, going round
    std::int64_t count;
    bool are_all;
  };

  std::int64_t cell_of(std::int64_t place) const {
    return ((place & bits_of_position) * per_side_) >> places_bits;
  }
  cells cells_within(double centre, double distance) const;
  std::int64_t going_round(std::int64_t cell) const;
  std::int32_t far_from(const place& at) const;
  void sort_into_cells(const Eigen::VectorXd& q);
  void make_rows(std::int64_t block);

  std::int64_t atoms_;
  double side_;
  double radius_;             // reach + skin, in units of the side
  double most_moved_square_;  // in units of length
  int threads_;
  std::int64_t per_side_;  // cells
  std::int64_t made_ = 0;

  std::vector<place> places_;
  std::vector<std::int32_t> atoms_of_slots_;
  std::vector<double> made_at_;  // coordinates, by slots
  std::vector<std::int32_t> first_of_cell_;
  std::vector<std::int32_t> cell_of_atom_;
  std::vector<rows_of_block> rows_;
  std::vector<state> found_;  // of blocks
};

}  // namespace nysalt::detail
