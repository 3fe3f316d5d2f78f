// SPDX-License-Identifier: BSL-1.0
// The sites of one trajectory that one process holds, and their division into tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "nysalt/kernels/site_kernels.hpp"
#include "nysalt/stepping/step_program.hpp"

namespace nysalt::detail {

/// Kicks between two observations, where nothing is observed.
inline constexpr std::int64_t any_number_of_kicks = std::numeric_limits<std::int64_t>::max();

/// The left or the right of something.
enum class side { left, right };

/// Consecutive sites of a system: all of them, or the share of a rank. A sweep applies letters with several
/// kicks to one tile after the other (time tiling with overlapping tiles): a tile reads what these kicks
/// reach beyond its own sites, and computes it once more. Each site is computed by the same operations as in
/// a loop over all sites, so that the bits depend neither on tiles nor on threads.
class site_window {
 public:
  /// Sites first .. first + count - 1, both multiples of sites_of_row, for sweeps of at most `kicks_at_once`
  /// kicks. Refers to the functions.
  site_window(const site_kernels& system, Eigen::Index first, Eigen::Index count, int threads,
              std::int64_t kicks_at_once = any_number_of_kicks);
  ~site_window();
  site_window(const site_window&) = delete;
  site_window& operator=(const site_window&) = delete;

  /// The most kicks of a sweep that pay.
  int kicks_of_sweep() const { return kicks_; }
  /// Length of a halo for `kicks` kicks: q and then p of the sites that these kicks reach.
  std::size_t halo_size(int kicks) const;
  /// Whether there is a neighbour on that side; a periodic image counts.
  bool has_neighbour(side at) const;
  /// The values at an edge of the window, which are a halo of the neighbour on that side.
  void copy_edge(side at, int kicks, const double* q, const double* p, std::span<double> halo) const;

  /// Applies letters with at most kicks_of_sweep() kicks to q and p, `components` numbers for each site, and
  /// leaves a force that is kept in f. A halo holds the values of the neighbour for these kicks; it is empty
  /// where there is no neighbour. Allocates nothing.
  void sweep(std::span<const tile_letter> letters, double* q, double* p, double* f,
             std::span<const double> left_halo, std::span<const double> right_halo);

  /// The energy of each leaf of sites_of_leaf() sites, with halos for one kick.
  std::vector<double> energies_of_leaves(const double* q, const double* p, std::span<const double> left_halo,
                                         std::span<const double> right_halo);

 private:
  struct workers;

  const site_kernels* system_;
  site_layout layout_;
  Eigen::Index first_;
  std::vector<Eigen::Index> tiles_;  // the first site of each, and the end
  int kicks_;
  std::vector<double> edges_;  // copies of what is next to inner boundaries of tiles, before a sweep
  std::unique_ptr<workers> workers_;
};

/// How many of the threads step a trajectory in tiles. 0, so that it is better stepped without tiles, of a
/// system of few coordinates, and for one thread of a system that reaches so far that tiles overlap by much
/// or that makes few kicks between two observations.
int threads_in_tiles(const site_layout& layout, int threads, std::int64_t kicks = any_number_of_kicks);

/// Sites whose energies are summed in order, before the sums are added in a tree: a multiple of sites_of_row.
Eigen::Index sites_of_leaf(const site_layout& layout);

// Steps of a single trajectory of a local system, tile by tile.

/// The letters of many steps of drifts and kicks in turn, in portions of bounded numbers of kicks.
class letters_in_portions {
 public:
  /// Refers to the program, whose `pairs` are not empty.
  letters_in_portions(const step_program<double>& program, std::int64_t steps)
      : program_(&program), steps_(steps) {}
  /// The next portion; an empty one after the last step. It is valid until the next call.
  std::span<const tile_letter> next(int kicks);

 private:
  const step_program<double>* program_;
  std::int64_t steps_;
  std::int64_t step_ = 0;
  std::size_t letter_ = 0;  // of that step
  std::vector<tile_letter> portion_;
};

/// Steps of a whole system by several threads.
class tiled_steps {
 public:
  /// For at most that number of kicks between two observations. Refers to the functions.
  tiled_steps(const site_kernels& system, int threads, std::int64_t kicks);
  /// `steps` steps of the program. Cost: the steps, and moving the state to the cache and back
  /// once for some tens of kicks.
  void advance(double* q, double* p, double* f, const step_program<double>& program, std::int64_t steps);

 private:
  site_layout layout_;
  site_window window_;
  std::vector<double> left_halo_;
  std::vector<double> right_halo_;
};

}  // namespace nysalt::detail
